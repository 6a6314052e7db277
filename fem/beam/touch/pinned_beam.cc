// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/touch/pinned_beam.h"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "fem/beam/centreline.h"
#include "fem/beam/cilium_beam.h"
#include "problem/error.h"

namespace ciliaval::fem::beam::touch {
namespace {

/// A contact this near to the end of a segment (relative to L) is in either.
constexpr double at_end = 1e-10;

/// A state of the beam whose vertex moves in the segment `host`.
struct Placed {
  std::size_t host = 0;
  State state;
};

class PinnedBeam : public pin::Body {
 public:
  PinnedBeam(const Cilium& cilium, const Load& load, const BeamOptions& options,
             const joints::Corrections& corrections)
      : cilium_(cilium),
        load_(with_magnitude(load, 0)),
        options_(options),
        corrections_(corrections),
        pin_(pin::pin_of(cilium, load, cilium.length())),
        e_(direction(load)),
        axis_(Vector3::UnitZ().cross(e_)),
        ends_(cilium.interfaces()),
        beams_(cilium.segments.size()) {}

  const pin::Pin& pin() const override { return pin_; }
  double length() const override { return cilium_.length(); }
  double force_unit() const override { return beams_.front()->system.force_scale(); }
  double tip() const override { return 1; }
  double rounding() const override { return 10 * options_.tolerance; }
  std::size_t n_unknowns() const override { return beams_.front()->system.n_unknowns() + 3; }

  pin::Equilibrium untouched() override;
  std::optional<pin::Equilibrium> solve(const pin::Condition& first, const pin::Condition& second,
                                        const pin::Equilibrium& guess) override;
  Deformation deformation(const pin::Equilibrium& equilibrium) override {
    const auto& at = std::any_cast<const Placed&>(equilibrium.state);
    return {centreline(beam(at.host).system, at.state), nullptr};
  }

 private:
  CiliumBeam& beam(std::size_t host) {
    if (!beams_[host])
      beams_[host] = cilium_beam_with_moving_vertex(cilium_, options_, host, corrections_);
    return *beams_[host];
  }
  Loads loads(std::size_t host) {
    Loads result = environment_loads(cilium_, load_, beam(host));
    result.pin = Pin{beam(host).loaded, axis_, pin_.mantle * length()};
    return result;
  }
  NewtonOptions newton_options() const {
    return {options_.tolerance,
            options_.max_iterations,
            options_.max_cutbacks,
            {},
            largest_turn(load_)};
  }
  double untouched_arclength();
  /// A number of the equilibrium; of the friction what is missing at the angle.
  Row number(const pin::Condition& condition, std::size_t host, const System& system,
             const State& state) const;
  std::array<Condition, 3> conditions(const pin::Condition& first, const pin::Condition& second,
                                      std::size_t host);
  bool find(Placed& at, const pin::Condition& first, const pin::Condition& second, int& iterations);
  pin::Equilibrium found(const Placed& at, const pin::Condition& first,
                         const pin::Condition& second, int iterations);
  void enter_neighbour(Placed& at, bool above);

