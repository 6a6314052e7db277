// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/tip.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <tuple>

namespace ciliaval::fem::beam::sweep {
using surroundings::ProfilePoint;
using surroundings::Surface;
namespace {

using Eigen::Index;

constexpr unsigned int patience = 10;  ///< iterations before convergence must set in
constexpr double largest_turn = 0.5;   ///< of an angle in an iteration, rad

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

Tip::Tip(const PlaneBeam& beam, const Surface& surface, double length, double radius,
         double tolerance, unsigned int max_iterations)
    : beam_(beam),
      surface_(surface),
      length_(length),
      radius_(radius),
      tolerance_(tolerance),
      max_iterations_(max_iterations),
      difference_(1e-5 * std::min(1.0, surface.finest_length() / length)) {}

ProfilePoint Tip::profile(double xi) const {
  const ProfilePoint point = surface_.extended(xi * length_);
  return {point.height / length_, point.slope};
}

double Tip::profile_curvature(double xi) const {
  return (profile(xi + difference_).slope - profile(xi - difference_).slope) / (2 * difference_);
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
  if (state.status.touch == Touch::both) return arc(start.xi, state.pair.xi);
  return arc(start.xi, state.pair.xi) - (state.pair.eta - start.eta);
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
  if (status.touch == Touch::both)
    return both_ends(status, place, start, viscosity, unknowns, residual, J);
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
  const double turning = profile_curvature(xi) / (1 + profile.slope * profile.slope);  // dβ/dξ
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

/// With ξ₂ = ξ₁ + 2R cos θ and the forces N_i l_i, l_i = n_i + τ t_i, at η = ∓R.
void Tip::both_ends(const ContactStatus& status, const Place& place, const Pair& start,
                    const Viscosity& viscosity, const Eigen::VectorXd& unknowns,
                    Eigen::VectorXd& residual, Eigen::MatrixXd& J) const {
  const Index n = beam_.n_angles();
  const double N1 = unknowns[n];
  const double N2 = unknowns[n + 1];
  const double xi = unknowns[n + 2];
  const double ratio = unknowns[n + 3];
  const double theta = unknowns[n - 1];
  const double R = radius_;
  const double front_xi = xi + 2 * R * std::cos(theta);
  const double front_turning = -2 * R * std::sin(theta);  // ∂ξ₂/∂θ
  const ProfilePoint p1 = profile(xi);
  const ProfilePoint p2 = profile(front_xi);
  const double beta1 = std::atan(p1.slope);
  const double beta2 = std::atan(p2.slope);
  const Vector2d l1 = normal(beta1) + ratio * tangent(beta1);
  const Vector2d l2 = normal(beta2) + ratio * tangent(beta2);
  // ∂(N_i l_i)/∂ξ_i.
  const Vector2d turned1 = N1 * profile_curvature(xi) / (1 + p1.slope * p1.slope) *
                           (ratio * normal(beta1) - tangent(beta1));
  const Vector2d turned2 = N2 * profile_curvature(front_xi) / (1 + p2.slope * p2.slope) *
                           (ratio * normal(beta2) - tangent(beta2));
  // Derivatives of both forces by N₁, N₂, ξ₁, τ and θ.
  Eigen::Matrix<double, 2, 5> by1 = Eigen::Matrix<double, 2, 5>::Zero();
  Eigen::Matrix<double, 2, 5> by2 = by1;
  by1.col(0) = l1;
  by1.col(2) = turned1;
  by1.col(3) = N1 * tangent(beta1);
  by2.col(1) = l2;
  by2.col(2) = turned2;
  by2.col(3) = N2 * tangent(beta2);
  by2.col(4) = front_turning * turned2;
  const Vector2d force = N1 * l1 + N2 * l2;
  const Vector2d couple = R * (N2 * l2 - N1 * l1);
  const Eigen::Matrix<double, 2, 5> force_by = by1 + by2;
  const Eigen::Matrix<double, 2, 5> couple_by = R * (by2 - by1);

  const Response beam = beam_.respond(unknowns.head(n), force, viscosity);
  residual.resize(n + 4);
  J.setZero(n + 4, n + 4);
  residual.head(n) = beam.gradient;
  residual[n - 1] += couple.dot(d3(theta));
  residual.segment<2>(n) =
      beam.tip - R * d1(theta) - Vector2d(place.travel + xi, place.height - p1.height);
  residual[n + 2] = status.slip == 0 ? arc(start.xi, xi) : ratio - status.slip * surface_.friction;
  residual[n + 3] = p2.height - p1.height - 2 * R * std::sin(theta);

  J.topLeftCorner(n, n) = beam.hessian;
  J.block(n, 0, 2, n) = beam.tip_turning;
  for (Index k = 0; k < 5; ++k) {
    const Index column = k < 4 ? n + k : n - 1;
    J.col(column).head(n) -= beam.tip_turning.transpose() * force_by.col(k);
    J(n - 1, column) += couple_by.col(k).dot(d3(theta));
    J.col(column).segment<2>(n) += beam.compliance * force_by.col(k);
  }
  J(n - 1, n - 1) += couple.dot(d1(theta));
  J.block<2, 1>(n, n - 1) += R * d3(theta);
  J.block<2, 1>(n, n + 2) += Vector2d(-1, p1.slope);
  if (status.slip == 0)
    J(n + 2, n + 2) = std::hypot(1, p1.slope);
  else
    J(n + 2, n + 3) = 1;
  J(n + 3, n + 2) = p2.slope - p1.slope;
  J(n + 3, n - 1) = -2 * R * std::cos(theta) + p2.slope * front_turning;
}

double Tip::friction_between(const TipState& before, const TipState& after) const {
  if (before.status.touch != Touch::both && after.status.touch != Touch::both) {
    const double way = slid(after, start_of(before, after.pair, after.status.touch));
    return std::abs(before.friction_force + after.friction_force) / 2 * std::abs(way);
  }
  double work = 0;
  for (const double side : {-1.0, 1.0}) {
    const auto friction = [&](const TipState& state) {
      if (state.status.touch == Touch::both)
        return state.both[3] * (side < 0 ? state.both[0] : state.both[1]);
      return state.friction_force * (1 + side * state.pair.eta / radius_) / 2;
    };
    const auto at = [&](const TipState& state) {
      return point_at(state, side * radius_)[0] - state.place.travel;
    };
    work += std::abs((friction(before) + friction(after)) / 2 * arc(at(before), at(after)));
  }
  return work;
}

Pair Tip::start_of(const TipState& before, const Pair& after, Touch touch) const {
  if (before.status.touch == touch || (before.status.touch == Touch::face && touch != Touch::both))
    return before.pair;
  const double eta = touch == Touch::both ? -radius_ : after.eta;
  return {point_at(before, eta)[0] - before.place.travel, eta};
}

Eigen::Vector4d Tip::contact_unknowns(Touch touch, const Place& place,
                                      const TipState& guess) const {
  Eigen::Vector4d unknowns;
  if (touch != Touch::both) {
    unknowns << guess.force, guess.pair.xi, guess.pair.eta;
    if (touch == Touch::rear) unknowns[3] = -radius_;
    if (touch == Touch::front) unknowns[3] = radius_;
    if (touch == Touch::none) unknowns.head<2>().setZero();
    return unknowns;
  }
  if (guess.status.touch == Touch::both) return guess.both;
  const double lever = guess.pair.eta / radius_;
  const double N = guess.normal_force;
  unknowns << N * (1 - lever) / 2, N * (1 + lever) / 2, point_at(guess, -radius_)[0] - place.travel,
      N > 0 ? guess.friction_force / N : 0;
  return unknowns;
}

void Tip::complete(TipState& state) const {
  const bool both = state.status.touch == Touch::both;
  if (both) {
    const auto [N1, N2, xi, ratio] =
        std::tuple(state.both[0], state.both[1], state.both[2], state.both[3]);
    const double beta1 = slope_angle(xi);
    const double beta2 = slope_angle(xi + 2 * radius_ * std::cos(state.angle()));
    const Vector2d F1 = N1 * (normal(beta1) + ratio * tangent(beta1));
    const Vector2d F2 = N2 * (normal(beta2) + ratio * tangent(beta2));
    state.force = F1 + F2;
    const Vector2d axis = d3(state.angle());
    state.pair = {xi, radius_ * (F2 - F1).dot(axis) / state.force.dot(axis)};
    state.normal_force = N1 + N2;
    state.friction_force = ratio * (N1 + N2);
  }
  const Response beam = beam_.respond(state.angles, state.force);
  state.energy = beam.energy;
  state.tip = beam.tip;
  state.point = point_at(state, state.pair.eta);
  if (both) return;
  const double beta = slope_angle(state.pair.xi);
  state.normal_force = state.force.dot(normal(beta));
  state.friction_force = state.force.dot(tangent(beta));
}

std::optional<TipState> Tip::solve(ContactStatus status, const Place& place, const TipState& guess,
                                   const Pair& start, const Viscosity& viscosity) const {
  const Index n = beam_.n_angles();
  Eigen::VectorXd unknowns(n + 4);
  unknowns << guess.angles, contact_unknowns(status.touch, place, guess);
  Eigen::VectorXd residual;
  Eigen::MatrixXd J;
  double last = std::numeric_limits<double>::infinity();
  for (unsigned int iteration = 1; iteration <= max_iterations_; ++iteration) {
    equations(status, place, start, viscosity, unknowns, residual, J);
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(J);
    Eigen::VectorXd change = -lu.solve(residual);
    if (!change.allFinite()) return std::nullopt;
    const double relative = (change.array() / (1 + unknowns.array().abs())).abs().maxCoeff();
    const double turn = change.head(n).lpNorm<Eigen::Infinity>();
    unknowns += change * std::min(1.0, largest_turn / std::max(turn, relative / 4));
    // p″ is right to 1e-9 or so, and a small force on a stiff beam to less than the tolerance.
    const bool is_rounding = relative < 1e-9 && relative >= last / 2;
    if (iteration >= patience && relative > last / 2 && relative > 1e-3) return std::nullopt;
    last = relative;
    if (relative > tolerance_ && !is_rounding) continue;
    TipState state;
    state.place = place;
    state.status = status;
    state.angles = unknowns.head(n);
    state.force = unknowns.segment<2>(n);
    state.pair = {unknowns[n + 2], unknowns[n + 3]};
    if (status.touch == Touch::both) state.both = unknowns.tail<4>();
    state.iterations = static_cast<int>(iteration);
    complete(state);
    if (status.touch == Touch::none) {
      state.rates = Eigen::MatrixX2d::Zero(n + 4, 2);
      return state;
    }
    // −∂(residual)/∂H and −∂(residual)/∂s, and the response to more friction.
    Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(n + 4, 3);
    sides(n + 1, 0) = 1;
    sides(n, 1) = 1;
    sides(n + 2, 2) = 1;
    const Eigen::MatrixXd responses = lu.solve(sides);
    state.rates = responses.leftCols<2>();
    const double slope = profile(state.pair.xi).slope;
    const double slide = std::hypot(1, slope) * responses(n + 2, 2) -
                         (status.touch == Touch::both ? 0 : responses(n + 3, 2));
    state.stiffness = status.slip == 0 ? 0 : 1 / slide;
    state.is_held_stable = is_determinant_positive(lu) == (status.slip == 0 || slide > 0);
    return state;
  }
  return std::nullopt;
}

}  // namespace ciliaval::fem::beam::sweep
