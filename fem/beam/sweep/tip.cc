// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/tip.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace ciliaval::fem::beam::sweep {
using surroundings::ProfilePoint;
using surroundings::Surface;
namespace {

using Eigen::Index;

constexpr double largest_turn = 0.5;  ///< of an angle in an iteration, rad

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

void Tip::complete(TipState& state) const {
  const Response beam = beam_.respond(state.angles, state.force);
  state.energy = beam.energy;
  state.tip = beam.tip;
  state.point = point_at(state, state.pair.eta);
  const double beta = slope_angle(state.pair.xi);
  state.normal_force = state.force.dot(normal(beta));
  state.friction_force = state.force.dot(tangent(beta));
}

std::optional<TipState> Tip::solve(ContactStatus status, const Place& place, const TipState& guess,
                                   const Pair& start, const Viscosity& viscosity) const {
  const Index n = beam_.n_angles();
  Eigen::VectorXd unknowns(n + 4);
  unknowns << guess.angles, guess.force, guess.pair.xi, guess.pair.eta;
  if (status.touch == Touch::rear) unknowns[n + 3] = -radius_;
  if (status.touch == Touch::front) unknowns[n + 3] = radius_;
  if (status.touch == Touch::none) unknowns.segment<2>(n).setZero();
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
    last = relative;
    if (relative > tolerance_ && !is_rounding) continue;
    TipState state;
    state.place = place;
    state.status = status;
    state.angles = unknowns.head(n);
    state.force = unknowns.segment<2>(n);
    state.pair = {unknowns[n + 2], unknowns[n + 3]};
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
    const double slide = std::hypot(1, slope) * responses(n + 2, 2) - responses(n + 3, 2);
    state.stiffness = status.slip == 0 ? 0 : 1 / slide;
    state.is_held_stable = is_determinant_positive(lu) == (status.slip == 0 || slide > 0);
    return state;
  }
  return std::nullopt;
}

}  // namespace ciliaval::fem::beam::sweep
