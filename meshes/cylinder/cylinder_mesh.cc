// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/cylinder/cylinder_mesh.h"

#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "meshes/parts.h"
#include "problem/error.h"

namespace ciliaval::meshes::cylinder {
namespace {

using dealii::Point;
using dealii::Triangulation;

constexpr dealii::types::manifold_id mantle_manifold = 1;

void require_valid(const CylinderMeshOptions& options, double length) {
  if (options.square_cells == 0 || options.square_cells % 2 != 0)
    throw InputError("the section's inner square needs an even number of cells along its side");
  if (options.rings == 0)
    throw InputError("the section needs at least one ring of cells under the mantle");
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(options.ring_ratio) || !positive(options.finest_layer) ||
      !positive(options.coarsest_layer) || options.finest_layer > options.coarsest_layer ||
      !std::isfinite(options.growth) || options.growth < 0)
    throw InputError(
        "the layers of the cylinder mesh need 0 < finest_layer <= coarsest_layer, growth >= 0 and "
        "ring_ratio > 0");
  for (const double plane : options.planes) {
    if (!(plane >= 0 && plane <= length * (1 + 1e-9)))
      throw InputError("a mesh plane was asked for at S = " + std::to_string(plane) +
                       " m, outside the cilium");
  }
}

/// Radius, in R, of the inner square's rim in the direction φ: between a square and a circle, so
/// that neither the square's corners nor the rings' cells get flat.
double rim_radius(double phi) {
  return 0.5 + 0.04 * (1 - std::cos(4 * phi));
}

/// Angle of the point (s, t) of the rim of the square [−1, 1]²; equal steps along a side are equal
/// steps in the angle.
double rim_angle(double s, double t) {
  constexpr double quarter = std::numbers::pi / 4;
  if (s >= std::abs(t)) return quarter * t / s;
  if (t >= std::abs(s)) return quarter * (2 - s / t);
  if (-s >= std::abs(t)) return quarter * (4 + t / s);
  return quarter * (6 - s / t);
}

/// Radii, in R, of the m+1 ring boundaries in the direction φ; widths in geometric progression.
std::vector<double> ring_radii(double phi, const CylinderMeshOptions& options) {
  std::vector<double> radii{rim_radius(phi)};
  double sum = 0;
  for (unsigned int ring = 0; ring < options.rings; ++ring)
    sum += std::pow(options.ring_ratio, ring);
  for (unsigned int ring = 0; ring < options.rings; ++ring)
    radii.push_back(radii.back() + (1 - radii.front()) * std::pow(options.ring_ratio, ring) / sum);
  radii.back() = 1;
  return radii;
}

/// Radius of the mantle's nodes. A parabola through the ends and the middle of an arc of half-angle
/// β of the unit circle bounds a sector of the area sin β (1 + (1 − cos β)/3), a little less than
/// β.
double node_radius(double radius, const CylinderMeshOptions& options) {
  if (!options.equal_area) return radius;
  const double beta = std::numbers::pi / (4.0 * options.square_cells);
  return radius * std::sqrt(beta / (std::sin(beta) * (1 + (1 - std::cos(beta)) / 3)));
}

/// The o-grid of the section of radius R, or its upper half.
void make_section(double radius, const CylinderMeshOptions& options, Triangulation<2>& section) {
  const unsigned int n = options.square_cells;
  std::vector<Point<2>> vertices;
  const auto square = [n](unsigned int i, unsigned int j) { return j * (n + 1) + i; };
  for (unsigned int j = 0; j <= n; ++j) {
    for (unsigned int i = 0; i <= n; ++i) {
      const double s = 2.0 * i / n - 1;
      const double t = 2.0 * j / n - 1;
      const double scale = std::max(std::abs(s), std::abs(t));
      const double phi = scale > 0 ? rim_angle(s, t) : 0.0;
      const double r = radius * scale * rim_radius(phi);
      vertices.emplace_back(r * std::cos(phi), r * std::sin(phi));
    }
  }
  // The rim of the square, counter-clockwise from its lower right corner.
  std::vector<unsigned int> inner;
  for (unsigned int k = 0; k < n; ++k) inner.push_back(square(n, k));
  for (unsigned int k = 0; k < n; ++k) inner.push_back(square(n - k, n));
  for (unsigned int k = 0; k < n; ++k) inner.push_back(square(0, n - k));
  for (unsigned int k = 0; k < n; ++k) inner.push_back(square(k, 0));

  std::vector<dealii::CellData<2>> cells;
  const auto add = [&cells](unsigned int a, unsigned int b, unsigned int c, unsigned int d) {
    cells.emplace_back();
    cells.back().vertices = {a, b, c, d};
  };
  for (unsigned int j = 0; j < n; ++j)
    for (unsigned int i = 0; i < n; ++i)
      add(square(i, j), square(i + 1, j), square(i, j + 1), square(i + 1, j + 1));
  const auto around = static_cast<unsigned int>(inner.size());
  for (unsigned int ring = 1; ring <= options.rings; ++ring) {
    std::vector<unsigned int> outer;
    for (unsigned int k = 0; k < around; ++k) {
      const double phi = std::numbers::pi / 4 * (2.0 * k / n - 1);
      const double r = radius * ring_radii(phi, options)[ring];
      outer.push_back(static_cast<unsigned int>(vertices.size()));
      vertices.emplace_back(r * std::cos(phi), r * std::sin(phi));
    }
    for (unsigned int k = 0; k < around; ++k) {
      const unsigned int next = (k + 1) % around;
      add(inner[k], outer[k], inner[next], outer[next]);
    }
    inner = outer;
  }
  if (options.half) {
    const auto below = [&vertices](const dealii::CellData<2>& cell) {
      double y = 0;
      for (const unsigned int vertex : cell.vertices) y += vertices[vertex][1];
      return y < 0;
    };
    std::erase_if(cells, below);
    dealii::SubCellData none;
    dealii::GridTools::delete_unused_vertices(vertices, cells, none);
  }
  section.create_triangulation(vertices, cells, {});
}

/// The section of a tube, or its upper half: cells as around the square of the full circle.
void make_ring(double outer, double inner, const CylinderMeshOptions& options,
               Triangulation<2>& section) {
  const unsigned int around = (options.half ? 2 : 4) * options.square_cells;
  const unsigned int layers = options.rings + 1;
  const double turn = options.half ? std::numbers::pi : 2 * std::numbers::pi;
  const unsigned int lines = options.half ? around + 1 : around;
  std::vector<Point<2>> vertices;
  for (unsigned int ring = 0; ring <= layers; ++ring) {
    for (unsigned int k = 0; k < lines; ++k) {
      const double phi = turn * k / around;
      const double r = inner + (outer - inner) * ring / layers;
      vertices.emplace_back(r * std::cos(phi), r * std::sin(phi));
    }
  }
  std::vector<dealii::CellData<2>> cells(static_cast<std::size_t>(around) * layers);
  for (unsigned int ring = 0; ring < layers; ++ring) {
    for (unsigned int k = 0; k < around; ++k) {
      const unsigned int next = (k + 1) % lines;
      cells[ring * around + k].vertices = {ring * lines + k, (ring + 1) * lines + k,
                                           ring * lines + next, (ring + 1) * lines + next};
    }
  }
  section.create_triangulation(vertices, cells, {});
}

/// The section of a rectangle with the sides a along X and b along Y, or its upper half. A longer
/// side has more cells by those of the rings: both edges, where it is clamped, are to be resolved.
void make_rectangle(double a, double b, const CylinderMeshOptions& options,
                    Triangulation<2>& section) {
  const auto cells = [&](double side) {
    const double longer = std::clamp(side / std::min(a, b) - 1, 0.0, 1.0);
    return options.square_cells + 2 * static_cast<unsigned int>(std::round(options.rings * longer));
  };
  const unsigned int across = options.half ? cells(b) / 2 : cells(b);
  dealii::GridGenerator::subdivided_hyper_rectangle(section, {cells(a), across},
                                                    Point<2>(-a / 2, options.half ? 0 : -b / 2),
                                                    Point<2>(a / 2, b / 2));
}

/// The section in the frame of the mesh.
void make_section(const Cilium& cilium, const CylinderMeshOptions& options,
                  Triangulation<2>& section) {
  const double half_inner = cilium.section.inner_diameter / 2;
  switch (cilium.section.shape) {
    case CrossSection::Shape::rectangle:
      return make_rectangle(cilium.extent(0), cilium.extent(std::numbers::pi / 2), options,
                            section);
    case CrossSection::Shape::tube:
      return make_ring(node_radius(cilium.radius(), options), node_radius(half_inner, options),
                       options, section);
    default:
      make_section(node_radius(cilium.radius(), options), options, section);
  }
}

/// Planes strictly between a and b by equal steps of ∫ dS/size(S); appends them and b.
template <typename Size>
void append_layers(double a, double b, const Size& size, std::vector<double>& planes) {
  constexpr std::size_t samples = 2000;
  const double step = (b - a) / samples;
  std::vector<double> layers{0.0};
  for (std::size_t i = 0; i < samples; ++i)
    layers.push_back(layers.back() + step / size(a + (static_cast<double>(i) + 0.5) * step));
  const auto count = static_cast<int>(std::max(1.0, std::ceil(layers.back() - 0.25)));
  std::size_t i = 0;
  for (int layer = 1; layer < count; ++layer) {
    const double target = layers.back() * layer / count;
    while (layers[i + 1] < target) ++i;
    const double fraction = (target - layers[i]) / (layers[i + 1] - layers[i]);
    planes.push_back(a + (static_cast<double>(i) + fraction) * step);
  }
  planes.push_back(b);
}

void attach_mantle(Triangulation<3>& triangulation) {
  triangulation.set_manifold(mantle_manifold, dealii::CylindricalManifold<3>(2));
}

}  // namespace

