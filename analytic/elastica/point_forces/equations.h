// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "analytic/elastica/tip_contact.h"
#include "problem/error.h"

/// The equations of a contact: equilibrium, no gap, tangency, friction.
namespace ciliaval::analytic::elastica::point_forces {

using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_unknowns, 1>;
using Matrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_unknowns, most_unknowns>;
using ByPlace = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, most_unknowns, 2>;

inline bool is_tangent(const Touch& touch) {
  return touch.where == TouchPoint::face || touch.where == TouchPoint::mantle;
}

/// Columns of the unknowns: M₀, then F_x, F_z and S or the offset a of each touching point, then
/// τ = T/N if they are several.
struct Layout {
  explicit Layout(const std::vector<Touch>& touches) {
    for (const Touch& touch : touches) {
      columns.push_back(size);
      size += is_tangent(touch) ? 3 : 2;
    }
    if (touches.size() > 1) ratio = size++;
    if (size > most_unknowns) throw SolverError("elastica: the cilium touches at too many points");
  }
  Eigen::Index size = 1;
  Eigen::Index ratio = -1;
  std::vector<Eigen::Index> columns;
};

/// A value and its derivatives by the unknowns; ξ's derivative by the travel is −1.
struct Row {
  double value = 0;
  Gradient by;
  Eigen::RowVector2d by_place{0, 0};  ///< at fixed unknowns
};

/// The forces of a touching point and its slip with their derivatives.
struct Touching {
  Row normal_force;
  Row friction_force;
  Row slip;
};

struct System {
  Vector residuals;
  Matrix jacobian;
  ByPlace by_place;
  Eigen::Index law = 0;  ///< row of the law of friction
  Row held;              ///< the row of the first point's slip
  std::vector<Touching> touching;
};

/// Assembles the equations at given unknowns.
class Assembly {
 public:
  Assembly(const TipProblem& problem, const surroundings::Surface& surface,
           const SurfacePlace& place, const FrictionLaw& law, const Layout& layout,
           TipContact& contact)
      : problem_(problem),
        surface_(surface),
        place_(place),
        law_(law),
        layout_(layout),
        contact_(contact) {}

  System at(const Vector& u) {
    const Eigen::Index size = layout_.size;
    u_ = u;
    system_ = {};
    system_.residuals = Vector::Zero(size);
    system_.jacobian = Matrix::Zero(size, size);
    system_.by_place = ByPlace::Zero(size, 2);
    row_ = 1;
    start();
    for (const std::size_t i : upwards()) pass(i);
    reach_tip();
    if (layout_.ratio >= 0) add_law(row_);
    summarise();
    return std::move(system_);
  }

 private:
  Gradient unit(Eigen::Index column) const {
    Gradient result = Gradient::Zero(layout_.size);
    result[column] = 1;
    return result;
  }

  bool is_at_end(const Touch& touch) const {
    return touch.where != TouchPoint::mantle || touch.S >= 1;
  }

