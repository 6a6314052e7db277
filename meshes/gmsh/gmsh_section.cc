// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/gmsh_section.h"

#include <deal.II/base/bounding_box.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace ciliaval::meshes::gmsh {
namespace {

using dealii::Point;
using dealii::Tensor;
using Edge = Extrusion::Edge;
using Quad = Extrusion::Quad;

constexpr double rim_tolerance = 1e-3;   ///< of the rim's nodes from the circle, in R
constexpr double area_tolerance = 0.02;  ///< of the section, relative
constexpr double area_remark = 1e-4;
constexpr double least_scaled_jacobian = 0.1;  ///< less is an error
constexpr double poor_scaled_jacobian = 0.3;   ///< less is a remark

double cross(const Tensor<1, 2>& a, const Tensor<1, 2>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// An element of the lowest layer over a quadrilateral, for messages.
std::string over(const UserMesh& mesh, const Extrusion& extrusion, std::size_t quad) {
  return mesh.hexahedron(extrusion.cell_of[0][quad]);
}

std::string column(const UserMesh& mesh, const Extrusion& extrusion, std::size_t index) {
  const Point<2>& x = extrusion.columns[index];
  return fmt::format("({:.6g}, {:.6g})", mesh.in_file(x[0]), mesh.in_file(x[1]));
}

/// The quadrilaterals on the edges of the section, at most two on each.
std::map<Edge, std::vector<std::size_t>> quads_of_edges(const UserMesh& mesh,
                                                        const Extrusion& extrusion) {
  std::map<Edge, std::vector<std::size_t>> result;
  for (std::size_t q = 0; q < extrusion.quads.size(); ++q) {
    for (const auto& [a, b] : edges_of(extrusion.quads[q])) {
      std::vector<std::size_t>& quads = result[edge(a, b)];
      quads.push_back(q);
      if (quads.size() > 2)
        mesh.fail(fmt::format("{}, {} and {} share one face: the elements overlap",
                              over(mesh, extrusion, quads[0]), over(mesh, extrusion, quads[1]),
                              over(mesh, extrusion, quads[2])));
    }
  }
  return result;
}

/// The section is in one piece.
void check_connected(const UserMesh& mesh, const Extrusion& extrusion,
                     const std::map<Edge, std::vector<std::size_t>>& quads_of_edge) {
  std::vector<bool> reached(extrusion.quads.size(), false);
  std::vector<std::size_t> queue{0};
  reached[0] = true;
  while (!queue.empty()) {
    const std::size_t q = queue.back();
    queue.pop_back();
    for (const auto& [a, b] : edges_of(extrusion.quads[q])) {
      for (const std::size_t other : quads_of_edge.at(edge(a, b))) {
        if (reached[other]) continue;
        reached[other] = true;
        queue.push_back(other);
      }
    }
  }
  const auto first = std::find(reached.begin(), reached.end(), false);
  if (first == reached.end()) return;
  mesh.fail(
      fmt::format("the mesh is in several parts: no chain of faces joins {} and {}; merge their "
                  "nodes or remove "
                  "one",
                  over(mesh, extrusion, 0),
                  over(mesh, extrusion, static_cast<std::size_t>(first - reached.begin()))));
}

/// The columns of the rim and their distance from the axis.
struct Rim {
  std::set<std::size_t> columns;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0;
  Point<2> centre;  ///< of its bounding box, m
};

Rim measure(const Extrusion& extrusion, const std::set<Edge>& edges) {
  Rim rim;
  for (const auto& [a, b] : edges) {
    rim.columns.insert(a);
    rim.columns.insert(b);
  }
  std::vector<Point<2>> points;
  for (const std::size_t c : rim.columns) {
    const Point<2>& x = points.emplace_back(extrusion.columns[c]);
    rim.smallest = std::min(rim.smallest, x.norm());
    rim.largest = std::max(rim.largest, x.norm());
  }
  const auto [low, high] = dealii::BoundingBox<2>(points).get_boundary_points();
  rim.centre = Point<2>((low + high) / 2);
  return rim;
}

/// All columns of the rim are on the circle of the cilium.
void check_circle(const UserMesh& mesh, const Extrusion& extrusion, const Section& section,
                  const std::map<Edge, std::vector<std::size_t>>& quads_of_edge) {
  const double R = mesh.cilium.radius();
  const Rim rim = measure(extrusion, section.mantle);
  const auto is_off = [&](std::size_t c) {
    return std::abs(extrusion.columns[c].norm() - R) > rim_tolerance * R;
  };
  if (std::none_of(rim.columns.begin(), rim.columns.end(), is_off)) return;
  if (rim.largest - rim.smallest <= 2 * rim_tolerance * R)
    mesh.fail(fmt::format("the mesh has the diameter {:.6g}, the cilium {:.6g}",
                          mesh.in_file(rim.smallest + rim.largest),
                          mesh.in_file(mesh.cilium.diameter)));
  double spread = 0;
  for (const std::size_t c : rim.columns)
    spread = std::max(spread, std::abs(extrusion.columns[c].distance(rim.centre) - R));
  if (spread <= 0.1 * R && rim.centre.norm() > rim_tolerance * R)
    mesh.fail(fmt::format("the mesh's axis stands at ({:.6g}, {:.6g}): move it onto the Z axis",
                          mesh.in_file(rim.centre[0]), mesh.in_file(rim.centre[1])));
  for (const auto& [a, b] : section.mantle) {
    if (!is_off(a) && !is_off(b)) continue;
    const std::size_t off = is_off(a) ? a : b;
    mesh.fail(fmt::format(
        "{} has a side without a neighbour between (x, y) = {} and {}, {:.6g} from the axis, but "
        "the mantle's radius is {:.6g}: a hole, hanging nodes, or a section that is not a circle",
        over(mesh, extrusion, quads_of_edge.at(edge(a, b)).front()), column(mesh, extrusion, a),
        column(mesh, extrusion, b), mesh.in_file(extrusion.columns[off].norm()), mesh.in_file(R)));
  }
}

/// Angle that the edge of the rim subtends at the axis.
double angle(const Extrusion& extrusion, const Edge& e) {
  const Point<2>& a = extrusion.columns[e.first];
  const Point<2>& b = extrusion.columns[e.second];
  return std::atan2(std::abs(cross(a, b)), a * b);
}

/// The rim is one closed curve, once around the axis: each of its columns ends two arcs, and the
/// arcs add up to a turn.
void check_closed(const UserMesh& mesh, const Extrusion& extrusion, const Section& section) {
  std::map<std::size_t, int> ends;
  double turn = 0;
  for (const Edge& e : section.mantle) {
    ++ends[e.first];
    ++ends[e.second];
    turn += angle(extrusion, e);
  }
  for (const auto& [c, count] : ends)
    if (count != 2)
      mesh.fail(
          fmt::format("the section's rim touches itself at (x, y) = {}: {} of its edges meet "
                      "there",
                      column(mesh, extrusion, c), count));
  if (std::abs(turn / (2 * std::numbers::pi) - 1) > 1e-6)
    mesh.fail(
        fmt::format("the section's rim goes {:.4g} times around the axis, not once: cells are "
                    "missing or overlap",
                    turn / (2 * std::numbers::pi)));
}

/// Curved nodes of a first-order section. The rim's nodes lie outside R by the factor f of
/// node_radius() for unequal arcs: Σ sin β (1 + (1 − cos β)/3) f² = Σ β, β half an arc.
void curve(const UserMesh& mesh, Extrusion& extrusion, Section& section,
           const std::map<Edge, std::vector<std::size_t>>& quads_of_edge) {
  double sector = 0;
  for (const Edge& e : section.mantle) {
    const double beta = angle(extrusion, e) / 2;
    sector += std::sin(beta) * (1 + (1 - std::cos(beta)) / 3);
  }
  const double radius = mesh.cilium.radius() * std::sqrt(std::numbers::pi / sector);
  for (const std::size_t c : measure(extrusion, section.mantle).columns)
    extrusion.columns[c] *= radius / extrusion.columns[c].norm();
  for (const auto& [e, unused] : quads_of_edge) {
    Point<2> middle((extrusion.columns[e.first] + extrusion.columns[e.second]) / 2);
    if (section.mantle.contains(e)) middle *= radius / middle.norm();
    section.middles[e] = middle;
  }
  for (const Quad& quad : extrusion.quads) {  // transfinite interpolation
    Tensor<1, 2> centre;
    for (const auto& [a, b] : edges_of(quad)) centre += section.middles[edge(a, b)] / 2;
    for (const std::size_t c : quad) centre -= extrusion.columns[c] / 4;
    section.centres.emplace_back(centre);
  }
}

/// Curved nodes of a second-order section, from the lower face of the lowest layer. All other nodes
/// must be above them, half-way up or on a plane.
void take_nodes(const UserMesh& mesh, const Extrusion& extrusion, Section& section) {
  section.centres.resize(extrusion.quads.size());
  const auto corners = [&](const Extrusion::Cell& cell) {
    Quad quad{};
    for (std::size_t v = 0; v < 4; ++v)
      quad[v] = extrusion.column(extrusion.vertices[cell.nodes[2 * (v & 1) + 6 * (v >> 1)]]);
    return quad;
  };
  for (const std::size_t e : extrusion.cell_of.front()) {
    const Extrusion::Cell& cell = extrusion.cells[e];
    const Quad quad = corners(cell);
    const auto lower = [&](std::size_t i) {
      const Point<3> x = mesh.position(cell.nodes[i]);
      return Point<2>(x[0], x[1]);
    };
    section.middles[edge(quad[0], quad[1])] = lower(1);
    section.middles[edge(quad[0], quad[2])] = lower(3);
    section.middles[edge(quad[1], quad[3])] = lower(5);
    section.middles[edge(quad[2], quad[3])] = lower(7);
    section.centres[cell.quad] = lower(4);
  }
  for (std::size_t e = 0; e < extrusion.cells.size(); ++e) {
    const Extrusion::Cell& cell = extrusion.cells[e];
    const auto nodes = section.nodes(extrusion, cell.quad, corners(cell));
    for (std::size_t a = 0; a < cell.nodes.size(); ++a) {
      const std::size_t level = a / 9;  // lower, middle, upper plane
      const Point<2>& xy = nodes[a % 9];
      const double z = extrusion.planes[cell.layer] +
                       static_cast<double>(level) / 2 *
                           (extrusion.planes[cell.layer + 1] - extrusion.planes[cell.layer]);
      if (mesh.position(cell.nodes[a]).distance(Point<3>(xy[0], xy[1], z)) > 2 * mesh.tolerance())
        mesh.fail(fmt::format(
            "{} has its second-order {}, which an extrusion along Z would have at ({:.6g}, {:.6g}, "
            "{:.6g}): the solid's loads need straight vertical lines; extrude the section's mesh, "
            "or write the mesh of first order",
            mesh.hexahedron(e), mesh.node(cell.nodes[a]), mesh.in_file(xy[0]), mesh.in_file(xy[1]),
            mesh.in_file(z)));
    }
  }
}

/// Values of N on 0, ½, 1 and their derivatives at the nodes 0, ½, 1.
constexpr std::array<std::array<double, 3>, 3> derivatives{{{-3, 4, -1}, {-1, 0, 1}, {1, -4, 3}}};

/// ∂x/∂ξ and ∂x/∂η at node (i, j).
std::array<Tensor<1, 2>, 2> tangents(const std::array<Point<2>, 9>& nodes, std::size_t i,
                                     std::size_t j) {
  std::array<Tensor<1, 2>, 2> t;
  for (std::size_t k = 0; k < 3; ++k) {
    t[0] += derivatives[i][k] * nodes[3 * j + k];
    t[1] += derivatives[j][k] * nodes[3 * k + i];
  }
  return t;
}

/// Area by Simpson's rule, exact here: det ∂x/∂ξ is of degree 3 in ξ and in η.
double area(const std::array<Point<2>, 9>& nodes) {
  constexpr std::array<double, 3> weight{1.0 / 6, 4.0 / 6, 1.0 / 6};
  double sum = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = tangents(nodes, i, j);
      sum += weight[i] * weight[j] * cross(a, b);
    }
  }
  return sum;
}

