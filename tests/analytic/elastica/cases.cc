// SPDX-License-Identifier: LGPL-2.1-or-later
#include "cases.h"

#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <utility>

namespace ciliaval::analytic {
namespace {

const Real pi = boost::math::constants::pi<Real>();

Segment segment(std::string name, double length, double young_modulus) {
  Segment s;
  s.name = std::move(name);
  s.length = length;
  s.young_modulus = young_modulus;
  s.poisson_ratio = 0.49;
  return s;
}

}  // namespace

Cilium paper_cilium() {
  return {3e-3, {segment("base", 3e-3, 0.1e6), segment("magnet", 17e-3, 3e6)}};
}

Cilium three_segments() {
  return {2e-3,
          {segment("foot", 4e-3, 2e9), segment("joint", 5e-3, 40e3), segment("top", 11e-3, 3e6)}};
}

Cilium uniform_cilium() {
  return {1e-3, {segment("all", 20e-3, 1e6)}};
}

double bending_stiffness(const Cilium& cilium, std::size_t segment) {
  return cilium.segments[segment].young_modulus * cilium.second_moment();
}

elastica::ElasticaOptions height_form() {
  elastica::ElasticaOptions options;
  options.form = elastica::ElasticaOptions::Form::height;
  return options;
}

MechanicsStep solve(const Cilium& cilium, const Load& load,
                    const elastica::ElasticaOptions& options) {
  MechanicsStep step = elastica::Elastica(options).solve(cilium, {load}).steps.at(0);
  EXPECT_EQ(step.status, Status::converged) << step.message;
  if (!step.deformation) throw std::runtime_error("no deformation: " + step.message);
  return step;
}

PlanarPoint planar_point(const MechanicsStep& step, double S) {
  const Vector3 e = direction(step.load);
  const CentrelinePoint point = step.deformation->centreline.at(S);
  const Vector3 normal = point.normal();
  return {point.position.dot(e), point.position.z(), std::atan2(normal.dot(e), normal.z())};
}

PointForceElastica::PointForceElastica(Real lambda, const Real& p_squared)
    : lambda_(std::move(lambda)), p_(sqrt(p_squared)), sine_(2 * p_squared - 1) {
  const Real psi0 = asin(sin(pi / 4) / p_);
  f0_ = boost::math::ellint_1(p_, psi0);
  e0_ = boost::math::ellint_2(p_, psi0);
}

PointForceElastica PointForceElastica::with_end_angle(const Real& lambda, const Real& sine) {
  return {lambda, (1 + sine) / 2};
}

PointForceElastica PointForceElastica::with_length(const Real& lambda, const Real& length) {
  // The length grows with θ_c; bisection in ln tan θ_c, which resolves both ends of 0 < θ_c < π/2.
  Real low = -100;
  Real high = 50;
  for (int i = 0; i < 130; ++i) {
    const Real middle = (low + high) / 2;
    const Real tangent = exp(middle);
    const PointForceElastica trial = with_end_angle(lambda, tangent / sqrt(1 + tangent * tangent));
    (trial.length() < length ? low : high) = middle;
  }
  const Real tangent = exp(low);
  return with_end_angle(lambda, tangent / sqrt(1 + tangent * tangent));
}

Real PointForceElastica::length() const {
  return (boost::math::ellint_1(p_) - f0_) / lambda_;
}

Real PointForceElastica::height() const {
  return sqrt(2 * sine_) / lambda_;
}

Real PointForceElastica::deflection() const {
  return length() - 2 * (boost::math::ellint_2(p_) - e0_) / lambda_;
}

Real PointForceElastica::end_angle() const {
  return asin(sine_);
}

PointForceElastica::Point PointForceElastica::at(const Real& theta) const {
  const Real psi = asin(sin(pi / 4 + theta / 2) / p_);
  const Real S = (boost::math::ellint_1(p_, psi) - f0_) / lambda_;
  const Real w = S - 2 * (boost::math::ellint_2(p_, psi) - e0_) / lambda_;
  return {S, w, (sqrt(2 * sine_) - sqrt(2 * (sine_ - sin(theta)))) / lambda_};
}

UniformSlipOff uniform_slip_off(const Real& sine) {
  const PointForceElastica unit = PointForceElastica::with_end_angle(1, sine);
  const Real length = unit.length();
  return {unit.height() / length, length * length};
}

}  // namespace ciliaval::analytic