  /// The points of the mantle below the end, from the base up.
  std::vector<std::size_t> upwards() const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < contact_.touches.size(); ++i)
      if (!is_at_end(contact_.touches[i])) order.push_back(i);
    std::ranges::sort(order, {}, [&](std::size_t i) { return contact_.touches[i].S; });
    return order;
  }

  void start() {
    const Gradient zero = Gradient::Zero(layout_.size);
    section_ = {};
    section_.moment = contact_.base_moment = u_[0];
    section_.theta_by = section_.x_by = section_.z_by = zero;
    section_.moment_by = unit(0);
    force_ = {0, 0, zero, zero};
    for (std::size_t i = 0; i < contact_.touches.size(); ++i) {
      Touch& touch = contact_.touches[i];
      const Eigen::Index column = layout_.columns[i];
      touch.force_x = u_[column];
      touch.force_z = u_[column + 1];
      if (touch.where == TouchPoint::face) touch.offset = u_[column + 2];
      if (touch.where == TouchPoint::mantle) touch.S = u_[column + 2];
      force_.x += touch.force_x;
      force_.z += touch.force_z;
      force_.x_by[column] = force_.z_by[column + 1] = 1;
    }
    contact_.force_x = force_.x;
    contact_.force_z = force_.z;
    system_.touching.resize(contact_.touches.size());
  }

  void integrate_to(double S) {
    integrate(Rod{problem_.ends, problem_.compliance}, section_, force_, S, [](const Step&) {});
  }

  double flexibility_at(double S) const {
    const auto above = std::ranges::lower_bound(problem_.ends, S);
    const auto i = std::max<std::ptrdiff_t>(above - problem_.ends.begin() - 1, 0);
    return problem_.compliance[std::min<std::size_t>(static_cast<std::size_t>(i),
                                                     problem_.compliance.size() - 1)];
  }

  /// A point of the mantle: its rows, then the state above it.
  void pass(std::size_t i) {
    Touch& touch = contact_.touches[i];
    const Eigen::Index column = layout_.columns[i];
    integrate_to(touch.S);
    const double sine = std::sin(section_.theta);
    const double cosine = std::cos(section_.theta);
    const double a = touch.offset;
    const double couple = -a * (touch.force_x * sine + touch.force_z * cosine);
    const double bend = flexibility_at(touch.S) * couple;
    touch.curvature = section_.curvature - bend / 2;
    const double stretch = 1 - a * section_.curvature;
    Row x{section_.x + a * cosine, section_.x_by - a * sine * section_.theta_by};
    Row z{section_.z - a * sine, section_.z_by - a * cosine * section_.theta_by};
    Row theta{section_.theta, section_.theta_by};
    x.by[column + 2] += sine * stretch;
    z.by[column + 2] += cosine * stretch;
    theta.by[column + 2] += section_.curvature;
    add_rows(i, x, z, theta);
    Gradient couple_by = a * (touch.force_z * sine - touch.force_x * cosine) * theta.by;
    couple_by[column] -= a * sine;
    couple_by[column + 1] -= a * cosine;
    // By S at fixed S of the sections above: what θ′ and M′ lose there.
    section_.theta_by[column + 2] += bend;
    section_.moment_by -= couple_by;
    section_.moment_by[column + 2] += touch.force_z * sine - touch.force_x * cosine;
    section_.moment -= couple;
    force_.x -= touch.force_x;
    force_.z -= touch.force_z;
    force_.x_by[column] = force_.z_by[column + 1] = 0;
  }

  /// The rest of the rod, the points at its end, and the balance of moments there. A point of the
  /// mantle that a trial puts beyond the end lies on its straight continuation.
  void reach_tip() {
    integrate_to(1);
    contact_.theta = section_.theta;
    contact_.x = section_.x;
    contact_.z = section_.z;
    contact_.energy = section_.energy;
    const double sine = std::sin(section_.theta);
    const double cosine = std::cos(section_.theta);
    Row moment{section_.moment, section_.moment_by};
    for (std::size_t i = 0; i < contact_.touches.size(); ++i) {
      const Touch& touch = contact_.touches[i];
      if (!is_at_end(touch)) continue;
      const Eigen::Index column = layout_.columns[i];
      const double a = touch.offset;
      const double e = touch.S - 1;
      const double arm_x = e * sine + a * cosine;
      const double arm_z = e * cosine - a * sine;
      Gradient arm_x_by = arm_z * section_.theta_by;
      Gradient arm_z_by = -arm_x * section_.theta_by;
      if (touch.where == TouchPoint::mantle) {
        arm_x_by[column + 2] += sine;
        arm_z_by[column + 2] += cosine;
      } else if (touch.where == TouchPoint::face) {
        arm_x_by[column + 2] += cosine;
        arm_z_by[column + 2] -= sine;
      }
      add_rows(i, {section_.x + arm_x, section_.x_by + arm_x_by},
               {section_.z + arm_z, section_.z_by + arm_z_by}, {section_.theta, section_.theta_by});
      moment.value -= touch.force_x * arm_z - touch.force_z * arm_x;
      moment.by -= touch.force_x * arm_z_by - touch.force_z * arm_x_by;
      moment.by[column] -= arm_z;
      moment.by[column + 1] += arm_x;
    }
    put(0, moment);
  }

  void put(Eigen::Index index, const Row& row) {
    system_.residuals[index] = row.value;
    system_.jacobian.row(index) = row.by;
    system_.by_place.row(index) = row.by_place;
  }

  /// The gap, the tangency and the friction of a touching point.
  void add_rows(std::size_t i, const Row& x, const Row& z, const Row& theta) {
    Touch& touch = contact_.touches[i];
    const double on_surface = x.value - place_.travel;
    const surroundings::ProfilePoint profile = surface_.extended(on_surface * problem_.length);
    const double beta = std::atan(profile.slope);
    const double bend = profile.curvature * problem_.length * std::pow(std::cos(beta), 2);  // dβ/dξ
    touch.x = x.value;
    touch.z = z.value;
    touch.inclination = beta;
    if (law_.kind == FrictionLaw::Kind::pulled) {
      put(row_++, {x.value - law_.x, x.by});
      touch.inclination = law_.value;
      add_friction(i, x, 0);
      return;
    }
    Row gap{place_.height - profile.height / problem_.length - z.value,
            -profile.slope * x.by - z.by,
            {profile.slope, 1}};
    put(row_++, gap);
    if (is_tangent(touch)) {
      const double turn =
          touch.where == TouchPoint::mantle ? touch.side * std::numbers::pi / 2 : 0.0;
      put(row_++, {theta.value + turn - beta, theta.by - bend * x.by, {bend, 0}});
    }
    add_friction(i, x, bend);
  }

  void add_friction(std::size_t i, const Row& x, double bend) {
    Touch& touch = contact_.touches[i];
    const Eigen::Index column = layout_.columns[i];
    const double sine = std::sin(touch.inclination);
    const double cosine = std::cos(touch.inclination);
    touch.normal_force = -sine * touch.force_x - cosine * touch.force_z;
    touch.friction_force = cosine * touch.force_x - sine * touch.force_z;
    Touching& own = system_.touching[i];
    const double normal_turn = -touch.friction_force * bend;
    const double friction_turn = touch.normal_force * bend;
    own.normal_force = {touch.normal_force, normal_turn * x.by, {-normal_turn, 0}};
    own.normal_force.by[column] -= sine;
    own.normal_force.by[column + 1] -= cosine;
    own.friction_force = {touch.friction_force, friction_turn * x.by, {-friction_turn, 0}};
    own.friction_force.by[column] += cosine;
    own.friction_force.by[column + 1] -= sine;
    own.slip = slip_of(touch, column, x);
    touch.slip = own.slip.value;
    if (layout_.ratio < 0) {
      add_law(row_++);
      return;
    }
    const bool slides = law_.sliding == static_cast<std::ptrdiff_t>(i);
    if (law_.kind == FrictionLaw::Kind::stick && !slides) {
      put(row_++, own.slip);
      return;
    }
    const double ratio = slides ? law_.value : u_[layout_.ratio];
    Row row{touch.friction_force - ratio * touch.normal_force,
            own.friction_force.by - ratio * own.normal_force.by,
            own.friction_force.by_place - ratio * own.normal_force.by_place};
    if (!slides) row.by[layout_.ratio] -= touch.normal_force;
    put(row_++, row);
  }

  /// Slip along the arc of the surface: the chord, lengthened by δβ²/24, as on a circle.
  Row slip_of(const Touch& touch, Eigen::Index column, const Row& x) const {
    const Touch::Before& before = touch.before;
    const double along = x.value - place_.travel - before.on_surface;
    const double across = touch.z - place_.height - before.below;
    const double turned = touch.inclination - before.inclination;
    const double arc = std::copysign(std::hypot(along, across), along) * (1 + turned * turned / 24);
    const double stretch = 1 - touch.offset * std::midpoint(touch.curvature, before.curvature);
    const double by_x = 1 / std::cos(touch.inclination);
    Row slip{arc - (touch.offset - before.offset) + touch.side * stretch * (touch.S - before.S),
             by_x * x.by,
             {-by_x, 0}};
    if (touch.where == TouchPoint::face) slip.by[column + 2] -= 1;
    if (touch.where == TouchPoint::mantle) slip.by[column + 2] += touch.side * stretch;
    return slip;
  }

  void add_law(Eigen::Index index) {
    const Touching& first = system_.touching.front();
    const Touch& touch = contact_.touches.front();
    system_.law = index;
    system_.held = first.slip;
    Row row;
    if (law_.kind == FrictionLaw::Kind::moved) {
      row = first.slip;
      row.value -= law_.value;
    } else if (law_.kind == FrictionLaw::Kind::place) {
      row = first.slip;
      row.value = (touch.x - place_.travel - law_.value) / std::cos(touch.inclination);
    } else if (law_.kind == FrictionLaw::Kind::pulled) {
      row = first.normal_force;
    } else if (law_.kind == FrictionLaw::Kind::stick) {
      row = layout_.ratio >= 0 ? Row{u_[layout_.ratio], unit(layout_.ratio)} : first.slip;
    } else if (layout_.ratio >= 0) {
      row = {u_[layout_.ratio] - law_.value, unit(layout_.ratio)};
    } else {
      row = {first.friction_force.value - law_.value * first.normal_force.value,
             first.friction_force.by - law_.value * first.normal_force.by,
             first.friction_force.by_place - law_.value * first.normal_force.by_place};
    }
    put(index, row);
  }

  void summarise() {
    double normal = 0;
    double friction = 0;
    double weight = 0;
    double x = 0;
    double z = 0;
    for (const Touch& touch : contact_.touches) {
      normal += touch.normal_force;
      friction += touch.friction_force;
      const double share = std::max(touch.normal_force, 0.0);
      weight += share;
      x += share * touch.x;
      z += share * touch.z;
    }
    contact_.normal_force = normal;
    contact_.friction_force = friction;
    const Touch& first = contact_.touches.front();
    const bool is_mean = contact_.touches.size() > 1 && weight > 0;
    contact_.contact_x = is_mean ? x / weight : first.x;
    contact_.contact_z = is_mean ? z / weight : first.z;
  }

  const TipProblem& problem_;
  const surroundings::Surface& surface_;
  const SurfacePlace& place_;
  const FrictionLaw& law_;
  const Layout& layout_;
  TipContact& contact_;
  Vector u_;
  System system_;
  Eigen::Index row_ = 1;
  Section section_;
  Force force_;
};

inline Vector unknowns_of(const TipContact& contact, const Layout& layout) {
  Vector u = Vector::Zero(layout.size);
  u[0] = contact.base_moment;
  double normal_force = 0;
  double friction_force = 0;
  for (std::size_t i = 0; i < contact.touches.size(); ++i) {
    const Touch& touch = contact.touches[i];
    u[layout.columns[i]] = touch.force_x;
    u[layout.columns[i] + 1] = touch.force_z;
    if (is_tangent(touch))
      u[layout.columns[i] + 2] = touch.where == TouchPoint::face ? touch.offset : touch.S;
    normal_force += touch.normal_force;
    friction_force += touch.friction_force;
  }
  if (layout.ratio >= 0 && normal_force > 0) u[layout.ratio] = friction_force / normal_force;
  return u;
}

}  // namespace ciliaval::analytic::elastica::point_forces