/// Smallest scaled Jacobian det(a, b)/(|a||b|), a and b the tangents of the quadratic map, at its
/// nine nodes: 1 for a rectangle, 0 or less for a degenerate or folded cell.
double scaled_jacobian(const std::array<Point<2>, 9>& nodes) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = tangents(nodes, i, j);
      const double size = a.norm() * b.norm();
      least = std::min(least, size > 0 ? cross(a, b) / size : 0.0);
    }
  }
  return least;
}

/// Area of the section and shape of its cells.
void check_shape(UserMesh& mesh, const Extrusion& extrusion, const Section& section) {
  double total = 0;
  double worst = 1;
  std::size_t worst_quad = 0;
  std::size_t poor = 0;
  for (std::size_t q = 0; q < extrusion.quads.size(); ++q) {
    const auto nodes = section.nodes(extrusion, q, extrusion.quads[q]);
    total += area(nodes);
    const double quality = scaled_jacobian(nodes);
    if (quality < poor_scaled_jacobian) ++poor;
    if (quality >= worst) continue;
    worst = quality;
    worst_quad = q;
  }
  if (!(worst >= least_scaled_jacobian))
    mesh.fail(
        fmt::format("{} is badly shaped: its scaled Jacobian is {:.3g} (1 is a rectangle, 0 "
                    "degenerate), at least {} is needed; smooth or remesh the section",
                    over(mesh, extrusion, worst_quad), worst, least_scaled_jacobian));
  const double ratio = total / mesh.cilium.area();
  if (!(std::abs(ratio - 1) <= area_tolerance))
    mesh.fail(fmt::format("the section has {:.4g} times the area pi R^2 of the cilium's: it {}",
                          ratio,
                          mesh.file.quadratic && ratio < 1
                              ? "is not closed, or its second-order nodes lie on chords of the "
                                "circle (set the order while the geometry is loaded, or write the "
                                "mesh of first order: it is then curved here)"
                              : "is not closed, or cells overlap"));
  if (poor > 0)
    mesh.remarks.push_back(
        fmt::format("{} of {} cells of the section are poorly shaped (scaled Jacobian below {}); "
                    "the worst, {:.3g}, is {}",
                    poor, extrusion.quads.size(), poor_scaled_jacobian, worst,
                    over(mesh, extrusion, worst_quad)));
  if (std::abs(ratio - 1) > area_remark)
    mesh.remarks.push_back(
        fmt::format("the section's area is {:+.2g} % off pi R^2, and the stiffness about twice as "
                    "much; a mesh of first order is curved here to the exact area",
                    100 * (ratio - 1)));
}

}  // namespace

