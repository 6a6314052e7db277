// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/tip.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "problem/support/interruption.h"

namespace ciliaval::fem::beam::sweep {
using surroundings::ProfilePoint;
using surroundings::Surface;
namespace {

using Eigen::Index;

constexpr unsigned int patience = 10;           ///< iterations before convergence must set in
constexpr double largest_iteration_turn = 0.5;  ///< of an angle in an iteration, rad

/// Tangent and normal of a surface of the slope angle β: dt/dβ = n, dn/dβ = −t.
Vector2d tangent(double beta) {
  return {std::cos(beta), -std::sin(beta)};
}
Vector2d normal(double beta) {
  return {-std::sin(beta), -std::cos(beta)};
}

bool is_determinant_positive(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) {
  bool positive = lu.permutationP().determinant() > 0;
  const auto pivots = lu.matrixLU().diagonal();
  for (Index i = 0; i < pivots.size(); ++i)
    if (pivots[i] < 0) positive = !positive;
  return positive;
}

}  // namespace

std::vector<Touch> parts(Touch touch) {
  switch (touch) {
    case Touch::none:
      return {};
    case Touch::both_ends:
      return {Touch::rear, Touch::front};
    case Touch::rear_and_face:
      return {Touch::rear, Touch::face};
    case Touch::face_and_front:
      return {Touch::face, Touch::front};
    default:
      return {touch};
  }
}

Tip::Tip(const PlaneBeam& beam, const Surface& surface, double length, double radius,
         double tolerance, unsigned int max_iterations)
    : beam_(beam),
      surface_(surface),
      length_(length),
      radius_(radius),
      tolerance_(tolerance),
      max_iterations_(max_iterations) {}

ProfilePoint Tip::profile(double xi) const {
  const ProfilePoint point = surface_.extended(xi * length_);
  return {point.height / length_, point.slope, point.curvature * length_};
}

double Tip::arc(double from, double to) const {
  const double middle = std::midpoint(from, to);
  const double half = (to - from) / 2;
  const double node = std::sqrt(0.6);
  const auto density = [&](double x) { return std::hypot(1, profile(x).slope); };
  return half *
         (5 * density(middle - node * half) + 8 * density(middle) +
          5 * density(middle + node * half)) /
         9;
}

double Tip::slid(const TipState& state, const Pair& start) const {
  const Pair& end = state.points.front().pair;
  return arc(start.xi, end.xi) - (end.eta - start.eta);
}

double Tip::gap(const TipState& state, const Place& place, double eta) const {
  const Vector2d point = point_at(state, eta);
  return place.height - profile(point[0] - place.travel).height - point[1];
}

TipState Tip::straight(const Place& place) const {
  TipState state;
  state.place = place;
  state.angles = Eigen::VectorXd::Zero(beam_.n_angles());
  state.rates = Eigen::MatrixX2d::Zero(beam_.n_angles() + 4, 2);
  return state;
}

void Tip::equations(const ContactStatus& status, const Place& place, const Pair& start,
                    const Viscosity& viscosity, const Eigen::VectorXd& unknowns,
                    Eigen::VectorXd& residual, Eigen::MatrixXd& J) const {
  if (parts(status.touch).size() == 2)
    return two_points(status, place, start, viscosity, unknowns, residual, J);
  const Index n = beam_.n_angles();
  const Eigen::VectorXd angles = unknowns.head(n);
  const Vector2d force = unknowns.segment<2>(n);
  const double xi = unknowns[n + 2];
  const double eta = unknowns[n + 3];
  const double theta = angles[n - 1];
  const Response beam = beam_.respond(angles, force, viscosity);
  residual.resize(n + 4);
  J.setZero(n + 4, n + 4);
  residual.head(n) = beam.gradient;
  residual[n - 1] += eta * force.dot(d3(theta));
  J.topLeftCorner(n, n) = beam.hessian;
  J(n - 1, n - 1) += eta * force.dot(d1(theta));
  J.block(0, n, n, 2) = -beam.tip_turning.transpose();
  J.block<1, 2>(n - 1, n) += eta * d3(theta).transpose();
  J(n - 1, n + 3) = force.dot(d3(theta));
  if (status.touch == Touch::none) {
    residual.segment<2>(n) = force;
    residual.tail<2>().setZero();
    J.bottomRightCorner<4, 4>().setIdentity();
    return;
  }
  const ProfilePoint profile = this->profile(xi);
  residual.segment<2>(n) =
      beam.tip + eta * d1(theta) - Vector2d(place.travel + xi, place.height - profile.height);
  J.block(n, 0, 2, n) = beam.tip_turning;
  J.block<2, 1>(n, n - 1) -= eta * d3(theta);
  J.block<2, 2>(n, n) = beam.compliance;
  J.block<2, 1>(n, n + 2) = Vector2d(-1, profile.slope);
  J.block<2, 1>(n, n + 3) = d1(theta);

  const double beta = std::atan(profile.slope);
  const double turning = profile.curvature / (1 + profile.slope * profile.slope);  // dβ/dξ
  if (status.slip == 0) {
    residual[n + 2] = arc(start.xi, xi) - (eta - start.eta);
    J(n + 2, n + 2) = std::hypot(1, profile.slope);
    J(n + 2, n + 3) = -1;
  } else {
    const double mu = status.slip * surface_.friction;
    const Vector2d law = tangent(beta) - mu * normal(beta);
    residual[n + 2] = force.dot(law);
    J.block<1, 2>(n + 2, n) = law.transpose();
    J(n + 2, n + 2) = turning * force.dot(normal(beta) + mu * tangent(beta));
  }
  if (status.touch == Touch::face) {
    residual[n + 3] = std::sin(beta - theta);
    J(n + 3, n + 2) = std::cos(beta - theta) * turning;
    J(n + 3, n - 1) = -std::cos(beta - theta);
  } else {
    residual[n + 3] = eta - (status.touch == Touch::rear ? -radius_ : radius_);
    J(n + 3, n + 3) = 1;
  }
}

/// The forces are F_i = N_i l_i, l_i = n_i + τ t_i.
void Tip::two_points(const ContactStatus& status, const Place& place, const Pair& start,
                     const Viscosity& viscosity, const Eigen::VectorXd& unknowns,
                     Eigen::VectorXd& residual, Eigen::MatrixXd& J) const {
  const Index n = beam_.n_angles();
  const Index friction = n + 6;  // row of its law, column of τ
  const double theta = unknowns[n - 1];
  const double ratio = unknowns[friction];
  const Vector2d axis = d3(theta);
  const Vector2d across = d1(theta);
  const std::vector<Touch> kinds = parts(status.touch);
  struct Point {
    double N, xi, eta, beta, turning;
    ProfilePoint profile;
    Vector2d force;
  };
  std::vector<Point> points;
  Vector2d force = Vector2d::Zero();
  for (Index i = n; i < friction; i += 3) {
    Point x{unknowns[i], unknowns[i + 1], unknowns[i + 2], 0, 0, profile(unknowns[i + 1]), {}};
    x.beta = std::atan(x.profile.slope);
    x.turning = x.profile.curvature / (1 + x.profile.slope * x.profile.slope);
    x.force = x.N * (normal(x.beta) + ratio * tangent(x.beta));
    force += x.force;
    points.push_back(x);
  }
  const Response beam = beam_.respond(unknowns.head(n), force, viscosity);
  residual.resize(n + 7);
  J.setZero(n + 7, n + 7);
  residual.head(n) = beam.gradient;
  J.topLeftCorner(n, n) = beam.hessian;
  // The column of an unknown on which a force at η depends.
  const auto add = [&](Index column, double eta, const Vector2d& derivative) {
    J.col(column).head(n) -= beam.tip_turning.transpose() * derivative;
    J(n - 1, column) += eta * derivative.dot(axis);
    for (const Index row : {n, n + 3})
      J.col(column).segment<2>(row) += beam.compliance * derivative;
  };
  for (std::size_t k = 0; k < 2; ++k) {
    const Point& x = points[k];
    const Index i = n + 3 * static_cast<Index>(k);  // N, ξ, η; rows of the place and the touch
    residual[n - 1] += x.eta * x.force.dot(axis);
    J(n - 1, n - 1) += x.eta * x.force.dot(across);
    J(n - 1, i + 2) += x.force.dot(axis);
    add(i, x.eta, normal(x.beta) + ratio * tangent(x.beta));
    add(i + 1, x.eta, x.N * x.turning * (ratio * normal(x.beta) - tangent(x.beta)));
    add(friction, x.eta, x.N * tangent(x.beta));
    residual.segment<2>(i) =
        beam.tip + x.eta * across - Vector2d(place.travel + x.xi, place.height - x.profile.height);
    J.block(i, 0, 2, n) += beam.tip_turning;
    J.block<2, 1>(i, n - 1) -= x.eta * axis;
    J.block<2, 1>(i, i + 1) += Vector2d(-1, x.profile.slope);
    J.block<2, 1>(i, i + 2) += across;
    if (kinds[k] == Touch::face) {
      residual[i + 2] = std::sin(x.beta - theta);
      J(i + 2, i + 1) = std::cos(x.beta - theta) * x.turning;
      J(i + 2, n - 1) = -std::cos(x.beta - theta);
    } else {
      residual[i + 2] = x.eta - (kinds[k] == Touch::rear ? -radius_ : radius_);
      J(i + 2, i + 2) = 1;
    }
  }
  if (status.slip != 0) {
    residual[friction] = ratio - status.slip * surface_.friction;
    J(friction, friction) = 1;
  } else {
    residual[friction] = arc(start.xi, points[0].xi) - (points[0].eta - start.eta);
    J(friction, n + 1) = std::hypot(1, points[0].profile.slope);
    J(friction, n + 2) = -1;
  }
}

double Tip::friction_between(const TipState& before, const TipState& after) const {
  double work = 0;
  for (const ContactPoint& point : after.points) {
    TipState there = after;
    there.points = {point};
    double friction = after.ratio * point.normal_force;
    for (const ContactPoint& last : before.points)
      if (last.part == point.part || before.points.size() + after.points.size() == 2)
        friction += before.ratio * last.normal_force;
    work += std::abs(friction / 2 * slid(there, start_of(before, point)));
  }
  return work;
}

Pair Tip::start_of(const TipState& before, const ContactPoint& after) const {
  for (const ContactPoint& point : before.points)
    if (point.part == after.part || (point.part == Touch::face && before.points.size() == 1))
      return point.pair;
  return {point_at(before, after.pair.eta)[0] - before.place.travel, after.pair.eta};
}

Eigen::VectorXd Tip::contact_unknowns(Touch touch, const TipState& guess) const {
  if (parts(touch).size() == 2) {
    Eigen::VectorXd unknowns(7);
    for (Index k = 0; k < 2; ++k) {
      const ContactPoint& point = guess.points.at(static_cast<std::size_t>(k));
      unknowns.segment<3>(3 * k) << point.normal_force, point.pair.xi, point.pair.eta;
    }
    unknowns[6] = guess.ratio;
    return unknowns;
  }
  Eigen::VectorXd unknowns(4);
  unknowns << guess.force, guess.pair.xi, guess.pair.eta;
  if (touch == Touch::rear) unknowns[3] = -radius_;
  if (touch == Touch::front) unknowns[3] = radius_;
  if (touch == Touch::none) unknowns.head<2>().setZero();
  return unknowns;
}

void Tip::complete(TipState& state, const Eigen::VectorXd& contact) const {
  const std::vector<Touch> kinds = parts(state.status.touch);
  if (kinds.size() == 2) {
    state.ratio = contact[6];
    const Vector2d axis = d3(state.angle());
    double moment = 0;
    for (Index k = 0; k < 2; ++k) {
      const double N = contact[3 * k];
      const Pair pair{contact[3 * k + 1], contact[3 * k + 2]};
      const double beta = slope_angle(pair.xi);
      const Vector2d force = N * (normal(beta) + state.ratio * tangent(beta));
      state.points.push_back({kinds[static_cast<std::size_t>(k)], N, pair});
      state.force += force;
      moment += pair.eta * force.dot(axis);
      state.normal_force += N;
    }
    state.pair = {state.points[0].pair.xi, moment / state.force.dot(axis)};
    state.friction_force = state.ratio * state.normal_force;
  } else {
    state.force = contact.head<2>();
    state.pair = {contact[2], contact[3]};
    const double beta = slope_angle(state.pair.xi);
    state.normal_force = state.force.dot(normal(beta));
    state.friction_force = state.force.dot(tangent(beta));
    if (kinds.size() == 1) {
      state.ratio = state.friction_force / state.normal_force;
      state.points = {{kinds[0], state.normal_force, state.pair}};
    }
  }
  const Response beam = beam_.respond(state.angles, state.force);
  state.energy = beam.energy;
  state.tip = beam.tip;
  state.point = point_at(state, state.pair.eta);
}

/// −∂(residual)/∂H and −∂(residual)/∂s, and the response to more friction.
void Tip::add_responses(TipState& state, const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) const {
  const Index n = beam_.n_angles();
  const bool two = state.points.size() == 2;
  const Index friction = two ? n + 6 : n + 2;
  const Index xi = two ? n + 1 : n + 2;  // of the point that slides or is held
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(lu.rows(), 3);
  for (Index row = n; row <= (two ? n + 3 : n); row += 3) {
    sides(row + 1, 0) = 1;
    sides(row, 1) = 1;
  }
  sides(friction, 2) = 1;
  const Eigen::MatrixXd responses = lu.solve(sides);
  state.rates = responses.leftCols<2>();
  const double slope = profile(state.pair.xi).slope;
  const double slide = std::hypot(1, slope) * responses(xi, 2) - responses(xi + 1, 2);
  if (state.status.slip != 0) state.stiffness = 1 / slide;
  const double largest = responses.col(2).head(n).lpNorm<Eigen::Infinity>();
  state.sliding_mode = responses.col(2).head(n) / largest;
  state.sliding_way = slide / largest;
  state.is_held_stable = is_determinant_positive(lu) == (state.status.slip == 0 || slide > 0);
}

std::optional<TipState> Tip::solve(ContactStatus status, const Place& place, const TipState& guess,
                                   const Pair& start, const Viscosity& viscosity) const {
  const Index n = beam_.n_angles();
  const Eigen::VectorXd contact = contact_unknowns(status.touch, guess);
  Eigen::VectorXd unknowns(n + contact.size());
  unknowns << guess.angles, contact;
  Eigen::VectorXd residual;
  Eigen::MatrixXd J;
  double last = std::numeric_limits<double>::infinity();
  for (unsigned int iteration = 1; iteration <= max_iterations_; ++iteration) {
    support::check_interruption();
    equations(status, place, start, viscosity, unknowns, residual, J);
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(J);
    Eigen::VectorXd change = -lu.solve(residual);
    if (!change.allFinite()) return std::nullopt;
    const double relative = (change.array() / (1 + unknowns.array().abs())).abs().maxCoeff();
    const double turn = change.head(n).lpNorm<Eigen::Infinity>();
    // About a corner of the slope's curvature full steps may go to and fro.
    const bool goes_to_and_fro = iteration > 4 && relative > 0.7 * last;
    unknowns += change * std::min(goes_to_and_fro ? 0.5 : 1.0,
                                  largest_iteration_turn / std::max(turn, relative / 4));
    // A small force on a stiff beam is right to less than the tolerance.
    const bool is_rounding = relative < 1e-9 && relative >= last / 2;
    if (iteration >= patience && relative > last / 2 && relative > 1e-3) return std::nullopt;
    last = relative;
    if (relative > tolerance_ && !is_rounding) continue;
    TipState state;
    state.place = place;
    state.status = status;
    state.angles = unknowns.head(n);
    state.iterations = static_cast<int>(iteration);
    complete(state, unknowns.tail(contact.size()));
    if (status.touch == Touch::none) {
      state.rates = Eigen::MatrixX2d::Zero(n + 4, 2);
      return state;
    }
    add_responses(state, lu);
    return state;
  }
  return std::nullopt;
}

}  // namespace ciliaval::fem::beam::sweep
