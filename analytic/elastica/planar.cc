// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/planar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "problem/continuation/root.h"
#include "problem/error.h"
#include "problem/joints/shear_coefficient.h"
#include "problem/lagrange.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica {
namespace {

constexpr std::size_t node_count = 16;
constexpr std::size_t check_count = 4;
constexpr int max_bisections = 40;
constexpr std::size_t most_pieces = 10000;  ///< a smooth shape takes some dozens

/// Values of the nodes' Lagrange polynomials at points between nodes near both ends and the middle,
/// where interpolation errs most.
struct CheckPoints {
  LagrangeBasis basis{chebyshev_points(node_count, 0, 1)};
  std::array<double, check_count> position{0.005, 0.09, 0.5, 0.86};
  std::array<std::array<double, node_count>, check_count> values{};

  CheckPoints() {
    for (std::size_t i = 0; i < check_count; ++i) basis.values(position[i], values[i]);
  }
};

/// The interpolated values: w, z, the two quaternion components, θ', M and H.
std::array<double, 7> components(const PlanarState& s) {
  return {s.w, s.z, std::sin(s.theta / 2), std::cos(s.theta / 2), s.curvature, s.moment, s.force};
}

class CentrelineBuilder {
 public:
  CentrelineBuilder(const PlanarShape& shape, const PlanarUnits& units, Vector3 direction,
                    double tolerance)
      : shape_(shape),
        units_(units),
        direction_(std::move(direction)),
        axis_(Vector3::UnitZ().cross(direction_)),
        tolerance_(tolerance) {}

  Centreline build() {
    for (std::size_t i = 0; i + 1 < shape_.breaks.size(); ++i)
      add(shape_.breaks[i], shape_.breaks[i + 1], i, 0);
    return Centreline(std::move(pieces_));
  }

 private:
  void add(double a, double b, std::size_t piece, int bisections) {
    std::array<PlanarState, node_count> nodes;
    const std::vector<double>& position = checks_.basis.nodes();
    for (std::size_t i = 0; i < node_count; ++i) {
      nodes[i] = shape_.state(std::min(std::lerp(a, b, position[i]), b), piece);
      for (const double value : components(nodes[i]))
        if (!std::isfinite(value)) throw SolverError("elastica: the shape is not finite");
    }
    if (!resolved(nodes, a, b, piece)) {
      if (bisections == max_bisections || pieces_.size() >= most_pieces)
        throw SolverError(
            "elastica: the shape cannot be interpolated to the tolerance asked; if it is of the "
            "height form, whose quadrature loses digits near 90 deg, use the arc-length form");
      const double middle = std::midpoint(a, b);
      add(a, middle, piece, bisections + 1);
      add(middle, b, piece, bisections + 1);
      return;
    }
    Centreline::Piece out;
    out.S = chebyshev_points(node_count, a * units_.length, b * units_.length);
    for (const PlanarState& state : nodes) out.states.push_back(section(state));
    pieces_.push_back(std::move(out));
  }

  bool resolved(const std::array<PlanarState, node_count>& nodes, double a, double b,
                std::size_t piece) const {
    std::array<std::array<double, 7>, node_count> values{};
    std::array<double, 7> scale{};
    std::array<double, 7> allowed{};
    for (std::size_t i = 0; i < node_count; ++i) {
      values[i] = components(nodes[i]);
      for (std::size_t c = 0; c < scale.size(); ++c)
        scale[c] = std::max(scale[c], std::abs(values[i][c]));
    }
    for (std::size_t c = 0; c < scale.size(); ++c) {
      // κL, M and H are relative to 1 or more. The last bits of S move a value by its slope: no
      // interpolation resolves that.
      double slope = 0;
      for (std::size_t i = 0; i + 1 < node_count; ++i)
        slope = std::max(slope,
                         std::abs(values[i + 1][c] - values[i][c]) / (nodes[i + 1].S - nodes[i].S));
      allowed[c] = tolerance_ * std::max(scale[c], 1.0) + 4 * epsilon * b * slope;
    }
    for (std::size_t j = 0; j < check_count; ++j) {
      const auto exact = components(shape_.state(std::lerp(a, b, checks_.position[j]), piece));
      for (std::size_t c = 0; c < exact.size(); ++c) {
        double interpolated = 0;
        for (std::size_t i = 0; i < node_count; ++i)
          interpolated += checks_.values[j][i] * values[i][c];
        if (!(std::abs(interpolated - exact[c]) <= allowed[c])) return false;
      }
    }
    return true;
  }

