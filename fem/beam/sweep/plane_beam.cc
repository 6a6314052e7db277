// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/sweep/plane_beam.h"

#include <cmath>

#include "fem/beam/kinematics.h"
#include "problem/lagrange.h"

namespace ciliaval::fem::beam::sweep {
namespace {

using Eigen::Index;
using Complex = std::complex<double>;

}  // namespace

/// φ and κ at a Gauss point, and what their derivatives are made of: v_a = exp(iθ_a/2)/p, σ = p′/p,
/// u_a = D_a − N_a σ.
struct PlaneBeam::GaussPoint {
  Complex p;
  Complex sigma;
  double angle = 0;
  double kappa = 0;
};

PlaneBeam::PlaneBeam(const System& system)
    : system_(system),
      reference_(system.reference_element()),
      degree_(system.mesh().degree),
      nodes_(degree_ * system.mesh().n_elements() + 1) {
  const double L = system.length_scale();
  const double P = system.force_scale();
  const State straight = system.reference_state();
  for (std::size_t e = 0; e < system.mesh().n_elements(); ++e) {
    const Section& law = system.mesh().sections[e];
    const auto& S = system.mesh().vertices;
    elements_.push_back({(S[e + 1] - S[e]) / L, law.moment_compliance[1] * P * L * L,
                         law.force_compliance[0] * P, law.force_compliance[2] * P});
  }
  for (std::size_t j = 0; j < nodes_; ++j)
    arclengths_.push_back(system.node_arclength(straight, j) / L);
}

PlaneBeam::GaussPoint PlaneBeam::gauss_point(const Eigen::VectorXd& angles, std::size_t element,
                                             std::size_t g) const {
  GaussPoint point{};
  Complex slope;
  for (std::size_t a = 0; a <= degree_; ++a) {
    const Complex u = std::polar(1.0, angle(angles, element * degree_ + a) / 2);
    point.p += reference_.N(g, a) * u;
    slope += reference_.D(g, a) * u;
  }
  point.sigma = slope / point.p;
  // The angle of p alone is one of (−π, π]: the section's is near that of a neighbour.
  const double near = angle(angles, element * degree_);
  point.angle = near + 2 * std::arg(point.p * std::polar(1.0, -near / 2));
  point.kappa = 2 * point.sigma.imag();
  return point;
}

Response PlaneBeam::respond(const Eigen::VectorXd& angles, const Vector2d& force,
                            const Viscosity& viscosity) const {
  const Index n = n_angles();
  const bool viscous = viscosity.last_curvature.size() > 0;
  Response result{.gradient = Eigen::VectorXd::Zero(n),
                  .hessian = Eigen::MatrixXd::Zero(n, n),
                  .tip = Vector2d::Zero(),
                  .tip_turning = Eigen::Matrix2Xd::Zero(2, n),
                  .compliance = Eigen::Matrix2d::Zero()};
  std::vector<Complex> nodal(degree_ + 1);
  std::vector<Complex> v(degree_ + 1);
  std::vector<Complex> u(degree_ + 1);
  std::vector<double> phi(degree_ + 1);
  std::vector<double> kappa(degree_ + 1);
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Element& element = elements_[e];
    const Index first = static_cast<Index>(e * degree_) - 1;  // of node 0, which is held: −1
    for (std::size_t a = 0; a <= degree_; ++a)
      nodal[a] = std::polar(1.0, angle(angles, e * degree_ + a) / 2);
    for (std::size_t g = 0; g < degree_; ++g) {
      const GaussPoint x = gauss_point(angles, e, g);
      const Index point = static_cast<Index>(e * degree_ + g);
      const double weight = reference_.weights[g];
      const double stiffness = weight / (element.length * element.bending_compliance);
      const double length = weight * element.length;
      const Vector2d normal = d3(x.angle);
      const Vector2d across = d1(x.angle);
      const double axial = force.dot(normal);
      const double shear = force.dot(across);
      const double c1 = element.shear_compliance;
      const double c3 = element.axial_compliance;
      result.energy += stiffness * x.kappa * x.kappa / 2 +
                       length * (c1 * shear * shear + c3 * axial * axial) / 2;
      result.tip += length * (normal + c1 * shear * across + c3 * axial * normal);
      result.compliance +=
          length * (c1 * across * across.transpose() + c3 * normal * normal.transpose());
      const double factor = 1 + (c3 - c1) * axial;
      const Vector2d turning = length * (factor * across + (c3 - c1) * shear * normal);
      const double turn = length * shear * factor;                                 // V′
      const double bend = length * (-axial * factor + (c3 - c1) * shear * shear);  // V″
      const double a_ratio = viscous ? viscosity.ratio : 0.0;
      const double moment =
          stiffness *
          (x.kappa + (viscous ? a_ratio * (x.kappa - viscosity.last_curvature[point]) : 0.0));
      const double tangent = stiffness * (1 + a_ratio);
      for (std::size_t a = 0; a <= degree_; ++a) {
        v[a] = nodal[a] / x.p;
        u[a] = (reference_.D(g, a) - reference_.N(g, a) * x.sigma) * v[a];
        phi[a] = reference_.N(g, a) * v[a].real();
        kappa[a] = u[a].real();
      }
      for (std::size_t a = 0; a <= degree_; ++a) {
        const Index i = first + static_cast<Index>(a);
        if (i < 0) continue;
        const double Na = reference_.N(g, a);
        result.gradient[i] += moment * kappa[a] - turn * phi[a];
        result.tip_turning.col(i) += phi[a] * turning;
        // φ_ab = ½ [N_a N_b Im(v_a v_b) − δ_ab N_a Im v_a],
        // κ_ab = ½ Im(N_a v_a u_b + N_b v_b u_a) − ½ δ_ab Im u_a.
        for (std::size_t b = 0; b <= a; ++b) {
          const Index j = first + static_cast<Index>(b);
          if (j < 0) continue;
          const double Nb = reference_.N(g, b);
          double phi_ab = Na * Nb * (v[a] * v[b]).imag() / 2;
          double kappa_ab = (Na * (v[a] * u[b]).imag() + Nb * (v[b] * u[a]).imag()) / 2;
          if (a == b) {
            phi_ab -= Na * v[a].imag() / 2;
            kappa_ab -= u[a].imag() / 2;
          }
          const double value = tangent * kappa[a] * kappa[b] + moment * kappa_ab -
                               bend * phi[a] * phi[b] - turn * phi_ab;
          result.hessian(i, j) += value;
          if (i != j) result.hessian(j, i) += value;
        }
      }
    }
  }
  return result;
}

