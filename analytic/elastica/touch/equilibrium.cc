// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/elastica/touch/equilibrium.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "problem/error.h"
#include "problem/support/interruption.h"
#include "problem/types.h"

namespace ciliaval::analytic::elastica::touch {
namespace {

using point_forces::Force;
using point_forces::Gradient;
using point_forces::Section;

constexpr int most_iterations = 25;
constexpr double rounding = 1e-10;  ///< of an increment that no longer falls
constexpr double farthest = 4;      ///< S to which the last segment may go on, in lengths

std::vector<double> prolonged(std::vector<double> ends) {
  ends.back() = farthest;
  return ends;
}

Gradient unit(Eigen::Index column) {
  Gradient result = Gradient::Zero(4);
  result[column] = 1;
  return result;
}

/// The section at the contact, with the derivatives by the unknowns.
struct Contact {
  Row theta, x, z, moment;
  double energy = 0;
};

Contact contact_of(const Problem& problem, const std::vector<double>& ends, const Vector4& u) {
  Section section;
  section.moment = u[0];
  section.theta_by = section.x_by = section.z_by = Gradient::Zero(4);
  section.moment_by = unit(0);
  const Force force{u[1], u[2], unit(1), unit(2)};
  integrate(point_forces::Rod{ends, problem.compliance}, section, force, u[3],
            [](const point_forces::Step&) {});
  const double sine = std::sin(section.theta);
  const double cosine = std::cos(section.theta);
  Contact at{{section.theta, section.theta_by},
             {section.x, section.x_by},
             {section.z, section.z_by},
             {section.moment, section.moment_by},
             section.energy};
  at.theta.by[3] += section.curvature;
  at.x.by[3] += sine;
  at.z.by[3] += cosine;
  at.moment.by[3] += force.z * sine - force.x * cosine;
  return at;
}

/// The equations at given unknowns: no couple but the friction's, no gap, and the conditions.
class Equations {
 public:
  Equations(const Problem& problem, const Contact& at, const Vector4& u)
      : problem_(problem), at_(at), u_(u) {}

  Row couple() const {
    Row row = at_.moment;
    const double sine = std::sin(at_.theta.value);
    const double cosine = std::cos(at_.theta.value);
    const double R = problem_.pin.mantle;
    row.value -= R * (u_[1] * sine + u_[2] * cosine);
    row.by -= R * (u_[1] * cosine - u_[2] * sine) * at_.theta.by;
    row.by[1] -= R * sine;
    row.by[2] -= R * cosine;
    return row;
  }

  Row gap() const {
    const double a = problem_.pin.distance();
    return {at_.z.value + a * std::sin(at_.theta.value) - problem_.pin.height,
            at_.z.by + a * std::cos(at_.theta.value) * at_.theta.by};
  }

  /// A number of the equilibrium; of the friction what is missing at the angle.
  Row number(const pin::Condition& condition) const {
    using Number = pin::Condition::Number;
    Row row;
    switch (condition.number) {
      case Number::friction:
        return direction(condition.value);
      case Number::slip:
        row = {u_[3] + problem_.pin.radius * at_.theta.value, problem_.pin.radius * at_.theta.by};
        row.by[3] += 1;
        break;
      case Number::displacement: {
        const double a = problem_.pin.distance();
        row = {at_.x.value + a * (1 - std::cos(at_.theta.value)),
               at_.x.by + a * std::sin(at_.theta.value) * at_.theta.by};
        break;
      }
      case Number::force:
        row.value = u_[1];
        row.by[1] = 1;
        break;
      case Number::arclength:
        row.value = u_[3];
        row.by[3] = 1;
        break;
    }
    return row;
  }
  Row missed(const pin::Condition& condition) const {
    Row row = number(condition);
    if (condition.number != pin::Condition::Number::friction) row.value -= condition.value;
    return row;
  }

 private:
  /// V cos(θ − α) = H sin(θ − α), or V = 0.
  Row direction(double alpha) const {
    Row row;
    if (problem_.pin.is_horizontal) {
      row.value = u_[2];
      row.by[2] = 1;
      return row;
    }
    const double sine = std::sin(at_.theta.value - alpha);
    const double cosine = std::cos(at_.theta.value - alpha);
    row.value = u_[2] * cosine + u_[1] * sine;
    row.by = (u_[1] * cosine - u_[2] * sine) * at_.theta.by;
    row.by[1] += sine;
    row.by[2] += cosine;
    return row;
  }

  const Problem& problem_;
  const Contact& at_;
  const Vector4& u_;
};

pin::Equilibrium found(const Equations& equations, const Contact& at, const Vector4& u,
                       const Vector4& by_second, int iterations) {
  using Number = pin::Condition::Number;
  const Row slip = equations.number({Number::slip, 0});
  const State state{u, at.theta.value, at.x.value, at.z.value, at.energy};
  return {.S = u[3],
          .slip = slip.value,
          .displacement = equations.number({Number::displacement, 0}).value,
          .force = u[1],
          .vertical = -u[2],
          .base_moment = u[0],
          .normal = u[1] * std::cos(at.theta.value) - u[2] * std::sin(at.theta.value),
          .friction_angle = at.theta.value - std::atan2(-u[2], u[1]),
          .slip_by_second = slip.by.dot(by_second),
          .force_by_second = by_second[1],
          .iterations = iterations,
          .state = state};
}

}  // namespace

pin::Equilibrium untouched(const Problem& problem) {
  State state;
  state.unknowns[3] = state.z = problem.pin.height;
  pin::Equilibrium equilibrium;
  equilibrium.S = equilibrium.slip = problem.pin.height;
  equilibrium.state = state;
  return equilibrium;
}

std::optional<pin::Equilibrium> solve(const Problem& problem, const pin::Condition& first,
                                      const pin::Condition& second, const State& guess) {
  const std::vector<double> ends = prolonged(problem.ends);
  Vector4 u = guess.unknowns;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    support::check_interruption();
    if (!u.allFinite() || u[3] <= 0 || u[3] >= farthest) return std::nullopt;
    Contact at;
    try {
      at = contact_of(problem, ends, u);
    } catch (const SolverError&) {  // a trial far away
      return std::nullopt;
    }
    const Equations equations(problem, at, u);
    Eigen::Matrix4d jacobian;
    Vector4 residual;
    Eigen::Index i = 0;
    for (const Row& row :
         {equations.couple(), equations.gap(), equations.missed(first), equations.missed(second)}) {
      residual[i] = row.value;
      jacobian.row(i++) = row.by;
    }
    const Eigen::PartialPivLU<Eigen::Matrix4d> lu(jacobian);
    const Vector4 step = lu.solve(residual);
    const double size = step.norm() / (1 + u.norm());
    const bool is_solved = size <= 4 * epsilon || (size <= rounding && size >= last / 2);
    if (is_solved) return found(equations, at, u, lu.solve(Vector4::Unit(3)), iteration);
    u -= step;
    last = size;
  }
  return std::nullopt;
}

std::vector<point_forces::Step> steps_along(const Problem& problem, const State& state) {
  Section section;
  section.moment = state.base_moment();
  std::vector<point_forces::Step> steps;
  integrate(point_forces::Rod{problem.ends, problem.compliance}, section,
            Force{state.unknowns[1], state.unknowns[2], {}, {}}, std::min(state.S(), 1.0),
            [&](const point_forces::Step& step) { steps.push_back(step); });
  return steps;
}

}  // namespace ciliaval::analytic::elastica::touch