std::array<Point<2>, 9> Section::nodes(const Extrusion& extrusion, std::size_t index,
                                       const Quad& quad) const {
  const auto middle = [&](std::size_t a, std::size_t b) {
    const auto found = middles.find(edge(quad[a], quad[b]));
    return found == middles.end() ? Point<2>() : found->second;  // none: take_nodes() refuses it
  };
  const auto corner = [&](std::size_t a) { return extrusion.columns[quad[a]]; };
  return {corner(0),    middle(0, 1), corner(1),    middle(0, 2), centres[index],
          middle(1, 3), corner(2),    middle(2, 3), corner(3)};
}

Section make_section(UserMesh& mesh, Extrusion& extrusion) {
  Section section;
  const auto quads_of_edge = quads_of_edges(mesh, extrusion);
  for (const auto& [e, quads] : quads_of_edge)
    if (quads.size() == 1) section.mantle.insert(e);
  check_connected(mesh, extrusion, quads_of_edge);
  check_circle(mesh, extrusion, section, quads_of_edge);
  check_closed(mesh, extrusion, section);
  if (mesh.file.quadratic)
    take_nodes(mesh, extrusion, section);
  else
    curve(mesh, extrusion, section, quads_of_edge);
  check_shape(mesh, extrusion, section);
  return section;
}

}  // namespace ciliaval::meshes::gmsh