std::vector<double> layer_planes(const Cilium& cilium, const CylinderMeshOptions& options) {
  ciliaval::require_valid(cilium);
  require_valid(options, cilium.length());
  const std::vector<double> interfaces = cilium.interfaces();
  std::vector<double> fixed = interfaces;
  const double tolerance = 1e-9 * cilium.length();
  for (const double plane : options.planes) {
    const auto same = [&](double other) { return std::abs(other - plane) <= tolerance; };
    if (std::none_of(fixed.begin(), fixed.end(), same)) fixed.push_back(plane);
  }
  std::sort(fixed.begin(), fixed.end());

  // At a free tip there is nothing to resolve.
  const std::vector<double> graded(interfaces.begin(),
                                   interfaces.end() - (options.fine_tip ? 0 : 1));
  const double d = cilium.thickness();
  const auto size = [&](double S) {
    double distance = cilium.length();
    for (const double plane : graded) distance = std::min(distance, std::abs(S - plane));
    return std::min(options.coarsest_layer * d,
                    options.finest_layer * d + options.growth * distance);
  };
  std::vector<double> planes{0.0};
  for (std::size_t i = 0; i + 1 < fixed.size(); ++i)
    append_layers(fixed[i], fixed[i + 1], size, planes);
  return planes;
}

