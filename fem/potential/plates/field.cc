// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/plates/field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "problem/error.h"
#include "problem/field_model.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::potential::plates {
namespace {

/// Charges' steps. B at the chip of docs/evidence/potential.md is off by 0.4, 0.1, 0.02 % …
constexpr std::array steps{1.4, 1.0, 0.7, 0.5};
/// Length of a part of the magnet over its distance from the plates, and points on it.
constexpr double part_over_distance = 0.5;
constexpr std::size_t part_points = 3;
/// Distance within which parts are no longer halved, over a plate's least dimension.
constexpr double nearest_over_thickness = 0.02;

/// Moments m at x, and their field.
struct Dipoles {
  std::vector<Vector3> position;
  std::vector<Vector3> moment;  ///< A·m²

  void add(const Vector3& x, const Vector3& m) {
    position.push_back(x);
    moment.push_back(m);
  }
  /// H, A/m.
  Vector3 field(const Vector3& x) const {
    Vector3 H = Vector3::Zero();
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vector3 r = x - position[i];
      const double square = r.squaredNorm();
      H += (3 * r.dot(moment[i]) / square * r - moment[i]) / (square * std::sqrt(square));
    }
    return H / (4 * std::numbers::pi);
  }
};

double distance_from(const std::vector<PermeableBox>& boxes, const Eigen::AlignedBox3d& body) {
  double distance = std::numeric_limits<double>::infinity();
  for (const PermeableBox& plate : boxes)
    distance = std::min(distance, plate.box.exteriorDistance(body));
  return distance;
}

/// The magnet as dipoles that are dense enough for its field in the plates.
Dipoles dipoles_of(const Magnet& magnet, const std::vector<PermeableBox>& boxes) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const PermeableBox& plate : boxes)
    nearest = std::min(nearest, nearest_over_thickness * plate.box.sizes().minCoeff());
  std::vector<MagnetSample> samples;
  std::vector<Magnet::Block> parts = magnet.blocks();
  while (!parts.empty()) {
    const Magnet::Block part = parts.back();
    parts.pop_back();
    const Magnet::Extent extent = magnet.extent(part);
    Eigen::Index longest = 0;
    const double length = extent.lengths.maxCoeff(&longest);
    if (length <= part_over_distance * std::max(nearest, distance_from(boxes, extent.box))) {
      magnet.sample(part, part_points, samples);
    } else {
      for (const Magnet::Block& half : halves(part, longest)) parts.push_back(half);
    }
  }
  Dipoles result;
  for (const MagnetSample& sample : samples) result.add(sample.position, sample.moment);
  return result;
}

/// The points, and the magnet's nearest part to each plate on a grid of half its distance, so that
/// it stays where the magnet moves a little.
std::vector<Vector3> features_of(const Dipoles& magnet, const std::vector<PermeableBox>& boxes,
                                 std::span<const Vector3> points) {
  std::vector<Vector3> features(points.begin(), points.end());
  for (const PermeableBox& plate : boxes) {
    const auto nearest = std::ranges::min_element(
        magnet.position, {}, [&](const Vector3& x) { return plate.box.exteriorDistance(x); });
    const double distance = plate.box.exteriorDistance(*nearest);
    const double grid = std::exp2(std::floor(std::log2(std::max(distance, 1e-9)))) / 2;
    features.emplace_back((*nearest / grid).array().round().matrix() * grid);
  }
  return features;
}

}  // namespace

std::shared_ptr<const Charges> Plates::system(std::size_t level,
                                              const std::vector<Vector3>& features) const {
  const std::scoped_lock lock(mutex_);
  if (features_ != features) systems_.clear();
  features_ = features;
  while (systems_.size() <= level)
    systems_.push_back(
        std::make_shared<const Charges>(boxes_, features, steps.at(systems_.size())));
  return systems_[level];
}

AddedField Plates::field(const Magnet& magnet, double susceptibility,
                         std::span<const InducedMoment> induced, const Vector3& uniform_field,
                         std::span<const Vector3> points, std::span<const double> tolerance) const {
  const Dipoles own = dipoles_of(magnet, boxes_);
  const std::vector<Vector3> features = features_of(own, boxes_, points);
  Dipoles alone = own;
  for (const InducedMoment& share : induced) alone.add(share.position, share.moment);
  AddedField result;
  std::vector<Vector3> before;
  for (std::size_t level = 0; level < steps.size(); ++level) {
    const std::shared_ptr<const Charges> system = this->system(level, features);
    Dipoles answer;  // of the magnet to the plates
    const auto source = [&](const Vector3& x) -> Vector3 {
      Vector3 H = alone.field(x) + uniform_field / vacuum_permeability;
      if (!answer.position.empty()) H += answer.field(x);
      return H;
    };
    Eigen::VectorXd charges = system->charges(source);
    if (!induced.empty()) {
      for (const InducedMoment& share : induced)
        answer.add(share.position, share.volume * system->field(charges, share.position));
      charges = system->charges(source);
    }
    result.B.clear();
    result.uncertainty.clear();
    bool is_fine = level > 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      support::check_interruption();
      const Vector3 of_answer = vacuum_permeability * answer.field(points[i]);
      result.B.emplace_back(vacuum_permeability * system->field(charges, points[i]) + of_answer);
      if (level == 0) continue;
      result.uncertainty.push_back((result.B[i] - before[i]).norm() +
                                   std::abs(susceptibility) * of_answer.norm());
      is_fine = is_fine && result.uncertainty[i] <= tolerance[i];
    }
    before = result.B;
    if (level == 0) {
      result.system = system;
      result.charges = charges;
    }
    if (is_fine) return result;
  }
  throw SolverError(
      "the field of the permeable plates is not as exact as asked for with the finest charges: ask "
      "for a larger models.potential.tolerance, or move points away from a plate's edge");
}

std::shared_ptr<const FieldMesh> with_plates(const FieldMesh& mesh, const Plates& plates,
                                             const AddedField& field) {
  auto result = std::make_shared<FieldMesh>();
  for (FieldMesh::Leaf leaf : mesh.leaves) {
    const Eigen::AlignedBox3d cube(leaf.lower, leaf.lower + Vector3::Constant(leaf.size).eval());
    const bool is_in_plate = std::ranges::any_of(plates.boxes(), [&](const PermeableBox& plate) {
      return plate.box.intersection(cube).sizes().minCoeff() > 0;
    });
    if (is_in_plate) continue;
    for (std::size_t i = 0; i < leaf.psi.size(); ++i)
      leaf.psi.at(i) += field.system->potential(
          field.charges,
          leaf.lower + leaf.size / 2 *
                           Vector3(static_cast<double>(i % 3), static_cast<double>(i / 3 % 3),
                                   static_cast<double>(i / 9)));
    result->leaves.push_back(leaf);
  }
  return result;
}

}  // namespace ciliaval::fem::potential::plates
