// SPDX-License-Identifier: LGPL-2.1-or-later
#include "analytic/rod/rod_quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "analytic/sources/adaptive_order.h"
#include "analytic/sources/dipole.h"
#include "problem/error.h"

namespace ciliaval::analytic::rod {
namespace {

using Slices = VolumeOptions::Slices;

[[noreturn]] void throw_too_near(const Vector3& x) {
  throw SolverError("the quadrature of the model `volume` was asked at " + sources::to_string(x) +
                    ", inside the magnet or too near to it: take the closed form");
}

/// Numbers of nodes along S (of each part) and in the section: along the two sides of a rectangle,
/// or in r and φ.
using Orders = std::array<std::size_t, 3>;

/// A point of the section and its share of the area.
struct Place {
  Eigen::Vector2d offset;  ///< along d₁ and d₂, m
  double area;             ///< m²
};

std::vector<Place> places_of_rectangle(const CrossSection& shape, const Orders& orders) {
  const QuadratureRule& a = sources::unit_gauss_legendre(orders[1]);
  const QuadratureRule& b = sources::unit_gauss_legendre(orders[2]);
  const Eigen::Rotation2Dd turn(shape.orientation);
  std::vector<Place> places;
  for (std::size_t i = 0; i < orders[1]; ++i)
    for (std::size_t j = 0; j < orders[2]; ++j)
      places.push_back({turn * Eigen::Vector2d((a.nodes[i] - 0.5) * shape.width,
                                               (b.nodes[j] - 0.5) * shape.height),
                        a.weights[i] * b.weights[j] * shape.width * shape.height});
  return places;
}

std::vector<Place> places_of(const RodMagnet& magnet, const Orders& orders) {
  if (magnet.shape.shape == CrossSection::Shape::rectangle)
    return places_of_rectangle(magnet.shape, orders);
  const QuadratureRule& radial = sources::unit_gauss_legendre(orders[1]);
  const double inner = magnet.shape.inner_diameter / 2;
  const double wall = magnet.radius - inner;
  const double angle = 2 * std::numbers::pi / static_cast<double>(orders[2]);
  std::vector<Place> places;
  for (std::size_t j = 0; j < orders[1]; ++j) {
    const double r = inner + radial.nodes[j] * wall;
    for (std::size_t k = 0; k < orders[2]; ++k) {
      const double phi = angle * static_cast<double>(k);
      places.push_back(
          {{r * std::cos(phi), r * std::sin(phi)}, radial.weights[j] * wall * r * angle});
    }
  }
  return places;
}

/// Calls `visit(moment, y)` for the dipoles at the nodes.
template <class Visit>
void for_each_dipole(const RodMagnet& magnet, Slices slices, const std::vector<RodStretch>& parts,
                     const Orders& orders, Visit visit) {
  const QuadratureRule& axial = sources::unit_gauss_legendre(orders[0]);
  const std::vector<Place> places = places_of(magnet, orders);
  for (const RodStretch& part : parts) {
    const double length = part.end - part.begin;
    for (std::size_t i = 0; i < orders[0]; ++i) {
      const CentrelinePoint point = at(magnet, part, part.begin + axial.nodes[i] * length);
      const Matrix3 directors = point.rotation.toRotationMatrix();
      for (const Place& place : places) {
        const Vector3 y = point.position + directors.leftCols<2>() * place.offset;
        const Vector3 a = slices == Slices::wedge ? stretch_vector(point, y) : directors.col(2);
        const double volume = axial.weights[i] * length * place.area;
        visit(Vector3(volume * carried_magnetization(part, point, a)), y);
      }
    }
  }
}

/// An integral over the rod, and what raising the orders changes.
template <class Value>
struct RodIntegral {
  Value value;
  Value changes;   ///< magnitudes
  double reached;  ///< the largest change over |value|, if it is above the tolerance; else 0
};

/// ∫ kernel(moment, x − y) over the dipoles of the parts; nothing if it needs too many nodes.
template <class Value, class Kernel>
std::optional<RodIntegral<Value>> integrate_over_rod(const RodMagnet& magnet, Slices slices,
                                                     const std::vector<RodStretch>& parts,
                                                     double tolerance, std::size_t most_nodes,
                                                     const Vector3& x, const Kernel& kernel) {
  const auto sum_of = [&](const Orders& orders) {
    Value sum = Value::Zero();
    for_each_dipole(magnet, slices, parts, orders, [&](const Vector3& moment, const Vector3& y) {
      sum += kernel(moment, Vector3(x - y));
    });
    return sum;
  };
  const bool is_round = magnet.shape.shape != CrossSection::Shape::rectangle;
  Orders orders{6, 6, is_round ? 12U : 6U};
  while (true) {
    RodIntegral<Value> integral{sum_of(orders), Value::Zero(), 0};
    const double size = integral.value.norm();
    const double allowed = tolerance * size / 3;
    Orders next = orders;
    for (std::size_t direction = 0; direction < 3; ++direction) {
      Orders raised = orders;
      raised[direction] += raised[direction] / 2;
      if (raised[0] * raised[1] * raised[2] * parts.size() > most_nodes) return std::nullopt;
      const Value change = (sum_of(raised) - integral.value).cwiseAbs();
      integral.changes += change;
      if (!(change.norm() > allowed)) continue;
      next[direction] = raised[direction];
      // Sums of some thousand terms are rounded at this level: a higher order changes no more.
      if (change.norm() < 1e-14 * size)
        integral.reached = std::max(integral.reached, change.norm() / size);
    }
    if (next == orders || integral.reached > 0) return integral;
    orders = next;
  }
}

/// The parts of the rod as seen from x; nothing inside and next to it.
std::optional<std::vector<RodStretch>> parts_of(const RodMagnet& magnet,
                                                const RodInterior& interior, const Vector3& x) {
  if (interior.magnetization_at(x)) return std::nullopt;
  return graded_stretches(
      magnet, [&](const CentrelinePoint& point) { return distance_from_section(magnet, point, x); },
      1e-4 * magnet.radius);
}

/// Rounding of the dipoles' sum and of the ends of the segments, T.
double rounding_of_dipoles(const RodMagnet& magnet, Slices slices,
                           const std::vector<RodStretch>& parts, const Vector3& x) {
  double sum = rounding_of_ends(magnet, x);
  for_each_dipole(magnet, slices, parts, {4, 4, 8}, [&](const Vector3& moment, const Vector3& y) {
    sum += sources::with_rounding(sources::dipole_field(moment, x - y), x, y).uncertainty.x();
  });
  return sum;
}

std::optional<RodIntegral<Vector3>> field_of_dipoles(const RodMagnet& magnet,
                                                     const RodInterior& interior, Slices slices,
                                                     double tolerance, std::size_t most_nodes,
                                                     const Vector3& x) {
  const auto parts = parts_of(magnet, interior, x);
  if (!parts) return std::nullopt;
  auto integral = integrate_over_rod<Vector3>(magnet, slices, *parts, tolerance, most_nodes, x,
                                              sources::dipole_field);
  if (integral)
    integral->changes += Vector3::Constant(rounding_of_dipoles(magnet, slices, *parts, x));
  return integral;
}

constexpr std::size_t most_nodes_far = 200'000;

}  // namespace

sources::FieldValue rod_field_by_quadrature(const RodMagnet& magnet, const RodInterior& interior,
                                            Slices slices, double tolerance, const Vector3& x) {
  if (magnet.stretches.empty()) return {};
  const auto integral = field_of_dipoles(magnet, interior, slices, tolerance, 20'000'000, x);
  if (!integral) throw_too_near(x);
  if (integral->reached > 0)
    sources::throw_tolerance_missed({tolerance, 0, "quadrature of the model `volume`", x},
                                    integral->reached);
  return {integral->value, integral->changes};
}

std::optional<sources::FieldValue> far_field_of_rod(const RodMagnet& magnet,
                                                    const RodInterior& interior, Slices slices,
                                                    double tolerance, const Vector3& x) {
  const auto integral = field_of_dipoles(magnet, interior, slices, tolerance, most_nodes_far, x);
  if (!integral || integral->reached > 0) return std::nullopt;
  return sources::FieldValue{integral->value, integral->changes};
}

std::optional<Matrix3> far_gradient_of_rod(const RodMagnet& magnet, const RodInterior& interior,
                                           double tolerance, const Vector3& x) {
  const auto parts = parts_of(magnet, interior, x);
  if (!parts) return std::nullopt;
  const auto integral = integrate_over_rod<Matrix3>(magnet, Slices::wedge, *parts, tolerance,
                                                    most_nodes_far, x, sources::dipole_gradient);
  if (!integral || integral->reached > 0) return std::nullopt;
  return integral->value;
}

}  // namespace ciliaval::analytic::rod
