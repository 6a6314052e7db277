// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/beam/element.h"

#include "fem/beam/kinematics.h"

namespace ciliaval::fem::beam {
namespace {

using Eigen::Index;

/// r, dr/dξ, p and dp/dξ at a Gauss point.
struct Interpolation {
  Vector3 r = Vector3::Zero();
  Vector3 t = Vector3::Zero();
  Vector4 p = Vector4::Zero();
  Vector4 s = Vector4::Zero();

  Interpolation(const ReferenceElement& reference, std::span<const Vector3> position,
                std::span<const Quaternion> rotation, std::size_t g) {
    for (std::size_t a = 0; a < reference.n_nodes(); ++a) {
      const double N = reference.N(g, a);
      const double D = reference.D(g, a);
      r += N * position[a];
      t += D * position[a];
      p += N * rotation[a].coeffs();
      s += D * rotation[a].coeffs();
    }
  }
};

Index node_row(std::size_t a) {
  return static_cast<Index>(6 * a);
}

Index point_row(const ReferenceElement& reference, std::size_t g) {
  return static_cast<Index>(6 * (reference.n_nodes() + g));
}

/// Adds one Gauss point's part of the residual; `gradient` collects ∂Π/∂q_a.
void add_residual(const ReferenceElement& reference, const ElementData& data, std::size_t g,
                  const Interpolation& x, const Strain& strain, const StressPower& f,
                  const Vector3& n, const Vector3& m, Eigen::VectorXd& residual,
                  std::vector<Vector4>& gradient) {
  const double w = reference.weights[g];
  const double h = data.length;
  const Vector3 load = h * data.force_per_length + x.t[2] * data.force_per_height;
  for (std::size_t a = 0; a < reference.n_nodes(); ++a) {
    const double N = w * reference.N(g, a);
    const double D = w * reference.D(g, a);
    residual.segment<3>(node_row(a)) += D * f.t - N * load;
    gradient[a] += N * f.p + D * f.s;
  }
  const Index row = point_row(reference, g);
  const double compliant = data.compliant_length();
  residual.segment<3>(row) =
      w * (strain.gamma - data.gamma0[g] - compliant * data.section.force_strain(n, m));
  residual.segment<3>(row + 3) =
      w * (strain.kappa - data.kappa0[g] - compliant * data.section.moment_strain(n, m));
}

/// m·Λᵀc as a function of p, of a material vector m: the power of a force m on a tangent c.
StressPower turned_magnet(const Interpolation& x, const Vector3& c, const Vector3& m) {
  return stress_power(x.p, c, strain(x.p, x.s, c), m, Vector3::Zero());
}

/// The uniform field's c·d₃ (law R) and C₁·d₁ + C₂·d₂, with its derivatives by p.
struct TurningPower {
  double value = 0;
  Vector4 p = Vector4::Zero();
  Matrix4 pp = Matrix4::Zero();
};

TurningPower turning_power(const ElementData& data, const Interpolation& x) {
  TurningPower sum;
  const auto add = [&](const Vector3& c, int director) {
    if (c.isZero(0)) return;
    const StressPower d = turned_magnet(x, c, Vector3::Unit(director));
    sum.value += d.value;
    sum.p += d.p;
    sum.pp += d.pp;
  };
  if (data.magnetic_energy == surroundings::MagneticEnergy::R) add(data.magnetic_force, 2);
  for (const int i : {0, 1}) add(data.transverse_force.col(i), i);
  return sum;
}

/// −A B(r)·(M₁ d₁ + M₂ d₂ + M₃ d₃) of the magnets at a Gauss point, M₃ by the law R alone, with its
/// derivatives by r and p.
struct MagnetPower {
  StressPower by_p{};  ///< value, p and pp
  Vector3 r = Vector3::Zero();
  Matrix3 rr = Matrix3::Zero();
  Matrix34 rp = Matrix34::Zero();
};

/// A M of what turns with the sections, material components, A·m.
Vector3 turning_charge(const ElementData& data) {
  const Eigen::Vector2d& across = data.transverse_charge;
  const bool turns = data.magnetic_energy == surroundings::MagneticEnergy::R;
  return {across[0], across[1], turns ? data.magnetic_charge : 0};
}

/// True if the element has a part of the energy in the magnets' field.
bool feels_magnets(const ElementData& data) {
  return !data.magnets.empty() && !turning_charge(data).isZero(0);
}

MagnetPower magnet_power(const ElementData& data, const Interpolation& x) {
  MagnetPower power;
  if (!feels_magnets(data)) return power;
  surroundings::magnets::FieldJet jet;
  for (const auto& magnet : data.magnets) jet += surroundings::magnets::jet(magnet, x.r);
  const Vector3 m = -turning_charge(data);
  power.by_p = turned_magnet(x, jet.B, m);
  const Vector3 turned = power.by_p.t;
  power.r = jet.gradient.transpose() * turned;
  for (int k = 0; k < 3; ++k) {
    power.rr.row(k) = turned.transpose() * jet.second[static_cast<std::size_t>(k)];
    power.rp.row(k) = turned_magnet(x, jet.gradient.col(k), m).p.transpose();
  }
  return power;
}

/// Adds h times it to the power f of the section forces, and what depends on r to the residual and
/// tangent of the element.
void add_magnet_power(const ReferenceElement& reference, const ElementData& data, std::size_t g,
                      const Interpolation& x, const std::vector<Matrix43>& E, StressPower& f,
                      Eigen::VectorXd& residual, Eigen::MatrixXd* tangent) {
  if (!feels_magnets(data)) return;
  const MagnetPower power = magnet_power(data, x);
  const double w = reference.weights[g] * data.length;
  f.p += data.length * power.by_p.p;
  f.pp += data.length * power.by_p.pp;
  for (std::size_t a = 0; a < reference.n_nodes(); ++a) {
    const double Na = w * reference.N(g, a);
    residual.segment<3>(node_row(a)) += Na * power.r;
    if (tangent == nullptr) continue;
    for (std::size_t b = 0; b < reference.n_nodes(); ++b) {
      const double N = Na * reference.N(g, b);
      const Matrix3 coupling = N * power.rp * E[b];
      tangent->block<3, 3>(node_row(a), node_row(b)) += N * power.rr;
      tangent->block<3, 3>(node_row(a), node_row(b) + 3) += coupling;
      tangent->block<3, 3>(node_row(b) + 3, node_row(a)) += coupling.transpose();
    }
  }
}

/// Takes c·∂r/∂ξ or h c·d₃, and h (C₁·d₁ + C₂·d₂), off the power f of the section forces, per unit
/// of ξ.
void add_magnetic_energy(const ElementData& data, const Interpolation& x, StressPower& f) {
  if (data.magnetic_force.isZero(0) && data.transverse_force.isZero(0)) return;
  if (data.magnetic_energy == surroundings::MagneticEnergy::F) {
    f.value -= data.magnetic_force.dot(x.t);
    f.t -= data.magnetic_force;
  }
  const TurningPower turned = turning_power(data, x);
  f.value -= data.length * turned.value;
  f.p -= data.length * turned.p;
  f.pp -= data.length * turned.pp;
}

/// Adds one Gauss point's part of the tangent, without the curvature of the rotation update.
void add_tangent(const ReferenceElement& reference, const ElementData& data, std::size_t g,
                 const Strain& strain, const StressPower& f, const Vector3& n, const Vector3& m,
                 const std::vector<Matrix43>& E, Eigen::MatrixXd& K) {
  const double w = reference.weights[g];
  const Index row = point_row(reference, g);
  for (std::size_t a = 0; a < reference.n_nodes(); ++a) {
    const Index ra = node_row(a);
    const double Na = reference.N(g, a);
    const double Da = reference.D(g, a);
    for (std::size_t b = 0; b < reference.n_nodes(); ++b) {
      const Index rb = node_row(b);
      const double Nb = reference.N(g, b);
      const double Db = reference.D(g, b);
      const Matrix4 H = Na * Nb * f.pp + Na * Db * f.sp.transpose() + Da * Nb * f.sp;
      K.block<3, 3>(ra + 3, rb + 3) += w * E[a].transpose() * H * E[b];
      K.block<3, 3>(ra, rb + 3) += w * Da * Nb * f.tp * E[b];
      K.block<3, 3>(ra + 3, rb) += w * Na * Db * E[a].transpose() * f.tp.transpose();
      K.block<3, 1>(ra, rb + 2) -= w * Na * Db * data.force_per_height;
    }
    const Matrix3 force_spin = w * Na * strain.gamma_p * E[a];
    const Matrix3 moment_spin = w * (Na * strain.kappa_p + Da * strain.kappa_s) * E[a];
    K.block<3, 3>(row, ra) = w * Da * strain.gamma_t;
    K.block<3, 3>(ra, row) = w * Da * strain.gamma_t.transpose();
    K.block<3, 3>(row, ra + 3) = force_spin;
    K.block<3, 3>(ra + 3, row) = force_spin.transpose();
    K.block<3, 3>(row + 3, ra + 3) = moment_spin;
    K.block<3, 3>(ra + 3, row + 3) = moment_spin.transpose();
  }
  K.block<6, 6>(row, row) = -w * data.compliant_length() * data.section.compliance(n, m);
}

/// ∂(E_aᵀ g_a)/∂θ_a at constant g_a: ¼ (e_i∘e_j∘q)·g = −¼ (q·g) δ_ij + ½ ε_ijk R_k, R = E_aᵀ g_a.
Matrix3 update_curvature(const Quaternion& q, const Vector4& g, const Vector3& R) {
  Matrix3 K = -0.25 * q.coeffs().dot(g) * Matrix3::Identity();
  K(0, 1) += R[2] / 2;
  K(1, 2) += R[0] / 2;
  K(2, 0) += R[1] / 2;
  K(1, 0) -= R[2] / 2;
  K(2, 1) -= R[0] / 2;
  K(0, 2) -= R[1] / 2;
  return K;
}

}  // namespace

void set_reference_strains(const ReferenceElement& reference, std::span<const Vector3> position,
                           std::span<const Quaternion> rotation, ElementData& data) {
  data.gamma0.resize(reference.n_points());
  data.kappa0.resize(reference.n_points());
  for (std::size_t g = 0; g < reference.n_points(); ++g) {
    const Interpolation x(reference, position, rotation, g);
    const Strain e = strain(x.p, x.s, x.t);
    data.gamma0[g] = e.gamma;
    data.kappa0[g] = e.kappa;
  }
}

double element_energy(const ReferenceElement& reference, const ElementData& data,
                      const ElementState& state) {
  double energy = 0;
  for (std::size_t g = 0; g < reference.n_points(); ++g) {
    const Interpolation x(reference, state.position, state.rotation, g);
    const Strain e = strain(x.p, x.s, x.t);
    const Vector3& n = state.force[g];
    const Vector3& m = state.moment[g];
    const double complementary = data.section.complementary_energy(n, m);
    StressPower magnetic{};
    add_magnetic_energy(data, x, magnetic);
    magnetic.value += data.length * magnet_power(data, x).by_p.value;
    energy +=
        reference.weights[g] *
        (magnetic.value + n.dot(e.gamma - data.gamma0[g]) + m.dot(e.kappa - data.kappa0[g]) -
         data.compliant_length() * complementary - data.length * data.force_per_length.dot(x.r));
  }
  return energy;
}

void element_residual(const ReferenceElement& reference, const ElementData& data,
                      const ElementState& state, Eigen::VectorXd& residual,
                      Eigen::MatrixXd* tangent) {
  const std::size_t n_nodes = reference.n_nodes();
  residual.setZero(reference.n_unknowns());
  if (tangent != nullptr) tangent->setZero(reference.n_unknowns(), reference.n_unknowns());
  std::vector<Matrix43> E(n_nodes);
  for (std::size_t a = 0; a < n_nodes; ++a) E[a] = spin_derivative(state.rotation[a]);
  std::vector<Vector4> gradient(n_nodes, Vector4::Zero());

  for (std::size_t g = 0; g < reference.n_points(); ++g) {
    const Interpolation x(reference, state.position, state.rotation, g);
    const Strain e = strain(x.p, x.s, x.t);
    StressPower f = stress_power(x.p, x.t, e, state.force[g], state.moment[g]);
    add_magnetic_energy(data, x, f);
    add_magnet_power(reference, data, g, x, E, f, residual, tangent);
    add_residual(reference, data, g, x, e, f, state.force[g], state.moment[g], residual, gradient);
    if (tangent != nullptr)
      add_tangent(reference, data, g, e, f, state.force[g], state.moment[g], E, *tangent);
  }
  for (std::size_t a = 0; a < n_nodes; ++a) {
    const Vector3 moment = E[a].transpose() * gradient[a];
    residual.segment<3>(node_row(a) + 3) = moment;
    if (tangent != nullptr)
      tangent->block<3, 3>(node_row(a) + 3, node_row(a) + 3) +=
          update_curvature(state.rotation[a], gradient[a], moment);
  }
}

Eigen::VectorXd element_length_derivative(const ReferenceElement& reference,
                                          const ElementData& data, const ElementState& state) {
  Eigen::VectorXd derivative = Eigen::VectorXd::Zero(reference.n_unknowns());
  for (std::size_t g = 0; g < reference.n_points(); ++g) {
    const double w = reference.weights[g];
    const Interpolation x(reference, state.position, state.rotation, g);
    const MagnetPower magnets = magnet_power(data, x);
    const Vector4 by_p = magnets.by_p.p - turning_power(data, x).p;
    for (std::size_t a = 0; a < reference.n_nodes(); ++a) {
      const double wN = w * reference.N(g, a);
      derivative.segment<3>(node_row(a)) += wN * (magnets.r - data.force_per_length);
      derivative.segment<3>(node_row(a) + 3) +=
          wN * spin_derivative(state.rotation[a]).transpose() * by_p;
    }
    const Index row = point_row(reference, g);
    derivative.segment<3>(row) =
        -w * (Vector3::UnitZ() + data.section.force_strain(state.force[g], state.moment[g]));
    derivative.segment<3>(row + 3) =
        -w * data.section.moment_strain(state.force[g], state.moment[g]);
  }
  return derivative;
}

}  // namespace ciliaval::fem::beam