Eigen::VectorXd PlaneBeam::curvature(const Eigen::VectorXd& angles) const {
  Eigen::VectorXd result(n_angles());
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (std::size_t g = 0; g < degree_; ++g)
      result[static_cast<Index>(e * degree_ + g)] = gauss_point(angles, e, g).kappa;
  return result;
}

double PlaneBeam::dissipation(const Eigen::VectorXd& angles, const Viscosity& viscosity) const {
  const Eigen::VectorXd change = curvature(angles) - viscosity.last_curvature;
  double sum = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (std::size_t g = 0; g < degree_; ++g)
      sum += reference_.weights[g] / (elements_[e].length * elements_[e].bending_compliance) *
             viscosity.ratio * std::pow(change[static_cast<Index>(e * degree_ + g)], 2);
  return sum;
}

Eigen::VectorXd PlaneBeam::pulled_aside(double force) const {
  Eigen::VectorXd angles(n_angles());
  double turned = 0;
  for (std::size_t j = 1; j < nodes_; ++j) {
    const double a = arclengths_[j - 1];
    const double b = arclengths_[j];
    turned += force * elements_[(j - 1) / degree_].bending_compliance * (b - a) * (1 - (a + b) / 2);
    angles[static_cast<Index>(j) - 1] = turned;
  }
  return angles;
}

State PlaneBeam::state(const Eigen::VectorXd& angles, const Vector2d& force, double azimuth) const {
  const double L = system_.length_scale();
  const double P = system_.force_scale();
  const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
  const Vector3 axis(-e[1], e[0], 0);  // e₃ × e, about which a positive angle turns
  const auto in_space = [&](const Vector2d& v) {
    return Vector3(v[0] * e + v[1] * Vector3::UnitZ());
  };
  const auto turned = [&](double by) { return exponential(by * axis); };
  State state = system_.reference_state();
  for (std::size_t j = 0; j < nodes_; ++j) state.rotation[j] = turned(angle(angles, j));
  // dr/dξ is known at the Gauss points: r at the nodes is the integral of the polynomial through
  // them, exact on the Gauss points between the element's first node and the node.
  const LagrangeBasis gauss(reference_.points);
  std::vector<double> values(degree_);
  for (std::size_t el = 0; el < elements_.size(); ++el) {
    const Element& element = elements_[el];
    std::vector<Vector2d> slopes;
    for (std::size_t g = 0; g < degree_; ++g) {
      const GaussPoint x = gauss_point(angles, el, g);
      const Vector2d normal = d3(x.angle);
      const Vector2d across = d1(x.angle);
      slopes.emplace_back(element.length *
                          (normal + element.shear_compliance * force.dot(across) * across +
                           element.axial_compliance * force.dot(normal) * normal));
      const Quaternion back = turned(-x.angle);
      const std::size_t k = el * degree_ + g;
      state.force[k] = back * in_space(P * force);
      state.moment[k] =
          back * (P * L * x.kappa / (element.length * element.bending_compliance) * axis);
    }
    for (std::size_t a = 1; a <= degree_; ++a) {
      const double end = reference_.nodes[a];
      Vector2d way = Vector2d::Zero();
      for (std::size_t q = 0; q < degree_; ++q) {
        gauss.values(end * reference_.points[q], values);
        for (std::size_t g = 0; g < degree_; ++g)
          way += end * reference_.weights[q] * values[g] * slopes[g];
      }
      state.position[el * degree_ + a] = state.position[el * degree_] + L * in_space(way);
    }
  }
  return state;
}

}  // namespace ciliaval::fem::beam::sweep