void make_cylinder(const Cilium& cilium, const CylinderMeshOptions& options,
                   Triangulation<3>& triangulation) {
  const std::vector<double> planes = layer_planes(cilium, options);
  Triangulation<2> section;
  make_section(cilium, options, section);
  dealii::GridGenerator::extrude_triangulation(section, planes, triangulation);

  const double tolerance = 1e-9 * cilium.thickness();
  for (const auto& cell : triangulation.active_cell_iterators()) {
    cell->set_material_id(
        static_cast<dealii::types::material_id>(cilium.segment_at(cell->center()[2])));
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      if (face->center()[2] < tolerance) {
        face->set_boundary_id(base_id);
      } else if (face->center()[2] > cilium.length() - tolerance) {
        face->set_boundary_id(tip_id);
      } else if (options.half && std::abs(face->center()[1]) < tolerance) {
        face->set_boundary_id(symmetry_id);
      } else {
        face->set_boundary_id(mantle_id);
        if (!cilium.is_rectangular()) face->set_all_manifold_ids(mantle_manifold);
      }
    }
  }
  attach_mantle(triangulation);
}

std::unique_ptr<Triangulation<3>> make_cylinder(const Cilium& cilium,
                                                const CylinderMeshOptions& options,
                                                MPI_Comm communicator) {
  return make_in_parts([&](Triangulation<3>& whole) { make_cylinder(cilium, options, whole); },
                       communicator, attach_mantle);
}

std::size_t quadratic_nodes(const Cilium& cilium, const CylinderMeshOptions& options) {
  const std::vector<double> planes = layer_planes(cilium, options);
  Triangulation<2> section;
  make_section(cilium, options, section);
  const std::size_t in_plane =
      section.n_used_vertices() + section.n_active_lines() + section.n_active_cells();
  return in_plane * (2 * planes.size() - 1);
}

std::unique_ptr<dealii::MappingQCache<3>> cylinder_mapping(const Triangulation<3>& triangulation,
                                                           unsigned int degree) {
  auto mapping = std::make_unique<dealii::MappingQCache<3>>(degree);
  mapping->initialize(dealii::MappingQ<3>(degree), triangulation);
  return mapping;
}

}  // namespace ciliaval::meshes::cylinder
