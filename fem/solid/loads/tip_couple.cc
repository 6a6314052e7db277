// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/loads/tip_couple.h"

#include <cmath>
#include <memory>
#include <numbers>

#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::fem::solid::loads {
using namespace discretisation;

TipCouple::TipCouple(const SolidSpace& space, const ExtrudedQuadrature& quadrature,
                     const MomentLoad& load)
    : moment_(load.moment),
      of_mesh_(quadrature.extent() == Extent::half ? 0.5 : 1),
      direction_(direction(load)) {
  /// Calls visit(element, point, X, dA) at the section points of the tip's own cells.
  const auto on_face = [&](const auto& visit) {
    for (std::size_t e = 0; e < space.own_elements().size(); ++e) {
      const ExtrudedCell& cell = quadrature.cells()[e];
      if (std::abs(cell.top - quadrature.height()) > 2e-9 * quadrature.height()) continue;
      for (std::size_t q = 0; q < section_points; ++q)
        visit(space.elements()[e], static_cast<Eigen::Index>(q),
              Vector3(cell.X[q], cell.Y[q], cell.top), cell.area[q]);
    }
  };
  Eigen::Vector2d area_and_first = Eigen::Vector2d::Zero();
  on_face([&](const SolidElement&, Eigen::Index, const Vector3& X, double dA) {
    area_and_first += dA * Eigen::Vector2d(1, X.dot(direction_));
  });
  sum_over_ranks(space.communicator(), {area_and_first.data(), 2});
  if (!(area_and_first[0] > 0)) throw InputError("the solid's mesh has no plane at the tip");
  const double centre = area_and_first[1] / area_and_first[0];
  for (Vector& weight : weights_) weight = space.vector();
  on_face([&](const SolidElement& element, Eigen::Index q, const Vector3& X, double dA) {
    const double x_e = X.dot(direction_) - centre;
    at_rest_ += dA * x_e * X;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t a = 0; a < 9; ++a)
        weights_[c].local_element(element.dofs[c * element_nodes + 18 + a]) +=
            dA * x_e * quadrature.section_values()(static_cast<Eigen::Index>(a), q);
  });
  sum_over_ranks(space.communicator(), {at_rest_.data(), 3});
  for (Vector& weight : weights_) weight.compress(dealii::VectorOperation::add);
}

Vector3 TipCouple::first_moment(const Vector& u) const {
  Vector3 G = at_rest_;
  for (std::size_t c = 0; c < 3; ++c) G[static_cast<Eigen::Index>(c)] += weights_[c] * u;
  return G;
}

Vector3 TipCouple::radial(double psi) const {
  return std::cos(psi) * direction_ - std::sin(psi) * Vector3::UnitZ();
}

Vector3 TipCouple::tangential(double psi) const {
  return -std::sin(psi) * direction_ - std::cos(psi) * Vector3::UnitZ();
}

double TipCouple::angle(const Vector& u) const {
  const Vector3 G = first_moment(u);
  return std::atan2(-G.z(), G.dot(direction_));
}

void TipCouple::add(const Vector3& p, Vector& forces) const {
  for (std::size_t c = 0; c < 3; ++c) forces.add(p[static_cast<Eigen::Index>(c)], weights_[c]);
}

ExternalForces TipCouple::forces() const {
  return [couple = *this](const Vector& u, Vector& total, TangentMatrix* /*tangent*/) {
    const double psi = couple.angle(u);
    const double radius = couple.first_moment(u).dot(couple.radial(psi));
    couple.add(couple.of_mesh_ * couple.moment_ / radius * couple.tangential(psi), total);
  };
}

UnknownForce TipCouple::with_unknown_angle(const Vector& u) const {
  const auto couple = std::make_shared<const TipCouple>(*this);
  UnknownForce result;
  result.amplitude = angle(u);
  result.forces = [couple](double psi) {
    return [couple, psi](const Vector& at, Vector& total, TangentMatrix* /*tangent*/) {
      const double radius = couple->first_moment(at).dot(couple->radial(psi));
      if (!(radius > 0)) throw SolverError("the end face turns by more than a right angle at once");
      couple->add(couple->of_mesh_ * couple->moment_ / radius * couple->tangential(psi), total);
    };
  };
  result.rate = [couple](double psi) {
    return [couple, psi](const Vector& at, Vector& total, TangentMatrix* /*tangent*/) {
      const Vector3 G = couple->first_moment(at);
      const double radius = G.dot(couple->radial(psi));
      const double turned = G.dot(couple->tangential(psi)) / radius;
      couple->add(-couple->of_mesh_ * couple->moment_ / radius *
                      (couple->radial(psi) + turned * couple->tangential(psi)),
                  total);
    };
  };
  // ψ(u) − ψ, with ∂ψ/∂G = t/|G| in the plane.
  result.condition = [couple](const Vector& at, double psi, Vector* gradient) {
    const double now = couple->angle(at);
    if (gradient != nullptr) {
      const double radius = couple->first_moment(at).dot(couple->radial(now));
      couple->add(couple->tangential(now) / radius, *gradient);
    }
    return std::remainder(now - psi, 2 * std::numbers::pi);
  };
  result.condition_rate = -1;
  return result;
}

}  // namespace ciliaval::fem::solid::loads