  Cilium cilium_;
  Load load_;
  BeamOptions options_;
  joints::Corrections corrections_;
  pin::Pin pin_;
  Vector3 e_, axis_;
  std::vector<double> ends_;
  std::vector<std::optional<CiliumBeam>> beams_;  ///< by the segment of the vertex
};

double PinnedBeam::untouched_arclength() {
  const double straight = pin_.height * length();
  if (surroundings::is_empty(acting_environment(load_))) return straight;
  CiliumBeam whole = cilium_beam(cilium_, options_, {}, corrections_);
  State state = whole.system.reference_state();
  const PathReport report =
      advance(whole.system, state, {}, environment_loads(cilium_, load_, whole), newton_options());
  if (!report.converged) throw SolverError(report.message);
  const Centreline line = centreline(whole.system, state);
  const Pin pin{0, axis_, pin_.mantle * length()};
  const auto is_below = [&](double S) {
    const CentrelinePoint point = line.at(S);
    const Vector3 n = directions(pin, point.rotation).n.value;
    return point.position.z() - pin_.distance() * length() * n.z() < straight;
  };
  double low = 0;
  double high = line.length();
  if (is_below(high))
    throw SolverError("the environment alone bends the cilium below the contact height");
  while (true) {
    const double middle = std::midpoint(low, high);
    if (!(middle > low && middle < high)) return middle;
    (is_below(middle) ? low : high) = middle;
  }
}

pin::Equilibrium PinnedBeam::untouched() {
  const double S = untouched_arclength();
  Placed at;
  while (at.host + 1 < beams_.size() && ends_[at.host + 1] <= S) ++at.host;
  beam(0);  // whose scales are those of all
  System& system = beam(at.host).system;
  at.state = system.reference_state(S - ends_[at.host]);
  const PathReport report = advance(system, at.state, {}, loads(at.host), newton_options());
  if (!report.converged) throw SolverError(report.message);
  pin::Equilibrium guess;
  guess.state = at;
  using Number = pin::Condition::Number;
  const auto found = solve({Number::friction, pin_.friction_angle}, {Number::force, 0}, guess);
  if (!found) throw SolverError("no equilibrium of the cilium found that the pin just touches");
  return *found;
}

Row PinnedBeam::number(const pin::Condition& condition, std::size_t host, const System& system,
                       const State& state) const {
  using Number = pin::Condition::Number;
  const CiliumBeam& beam = *beams_[host];
  const std::size_t node = system.vertex_node(beam.loaded);
  const Quaternion& rotation = state.rotation[node];
  const Pin pin{beam.loaded, axis_, pin_.mantle * length()};
  const Directions d = directions(pin, rotation);
  const Eigen::RowVector3d e = e_.transpose();
  const Eigen::Vector2d forces = state.pin / system.force_scale();
  const auto component = [&](const Vector3& along) {  // of the force
    const PinForce force = pin_force(pin, rotation, forces);
    Row row;
    row.value = along.dot(force.force.value);
    row.by_spin = along.transpose() * force.force.by_spin;
    row.by_pin = along.transpose() * force.force_by;
    return row;
  };
  Row row;
  const auto put_arclength = [&] {
    row.value = (ends_[host] + state.shift) / system.length_scale();
    row.by_shift = 1;
  };
  switch (condition.number) {
    case Number::friction:
      if (pin_.is_horizontal) return component(Vector3::UnitZ());
      row.by_pin = {-std::sin(condition.value), std::cos(condition.value)};
      row.value = row.by_pin.dot(forces);
      break;
    case Number::slip: {  // n = cos θ e − sin θ e_z
      put_arclength();
      const double cosine = e.dot(d.n.value);
      const double sine = -d.n.value.z();
      row.value += pin_.radius * std::atan2(sine, cosine);
      row.by_spin = -pin_.radius * (cosine * d.n.by_spin.row(2) + sine * e * d.n.by_spin);
      break;
    }
    case Number::displacement:
      row.value = e.dot(state.position[node]) / system.length_scale() +
                  pin_.distance() * (1 - e.dot(d.n.value));
      row.by_position = e;
      row.by_spin = -pin_.distance() * e * d.n.by_spin;
      break;
    case Number::force:
      return component(e_);
    case Number::arclength:
      put_arclength();
      break;
  }
  return row;
}

std::array<Condition, 3> PinnedBeam::conditions(const pin::Condition& first,
                                                const pin::Condition& second, std::size_t host) {
  using Unknown = Condition::Unknown;
  const std::size_t vertex = beam(host).loaded;
  const auto gap = [=, this](const System& system, const State& state) {
    const std::size_t node = system.vertex_node(vertex);
    const Pin pin{vertex, axis_, pin_.mantle * length()};
    const Turning n = directions(pin, state.rotation[node]).n;
    Row row;
    row.value = state.position[node].z() / system.length_scale() - pin_.distance() * n.value.z() -
                pin_.height;
    row.by_position = Vector3::UnitZ().transpose();
    row.by_spin = -pin_.distance() * n.by_spin.row(2);
    return row;
  };
  const auto missed = [=, this](const pin::Condition& condition) {
    return [=, this](const System& system, const State& state) {
      Row row = number(condition, host, system, state);
      if (condition.number != pin::Condition::Number::friction) row.value -= condition.value;
      return row;
    };
  };
  return {Condition{vertex, gap, Unknown::shift},
          Condition{vertex, missed(first), Unknown::tangential_force},
          Condition{vertex, missed(second), Unknown::normal_force}};
}

bool PinnedBeam::find(Placed& at, const pin::Condition& first, const pin::Condition& second,
                      int& iterations) {
  System& system = beam(at.host).system;
  NewtonOptions options = newton_options();
  options.max_cutbacks = 0;
  const NewtonReport report =
      newton(system, at.state, loads(at.host), options, conditions(first, second, at.host));
  iterations += static_cast<int>(report.increments.size());
  return report.converged;
}

void PinnedBeam::enter_neighbour(Placed& at, bool above) {
  // The elements of no length beside the vertex change their side: same nodes, other forces.
  const std::size_t p = options_.degree;
  const std::size_t n = std::size_t{1} << options_.refinement;
  const std::size_t sides = corrections_.empty() ? n : n + 1;  // with the joint
  const std::size_t before = beam(at.host).loaded * p;
  const PinForce force = pin_force(*loads(at.host).pin, at.state.rotation[before], at.state.pin);
  at.host = above ? at.host + 1 : at.host - 1;
  const std::size_t first = above ? before : beam(at.host).loaded * p;
  for (std::size_t k = first; k < first + sides * p; ++k) {
    const Quaternion to_material = at.state.rotation[before].conjugate();
    at.state.force[k] = above ? to_material * force.force.value : Vector3::Zero();
    at.state.moment[k] = above ? to_material * force.couple.value : Vector3::Zero();
  }
  at.state.shift = above ? 0 : ends_[at.host + 1] - ends_[at.host];
}

std::optional<pin::Equilibrium> PinnedBeam::solve(const pin::Condition& first,
                                                  const pin::Condition& second,
                                                  const pin::Equilibrium& guess) {
  Placed at = std::any_cast<const Placed&>(guess.state);
  int iterations = 0;
  for (std::size_t crossings = 0; crossings <= beams_.size(); ++crossings) {
    Placed trial = at;
    if (!find(trial, first, second, iterations)) return std::nullopt;
    const double tolerance = at_end * length();
    const double begin = ends_[at.host];
    const bool is_above =
        begin + trial.state.shift > ends_[at.host + 1] + tolerance && at.host + 1 < beams_.size();
    const bool is_below = trial.state.shift < -tolerance;
    if (!is_above && !is_below) return found(trial, first, second, iterations);
    if (is_below && at.host == 0) return std::nullopt;
    const double end = (is_above ? ends_[at.host + 1] : begin) / length();
    if (!find(at, first, {pin::Condition::Number::arclength, end}, iterations)) return std::nullopt;
    enter_neighbour(at, is_above);
  }
  return std::nullopt;
}

pin::Equilibrium PinnedBeam::found(const Placed& at, const pin::Condition& first,
                                   const pin::Condition& second, int iterations) {
  using Number = pin::Condition::Number;
  System& system = beam(at.host).system;
  const Loads applied = loads(at.host);
  const std::array<Condition, 3> three = conditions(first, second, at.host);
  const Increment by_second = response(system, at.state, applied, three);
  const auto row = [&](Number which) { return number({which, 0}, at.host, system, at.state); };
  const auto rate = [&](const Row& of) { return change(of, system, three, by_second); };
  const Eigen::VectorXd residual = system.residual(at.state, applied);
  const auto moments = static_cast<Eigen::Index>(system.node_unknown(0, 3));
  const std::size_t node = system.vertex_node(beam(at.host).loaded);
  const PinForce force = pin_force(*applied.pin, at.state.rotation[node], at.state.pin);
  return {.S = row(Number::arclength).value,
          .slip = row(Number::slip).value,
          .displacement = row(Number::displacement).value,
          .force = row(Number::force).value,
          .vertical = -force.force.value.z() / system.force_scale(),
          .base_moment = -residual.segment<3>(moments).dot(axis_),
          .normal = at.state.pin[0] / system.force_scale(),
          .friction_angle = std::atan2(at.state.pin[1], at.state.pin[0]),
          .slip_by_second = rate(row(Number::slip)),
          .force_by_second = rate(row(Number::force)),
          .iterations = iterations,
          .state = at};
}

}  // namespace

std::unique_ptr<pin::Body> pinned_beam(const Cilium& cilium, const Load& load,
                                       const BeamOptions& options,
                                       const joints::Corrections& corrections) {
  return std::make_unique<PinnedBeam>(cilium, load, options, corrections);
}

}  // namespace ciliaval::fem::beam::touch