  SectionState section(const PlanarState& state) const {
    SectionState out;
    out.position = units_.length * (state.w * direction_ + state.z * Vector3::UnitZ());
    out.rotation = Quaternion(Eigen::AngleAxisd(state.theta, axis_));
    out.curvature = state.curvature / units_.length * axis_;
    out.forces.force =
        units_.force * (state.force * direction_ + state.vertical * Vector3::UnitZ());
    out.forces.moment = units_.force * units_.length * state.moment * axis_;
    return out;
  }

  inline static const CheckPoints checks_;
  const PlanarShape& shape_;
  PlanarUnits units_;
  Vector3 direction_;
  Vector3 axis_;
  double tolerance_;
  std::vector<Centreline::Piece> pieces_;
};

/// The kind, and h or s, m.
std::pair<PlanarLoad, double> kind_and_point(const Load& load) {
  if (const auto height = contact_height(load)) return {PlanarLoad::contact, *height};
  if (const auto section = load.as<SectionLoad>()) return {PlanarLoad::section, section->arclength};
  if (load.is<FlowLoad>()) return {PlanarLoad::flow, 0};
  if (load.is<DeadLoad>()) return {PlanarLoad::dead, 0};
  if (load.is<MomentLoad>()) return {PlanarLoad::moment, 0};
  refuse_type(load, "elastica");
}

PlanarLaw scaled(const PlanarLaw& law, double load) {
  const double square = load * load;
  return {law.lengthening * square, law.softening * square * load,
          law.further_softening * square * square * load};
}

/// Under the force F, over the length: a law's jumps, times m, go with 1/L.
PlanarLaw planar_law(const joints::BendingLaw& law, double F, double L, double per_length) {
  const double M = F * L;
  return scaled({law.lengthening * per_length, law.softening * L * per_length,
                 law.further_softening * L * per_length},
                M);
}

/// The load under which the tip sinks to h by linear theory, ∫ θ²/2 dS = 1 − h, but no more than
/// brings the contact to an angle of 1 rad: sin θ there is the linear theory's angle.
double linear_slip_off_load(const PlanarProblem& problem) {
  static const QuadratureRule rule = gauss_legendre(3, 0, 1);  // θ² is of degree 4
  const double h = problem.point;
  double angle = 0;  // θ under the load 1, ∫ f (h − S) dS
  double sum = 0;    // ∫ θ² dS
  for (std::size_t i = 0; i < problem.compliance.size() && problem.ends[i] < h; ++i) {
    const double begin = problem.ends[i];
    const double length = std::min(problem.ends[i + 1], h) - begin;
    const auto at = [&](double S) {
      return angle + problem.compliance[i] * (S - begin) * (h - std::midpoint(begin, S));
    };
    for (std::size_t q = 0; q < rule.nodes.size(); ++q)
      sum += length * rule.weights[q] * std::pow(at(begin + rule.nodes[q] * length), 2);
    angle = at(begin + length);
  }
  sum += (1 - h) * angle * angle;
  return std::min(std::sqrt(2 * (1 - h) / sum), 1 / angle);
}

}  // namespace

Flexibility PlanarProblem::flexibility(std::size_t i, double under) const {
  if (joints.empty()) return {.bending = under * compliance[i]};
  return {under * compliance[i], under * shear[i], under * extension[i], scaled(laws[i], under)};
}

