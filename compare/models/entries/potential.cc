// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/potential.h"

#include <fmt/format.h>

#include <algorithm>

#include "analytic/body/mesh_field.h"
#include "analytic/rod/field_models.h"
#include "compare/input/described.h"
#include "compare/models/entries/values.h"
#include "problem/error.h"

namespace ciliaval::compare::models::entries {
namespace {

using fem::potential::MagnetPushForward;
using fem::potential::PermeableBox;
using fem::potential::PotentialOptions;

constexpr std::string_view plate_table = "models.potential.plate";
constexpr std::size_t most_plates = 100;
constexpr Range permeability_range{
    0, 1e6, true, "a permeability is positive, that of vacuum is 1 and iron has some thousands"};

/// A corner of a plate's box.
template <class Corner>
description::Field<PermeableBox> corner_field(std::string_view name, std::string_view doc,
                                              const Corner& corner) {
  using description::Value;
  description::Field<PermeableBox> field;
  field.name = name;
  field.quantity = quantity::length;
  field.range = {-1000, 1000, false, "a plate farther away is taken for a slip in the unit"};
  field.doc = doc;
  field.initial = Vector3(Vector3::Zero());
  field.get = [=](const PermeableBox& plate) { return Value(Vector3(corner(plate.box))); };
  field.set = [=](PermeableBox& plate, const Value& v) {
    corner(plate.box) = std::get<Vector3>(v);
  };
  return required(field);
}

const description::Fields<PermeableBox>& plate_fields() {
  static const description::Fields<PermeableBox> all{
      corner_field(
          "lower",
          "The corner `[x, y, z]` of a permeable box with the lowest coordinates; one "
          "`[[models.potential.plate]]` for each box.",
          [](auto& box) -> auto& { return (box.min)(); }),
      corner_field(
          "upper", "The corner with the highest coordinates.",
          [](auto& box) -> auto& { return (box.max)(); }),
      required(description::field(&PermeableBox::relative_permeability, "relative_permeability",
                                  permeability_range, "The plate's μ_r."))};
  return all;
}

/// [[models.potential.plate]]: the boxes that are right by themselves and beside each other.
void read_plates(input::Section& potential, input::ModelOptions& options) {
  std::vector<PermeableBox>& plates = options.of<PotentialOptions>().plates;
  potential.tables("plate", 0, most_plates, [&](input::Section& table) {
    input::Faults& faults = table.faults();
    const std::size_t before = faults.size();
    PermeableBox plate;
    input::read(table, plate_fields(), plate);
    const auto report = [&](const char* fault) {
      if (faults.size() == before) faults.add(table.where(), fault);
    };
    for (const auto& field : plate_fields())
      if (table.find(field.name) == nullptr) return;
    if (!(plate.box.sizes().minCoeff() > 0))
      report("a plate's 'upper' corner must lie above its 'lower' one in x, y and z");
    for (const PermeableBox& other : plates)
      if (other.box.intersection(plate.box).sizes().minCoeff() > 0)
        report("the plate overlaps one above: cut them apart");
    if (faults.size() == before) plates.push_back(plate);
  });
}

std::string write_plates(const input::ModelOptions& options) {
  std::string text;
  for (const PermeableBox& plate : options.of<PotentialOptions>().plates)
    text += fmt::format("\n[[{}]]\n{}", plate_table, input::lines(plate_fields(), plate));
  return text;
}

/// Vacuum's permeability, then the case's, then its plates, as far as it states them.
std::vector<input::BudgetStage> budget_stages(const input::ModelOptions& options) {
  const auto stage = [](std::string physics, double permeability, bool has_plates) {
    return input::BudgetStage{
        .physics = std::move(physics),
        .variant = fmt::format("mu_r = {:g}{}", permeability, has_plates ? ", plates" : ""),
        .set =
            [=](input::ModelOptions& all) {
              auto& potential = all.of<PotentialOptions>();
              potential.push_forward = MagnetPushForward::F;
              potential.relative_permeability = permeability;
              if (!has_plates) potential.plates.clear();
            },
        .bears_differences = false};
  };
  const auto& stated = options.of<PotentialOptions>();
  std::vector<input::BudgetStage> stages{
      stage("the same physics by another method: a potential by finite elements", 1, false)};
  if (stated.relative_permeability != 1)
    stages.push_back(
        stage("recoil permeability of the magnet", stated.relative_permeability, false));
  if (!stated.plates.empty())
    stages.push_back(stage("permeable plates", stated.relative_permeability, true));
  return stages;
}

/// The potential, which takes seconds to minutes for each deformation. The effect of the mechanics'
/// error on its field is that on the field of the same magnets in vacuum.
class PotentialAndItsChanges : public FieldModel {
 public:
  explicit PotentialAndItsChanges(const PotentialOptions& options)
      : potential_(options), changes_(options.push_forward), plates_(options.plates) {}
  bool pointwise() const override { return potential_.pointwise(); }
  const FieldModel& for_differences() const override { return changes_; }
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override {
    return potential_.field(cilium, deformation, points);
  }
  /// Magnetisation of points in air alone: in permeable matter M depends on the solution.
  std::vector<Vector3> magnetization(const Cilium& cilium, const Deformation& deformation,
                                     std::span<const Vector3> points) const override {
    std::vector<Vector3> result = changes_.magnetization(cilium, deformation, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool is_in_plate = std::ranges::any_of(
          plates_, [&](const PermeableBox& plate) { return plate.box.contains(points[i]); });
      if (is_in_plate || !result[i].isZero(0))
        throw InputError(fmt::format(
            "the magnetisation of the model `potential` was asked at ({:g}, {:g}, {:g}) m, in the "
            "magnet or in a plate: it is told in air alone",
            points[i].x(), points[i].y(), points[i].z()));
    }
    return result;
  }

