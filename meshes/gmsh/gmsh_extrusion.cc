// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/gmsh_extrusion.h"

#include <deal.II/base/bounding_box.h>
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace ciliaval::meshes::gmsh {
namespace {

using dealii::Point;

/// Number of nodes along an edge.
std::size_t nodes_1d(const UserMesh& mesh) {
  return mesh.file.quadratic ? 3 : 2;
}

/// The eight corners of a hexahedron's nodes, lexicographic.
std::array<std::size_t, 8> corners(const std::vector<std::size_t>& nodes, std::size_t n) {
  std::array<std::size_t, 8> result{};
  for (std::size_t v = 0; v < 8; ++v)
    result[v] =
        nodes[(v & 1) * (n - 1) + ((v >> 1) & 1) * (n - 1) * n + (v >> 2) * (n - 1) * n * n];
  return result;
}

/// The file's unit if `length` (in it) is the cilium's.
std::string unit_advice(const UserMesh& mesh, double length) {
  static constexpr std::array<std::pair<double, std::string_view>, 6> units{
      {{1, "m"}, {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "um"}, {1e-9, "nm"}, {0.0254, "inch"}}};
  for (const auto& [size, name] : units)
    if (size != mesh.source.unit && std::abs(length * size / mesh.cilium.length() - 1) < 0.01)
      return fmt::format("; its coordinates seem to be in {}: set mesh_unit = \"1 {}\"", name,
                         name);
  return {};
}

/// The mesh spans 0 ≤ Z ≤ L.
void check_height(const UserMesh& mesh) {
  std::vector<Point<3>> points;
  for (const GmshElement& element : mesh.file.hexahedra)
    for (const std::size_t n : element.nodes) {
      const Point<3>& x = points.emplace_back(mesh.file.nodes[n]);
      if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
        mesh.fail(mesh.node(n) + " has no finite coordinates");
    }
  const auto [low, high] = dealii::BoundingBox<3>(points).get_boundary_points();
  const double L = mesh.in_file(mesh.cilium.length());
  const double tolerance = mesh.in_file(mesh.tolerance());
  const double height = high[2] - low[2];
  if (std::abs(height - L) > tolerance) {
    const bool lies =
        std::abs(high[0] - low[0] - L) <= tolerance || std::abs(high[1] - low[1] - L) <= tolerance;
    mesh.fail(fmt::format("the mesh is {:.6g} high, the cilium is {:.6g} long{}", height, L,
                          lies ? "; it lies along X or Y: turn it so that its axis is the Z axis"
                               : unit_advice(mesh, height)));
  }
  if (std::abs(low[2]) > tolerance)
    mesh.fail(
        fmt::format("the mesh stands on Z = {:.6g}: move it so that its base is Z = 0", low[2]));
}

/// Values that differ by no more than the tolerance become one; a plane near an interface of the
/// cilium moves there.
std::vector<double> find_planes(const UserMesh& mesh, std::vector<double> heights) {
  std::sort(heights.begin(), heights.end());
  std::vector<double> planes;
  for (const double z : heights)
    if (planes.empty() || z - planes.back() > mesh.tolerance()) planes.push_back(z);
  for (double& plane : planes)
    for (const double S : mesh.cilium.interfaces())
      if (std::abs(plane - S) <= mesh.tolerance()) plane = S;
  return planes;
}

std::size_t nearest_plane(const std::vector<double>& planes, double z) {
  const auto above = std::lower_bound(planes.begin(), planes.end(), z);
  if (above == planes.begin()) return 0;
  if (above == planes.end() || z - *(above - 1) < *above - z)
    return static_cast<std::size_t>(above - planes.begin()) - 1;
  return static_cast<std::size_t>(above - planes.begin());
}

/// Points of the plane, the same within a tolerance, by a grid of that width.
class PointIndex {
 public:
  explicit PointIndex(double tolerance) : tolerance_(tolerance) {}

  std::size_t find_or_add(const Point<2>& x, std::vector<Point<2>>& points) {
    const auto i = std::llround(x[0] / tolerance_);
    const auto j = std::llround(x[1] / tolerance_);
    for (long long di = -1; di <= 1; ++di) {
      for (long long dj = -1; dj <= 1; ++dj) {
        const auto found = index_.find({i + di, j + dj});
        if (found != index_.end() && points[found->second].distance(x) <= tolerance_)
          return found->second;
      }
    }
    index_.emplace(std::pair(i, j), points.size());
    points.push_back(x);
    return points.size() - 1;
  }

 private:
  double tolerance_;
  std::map<std::pair<long long, long long>, std::size_t> index_;
};

/// Planes, columns, and the vertex of each corner node.
void find_vertices(const UserMesh& mesh, Extrusion& extrusion) {
  const std::size_t n = nodes_1d(mesh);
  std::set<std::size_t> corner_nodes;
  for (const GmshElement& element : mesh.file.hexahedra)
    for (const std::size_t node : corners(element.nodes, n)) corner_nodes.insert(node);
  std::vector<double> heights;
  heights.reserve(corner_nodes.size());
  for (const std::size_t node : corner_nodes) heights.push_back(mesh.position(node)[2]);
  extrusion.planes = find_planes(mesh, std::move(heights));
  PointIndex index(mesh.tolerance());
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> plane_and_column;
  for (const std::size_t node : corner_nodes) {
    const Point<3> x = mesh.position(node);
    plane_and_column[node] = {nearest_plane(extrusion.planes, x[2]),
                              index.find_or_add(Point<2>(x[0], x[1]), extrusion.columns)};
  }
  extrusion.vertices.assign(mesh.file.nodes.size(), Extrusion::none);
  for (const auto& [node, place] : plane_and_column)
    extrusion.vertices[node] = place.first * extrusion.columns.size() + place.second;
}

/// No two corners of a cell, and no two nodes of the mesh, are at one place.
void check_distinct(const UserMesh& mesh, const Extrusion& extrusion) {
  const std::size_t n = nodes_1d(mesh);
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> first;  // by vertex: node, element
  for (std::size_t e = 0; e < mesh.file.hexahedra.size(); ++e) {
    const auto nodes = corners(mesh.file.hexahedra[e].nodes, n);
    std::set<std::size_t> own;
    for (const std::size_t node : nodes)
      if (!own.insert(extrusion.vertices[node]).second)
        mesh.fail(
            fmt::format("{} is degenerate: two of its corners are {}; make it a hexahedron "
                        "with eight different corners",
                        mesh.hexahedron(e), mesh.node(node)));
    for (const std::size_t node : nodes) {
      const auto [other, added] = first.emplace(extrusion.vertices[node], std::pair(node, e));
      if (added || other->second.first == node) continue;
      const std::size_t a = mesh.segments[other->second.second];
      const std::size_t b = mesh.segments[e];
      const std::string where =
          a == b ? fmt::format("inside '{}'", mesh.cilium.segments[a].name)
                 : fmt::format("at the interface of '{}' and '{}'", mesh.cilium.segments[a].name,
                               mesh.cilium.segments[b].name);
      mesh.fail(fmt::format(
          "the mesh is torn {}: nodes {} and {} are both at ({:.6g}, {:.6g}, "
          "{:.6g}), and the cells do not share one; in Gmsh use Coherence (or "
          "BooleanFragments) before meshing, or `Coherence Mesh` after",
          where, mesh.file.node_tags[other->second.first], mesh.file.node_tags[node],
          mesh.file.nodes[node][0], mesh.file.nodes[node][1], mesh.file.nodes[node][2]));
    }
  }
}

/// Map of a hexahedron's local axes to ξ, η, ζ.
struct Frame {
  std::array<unsigned int, 3> axes{0, 1, 2};
  bool flip = false;      ///< ζ runs against its axis
  bool mirrored = false;  ///< the Jacobian was negative
};

/// Twice the area of a quadrilateral given lexicographically.
double twice_area(const std::array<Point<2>, 4>& x) {
  const auto d = x[3] - x[0];
  const auto e = x[2] - x[1];
  return d[0] * e[1] - d[1] * e[0];
}

/// The frame with ζ up and a positive Jacobian; none if no axis of the cell is vertical.
std::optional<Frame> upright_frame(const Extrusion& extrusion,
                                   const std::array<std::size_t, 8>& vertex) {
  for (const unsigned int axis : {2U, 0U, 1U}) {
    const unsigned int bit = 1U << axis;
    const std::size_t low = extrusion.plane(vertex[0]);
    const std::size_t high = extrusion.plane(vertex[bit]);
    bool vertical = low != high;
    for (unsigned int v = 0; v < 8; ++v) {
      vertical = vertical && extrusion.plane(vertex[v]) == ((v & bit) != 0 ? high : low);
      vertical = vertical && extrusion.column(vertex[v]) == extrusion.column(vertex[v & ~bit]);
    }
    if (!vertical) continue;
    Frame frame{{(axis + 1) % 3, (axis + 2) % 3, axis}, low > high, low > high};
    std::array<Point<2>, 4> x;
    for (unsigned int v = 0; v < 4; ++v)
      x[v] = extrusion.columns[extrusion.column(
          vertex[((v & 1U) << frame.axes[0]) | ((v >> 1U) << frame.axes[1])])];
    if (twice_area(x) < 0) {
      std::swap(frame.axes[0], frame.axes[1]);
      frame.mirrored = !frame.mirrored;
    }
    return frame;
  }
  return std::nullopt;
}

std::vector<std::size_t> turned(const std::vector<std::size_t>& nodes, const Frame& frame,
                                std::size_t n) {
  const std::array<std::size_t, 3> stride{1, n, n * n};
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i)
        result.push_back(nodes[i * stride[frame.axes[0]] + j * stride[frame.axes[1]] +
                               (frame.flip ? n - 1 - k : k) * stride[frame.axes[2]]]);
  return result;
}

/// Throws the reason why the cell is no part of an extrusion.
[[noreturn]] void fail_not_extruded(const UserMesh& mesh, const Extrusion& extrusion, std::size_t e,
                                    const std::array<std::size_t, 8>& vertex) {
  std::set<std::size_t> planes;
  for (const std::size_t v : vertex) planes.insert(extrusion.plane(v));
  std::vector<std::string> heights;
  heights.reserve(planes.size());
  for (const std::size_t plane : planes)
    heights.push_back(fmt::format("{:.6g}", mesh.in_file(extrusion.planes[plane])));
  constexpr std::string_view advice =
      "the solid's loads need layers of cells between planes Z = const, with vertical edges from "
      "plane to plane: extrude the section's mesh along Z (Gmsh: Extrude {0, 0, L} { …; Layers{n}; "
      "Recombine; })";
  if (planes.size() == 2)
    mesh.fail(
        fmt::format("{} is not extruded along Z: its edges between Z = {} are not vertical; {}",
                    mesh.hexahedron(e), fmt::join(heights, " and Z = "), advice));
  mesh.fail(fmt::format("{} is not extruded along Z: its corners are at the heights {}; {}",
                        mesh.hexahedron(e), fmt::join(heights, ", "), advice));
}

/// The cells, upright, and the section's quadrilaterals.
void find_cells(UserMesh& mesh, Extrusion& extrusion) {
  const std::size_t n = nodes_1d(mesh);
  std::size_t mirrored = 0;
  std::size_t first_mirrored = 0;
  for (std::size_t e = 0; e < mesh.file.hexahedra.size(); ++e) {
    const std::vector<std::size_t>& nodes = mesh.file.hexahedra[e].nodes;
    std::array<std::size_t, 8> vertex = corners(nodes, n);
    for (std::size_t& v : vertex) v = extrusion.vertices[v];
    const std::optional<Frame> frame = upright_frame(extrusion, vertex);
    if (!frame) fail_not_extruded(mesh, extrusion, e, vertex);
    if (frame->mirrored && mirrored++ == 0) first_mirrored = e;
    Extrusion::Cell cell{0, 0, turned(nodes, *frame, n)};
    vertex = corners(cell.nodes, n);
    for (std::size_t& v : vertex) v = extrusion.vertices[v];
    cell.layer = extrusion.plane(vertex[0]);
    if (extrusion.plane(vertex[4]) != cell.layer + 1)
      mesh.fail(
          fmt::format("{} reaches past the plane Z = {:.6g}, where other cells end: the layers "
                      "must go through the whole section, without hanging nodes",
                      mesh.hexahedron(e), mesh.in_file(extrusion.planes[cell.layer + 1])));
    Extrusion::Quad quad{};
    for (std::size_t v = 0; v < 4; ++v) quad[v] = extrusion.column(vertex[v]);
    Extrusion::Quad key = quad;
    std::sort(key.begin(), key.end());
    const auto [place, added] = extrusion.quad_of.emplace(key, extrusion.quads.size());
    if (added) extrusion.quads.push_back(quad);
    cell.quad = place->second;
    extrusion.cells.push_back(std::move(cell));
  }
  if (mirrored > 0)
    mesh.remarks.push_back(
        fmt::format("{} of {} elements were inside out ({} is the first): "
                    "renumbered",
                    mirrored, mesh.file.hexahedra.size(), mesh.hexahedron(first_mirrored)));
}

/// Every physical volume reaches from end to end of its segment, and not beyond.
void check_segments(const UserMesh& mesh, const Extrusion& extrusion) {
  const std::vector<double> interfaces = mesh.cilium.interfaces();
  for (std::size_t s = 0; s < mesh.cilium.segments.size(); ++s) {
    std::size_t low = extrusion.planes.size();
    std::size_t high = 0;
    for (std::size_t e = 0; e < extrusion.cells.size(); ++e) {
      if (mesh.segments[e] != s) continue;
      low = std::min(low, extrusion.cells[e].layer);
      high = std::max(high, extrusion.cells[e].layer + 1);
    }
    if (extrusion.planes[low] == interfaces[s] && extrusion.planes[high] == interfaces[s + 1])
      continue;
    mesh.fail(fmt::format(
        "the physical volume '{}' spans Z = {:.6g} to {:.6g}, the cilium's segment Z = {:.6g} to "
        "{:.6g}: make them the same",
        mesh.cilium.segments[s].name, mesh.in_file(extrusion.planes[low]),
        mesh.in_file(extrusion.planes[high]), mesh.in_file(interfaces[s]),
        mesh.in_file(interfaces[s + 1])));
  }
}

/// Every quadrilateral of the section is in every layer, once.
void check_layers(const UserMesh& mesh, Extrusion& extrusion) {
  const std::size_t layers = extrusion.planes.size() - 1;
  extrusion.cell_of.assign(layers, std::vector(extrusion.quads.size(), Extrusion::none));
  std::vector<std::size_t> count(layers, 0);
  for (std::size_t e = 0; e < extrusion.cells.size(); ++e) {
    const Extrusion::Cell& cell = extrusion.cells[e];
    std::size_t& place = extrusion.cell_of[cell.layer][cell.quad];
    if (place != Extrusion::none)
      mesh.fail(fmt::format("{} and {} are the same cell; remove one (in two physical volumes?)",
                            mesh.hexahedron(place), mesh.hexahedron(e)));
    place = e;
    ++count[cell.layer];
  }
  for (std::size_t k = 0; k < layers; ++k) {
    const double low = mesh.in_file(extrusion.planes[k]);
    const double high = mesh.in_file(extrusion.planes[k + 1]);
    if (count[k] == 0)
      mesh.fail(
          fmt::format("the mesh is in several parts: there is a gap without cells between Z = "
                      "{:.6g} and Z = {:.6g}",
                      low, high));
    if (count[k] == extrusion.quads.size()) continue;
    // A quadrilateral that the next layer has not, on the side of which there are more.
    for (const std::size_t other : {k + 1, k - 1}) {
      if (other >= layers) continue;
      for (std::size_t q = 0; q < extrusion.quads.size(); ++q) {
        const std::size_t here = extrusion.cell_of[k][q];
        const std::size_t there = extrusion.cell_of[other][q];
        if ((here == Extrusion::none) == (there == Extrusion::none)) continue;
        const std::size_t alone = here == Extrusion::none ? there : here;
        mesh.fail(fmt::format(
            "{} has no neighbour across the plane Z = {:.6g}: the meshes on both sides do not "
            "conform, or there is a hole; extrude one section mesh through all segments",
            mesh.hexahedron(alone), other > k ? high : low));
      }
    }
  }
}

}  // namespace

Extrusion find_extrusion(UserMesh& mesh) {
  check_height(mesh);
  Extrusion extrusion;
  find_vertices(mesh, extrusion);
  check_distinct(mesh, extrusion);
  find_cells(mesh, extrusion);
  check_layers(mesh, extrusion);
  check_segments(mesh, extrusion);
  return extrusion;
}

}  // namespace ciliaval::meshes::gmsh