PlanarJoint PlanarProblem::joint(std::size_t i, double under) const {
  const PlanarJoint& j = joints[i];
  return {under * j.rotation, under * j.coupling, under * j.displacement, under * j.extension,
          scaled(j.law, under)};
}

PlanarUnits planar_units(const Cilium& cilium, const Load& load) {
  const double length = cilium.length();
  if (load.is<ProbeLoad>()) return {length, 1};
  if (load.is<MomentLoad>()) return {length, magnitude(load) / length};
  const bool distributed = load.is<FlowLoad>() || load.is<DeadLoad>();
  return {length, distributed ? magnitude(load) * length : magnitude(load)};
}

PlanarProblem planar_problem(const Cilium& cilium, const Load& load,
                             const joints::Corrections& corrections) {
  const PlanarUnits units = planar_units(cilium, load);
  PlanarProblem problem;
  const auto [kind, point] = kind_and_point(load);
  problem.kind = kind;
  problem.point = point / units.length;
  for (const double end : cilium.interfaces()) problem.ends.push_back(end / units.length);
  problem.ends.back() = 1;
  double stiffest = 0;  // Pa
  for (const Segment& segment : cilium.segments)
    stiffest = std::max(stiffest, segment.young_modulus);
  for (const Segment& segment : cilium.segments)
    problem.compliance.push_back(stiffest / segment.young_modulus);
  problem.load =
      units.force * units.length * units.length / (stiffest * cilium.second_moment(azimuth(load)));
  const double softest = *std::max_element(problem.compliance.begin(), problem.compliance.end());
  if (!std::isfinite(problem.load * softest))
    throw InputError(
        "elastica: the load over the bending stiffness, PL^2/EI, is not finite; check "
        "the units of force, length and Young's modulus");
  if (corrections.empty()) return problem;
  const double L = units.length;
  const double B = stiffest * cilium.second_moment(azimuth(load));
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    const joints::Joint& joint = corrections.joints[i];
    const Segment& segment = cilium.segments[i];
    const double force = B / (L * L);  // of the load 1
    problem.joints.push_back({joint.rotation * B / L, joint.coupling * force,
                              joint.displacement * force / L, joint.extension * force / L,
                              planar_law(joint.beyond, force, L, 1 / L)});
    const double nu = segment.poisson_ratio;
    const double over_area = B / (cilium.area() * L * L);
    problem.shear.push_back(over_area /
                            (joints::cowper_shear_coefficient(nu) * segment.shear_modulus()));
    problem.extension.push_back(over_area / segment.young_modulus);
    problem.laws.push_back(planar_law(corrections.laws[i], force, L, 1));
  }
  return problem;
}

double slip_off_load(const PlanarProblem& problem, const std::function<double(double)>& excess) {
  double b = std::log(linear_slip_off_load(problem));
  double f_b = excess(b);
  double step = f_b > 0 ? 0.05 : -0.05;
  for (int k = 0; k < 60; ++k, step *= 2) {
    const double a = b + step;
    const double f_a = excess(a);
    if ((f_a > 0) != (f_b > 0)) return std::exp(continuation::root(excess, a, b, f_a, f_b));
    b = a;
    f_b = f_a;
  }
  throw SolverError("elastica: no slip-off force found");
}

void add_break(std::vector<double>& breaks, double S) {
  const auto above = std::lower_bound(breaks.begin(), breaks.end(), S);
  if (above != breaks.end() && *above - S < shortest_piece) return;
  if (above != breaks.begin() && S - *std::prev(above) < shortest_piece) return;
  breaks.insert(above, S);
}

Centreline planar_centreline(const PlanarShape& shape, const PlanarUnits& units,
                             const Vector3& direction, double tolerance) {
  return CentrelineBuilder(shape, units, direction, tolerance).build();
}

}  // namespace ciliaval::analytic::elastica