 private:
  /// Field in vacuum: of a body by `mesh`, of a rod by `volume`.
  class InVacuum : public FieldModel {
   public:
    explicit InVacuum(MagnetPushForward push_forward)
        : mesh_({.push_forward = push_forward == MagnetPushForward::F
                                     ? analytic::sources::PushForward::F
                                     : analytic::sources::PushForward::R}) {}
    Field field(const Cilium& cilium, const Deformation& deformation,
                std::span<const Vector3> points) const override {
      return deformation.body ? mesh_.field(cilium, deformation, points)
                              : volume_.field(cilium, deformation, points);
    }
    std::vector<Vector3> magnetization(const Cilium& cilium, const Deformation& deformation,
                                       std::span<const Vector3> points) const override {
      return deformation.body ? mesh_.magnetization(cilium, deformation, points)
                              : volume_.magnetization(cilium, deformation, points);
    }

   private:
    analytic::body::MeshField mesh_;
    analytic::rod::VolumeField volume_;
  };

  fem::potential::Potential potential_;
  InVacuum changes_;
  std::vector<PermeableBox> plates_;
};

}  // namespace

input::FieldEntry potential() {
  return {
      .id = "potential",
      .description = "scalar-potential FEM with recoil permeability and permeable plates",
      .make = input::make<PotentialAndItsChanges, PotentialOptions>,
      .options =
          {input::option(&PotentialOptions::relative_permeability, "relative_permeability",
                         permeability_range,
                         "Recoil permeability μ_r of the magnetised segments: about 1.05 for "
                         "NdFeB composites; 1 is what the dipole models assume."),
           input::choice(
               &PotentialOptions::push_forward, "push_forward",
               {{"F", MagnetPushForward::F}, {"R", MagnetPushForward::R}},
               "`F`: m = F·M/J (ideal hard magnet); `R`: m = R·M, of rods M d₃ (rigid sections)."),
           input::option(
               &PotentialOptions::tolerance, "tolerance",
               {1e-7, 0.1, false, "finer meshes exceed the memory of a machine"},
               "Uncertainty of B at each sensor, relative to |B|: twice the estimated error."),
           input::option(&PotentialOptions::max_unknowns, "max_unknowns",
                         {1000, 20000000, false, "more exceed the memory of a machine"},
                         "Where the tolerance is not reached with these, it is an error.")},
      .refinements = {tolerances({2e-2, 6e-3, 2e-3})},
      .is_collective = true,
      .is_slow = true,
      .accuracy = 1e-6,
      .tables = {std::string(plate_table),
                 {plate_fields().begin(), plate_fields().end()},
                 read_plates,
                 write_plates},
      .budget_stages = budget_stages,
  };
}

}  // namespace ciliaval::compare::models::entries
