// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/claims/misprint.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

#include "problem/field_model.h"

namespace ciliaval::compare::claims {
namespace {

constexpr int angles = 24;

/// B of a moment (A·m²) at the distance a (Eq. 5), T.
Vector3 dipole(const Vector3& moment, const Vector3& a) {
  const double distance = a.norm();
  return vacuum_permeability / (4 * std::numbers::pi) *
         (3 * moment.dot(a) * a / std::pow(distance, 5) - moment / std::pow(distance, 3));
}

/// The components' powers of 1/cos θ that are too many.
Vector3 misprinted(const Vector3& B, double cosine, bool x_too) {
  return {x_too ? B.x() / cosine : B.x(), B.y() / cosine, B.z() / cosine};
}

/// Calls f(S, weight) at Gauss points of each piece in [begin, end].
template <class F>
void integrate(double begin, double end, const F& f) {
  using Rule = boost::math::quadrature::gauss<double, 15>;
  const double half = (end - begin) / 2;
  const auto& points = Rule::abscissa();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = half * Rule::weights()[i];
    f(begin + half * (1 + points[i]), weight);
    if (points[i] != 0) f(begin + half * (1 - points[i]), weight);
  }
}

}  // namespace

PrintedFields printed_fields(const Cilium& cilium, const Centreline& centreline, const Vector3& x) {
  PrintedFields sum{Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  const double R = cilium.diameter / 2;
  const std::vector<double> ends = cilium.interfaces();
  for (std::size_t s = 0; s < cilium.segments.size(); ++s) {
    const double M = cilium.segments[s].magnetization;
    if (M == 0) continue;
    const auto slice = [&](double S, double dS) {
      const CentrelinePoint p = centreline.at(S);
      const double cosine = p.normal().z();
      const Vector3 whole = dipole(std::numbers::pi * R * R * M * dS * p.normal(), x - p.position);
      sum.line += whole;
      sum.line_printed += misprinted(whole, cosine, false);
      integrate(0, R, [&](double r, double dr) {
        for (int j = 0; j < angles; ++j) {
          const double phi = 2 * std::numbers::pi * j / angles;
          const Vector3 from_axis = r * (p.rotation * Vector3(std::cos(phi), std::sin(phi), 0));
          const Vector3 part = dipole(2 * std::numbers::pi / angles * r * dr * M * dS * p.normal(),
                                      x - p.position - from_axis);
          sum.volume += part;
          sum.volume_printed += misprinted(part, cosine, true);
        }
      });
    };
    for (std::size_t i = 0; i + 1 < centreline.breaks().size(); ++i) {
      const double begin = std::max(ends[s], centreline.breaks()[i]);
      const double end = std::min(ends[s + 1], centreline.breaks()[i + 1]);
      constexpr int parts = 4;
      for (int k = 0; k < parts && end > begin; ++k)
        integrate(begin + (end - begin) * k / parts, begin + (end - begin) * (k + 1) / parts,
                  slice);
    }
  }
  return sum;
}

}  // namespace ciliaval::compare::claims
