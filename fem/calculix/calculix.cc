// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/calculix/calculix.h"

#include <deal.II/base/quadrature_lib.h>

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <numeric>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <system_error>
#include <variant>

#include "meshes/boundary_ids.h"
#include "problem/error.h"

namespace ciliaval::fem::calculix {
namespace {

using meshes::MeshNodes;
using Coordinates = Eigen::Matrix<double, 20, 3>;

constexpr std::size_t nodes_per_line = 10;
constexpr int max_increments = 1000;
constexpr int digits = 12;  ///< CalculiX reads fields of 20 characters

bool is_half(const MeshNodes& mesh) {
  return std::any_of(mesh.faces.begin(), mesh.faces.end(), [](const MeshNodes::Face& face) {
    return face.boundary == meshes::symmetry_id;
  });
}

Coordinates coordinates(const MeshNodes& mesh, const MeshNodes::Cell& cell) {
  Coordinates X;
  for (std::size_t a = 0; a < calculix_nodes.size(); ++a) {
    const auto& node = mesh.nodes[cell.nodes[static_cast<std::size_t>(calculix_nodes[a])]];
    X.row(static_cast<Eigen::Index>(a)) << node[0], node[1], node[2];
  }
  return X;
}

/// Adds ∫ N_a dV of a cell, or with dim = 2 ∫ N_a dA of its face ζ = 1, to the nodes.
template <int dim>
void add_integrals(const MeshNodes& mesh, const MeshNodes::Cell& cell,
                   std::vector<double>& integrals) {
  const Coordinates X = coordinates(mesh, cell);
  const dealii::QGauss<dim> rule(4);
  for (unsigned int q = 0; q < rule.size(); ++q) {
    Vector3 xi = Vector3::Ones();
    for (unsigned int d = 0; d < dim; ++d) xi[d] = 2 * rule.point(q)[d] - 1;
    double weight = (1 << dim) * rule.weight(q);
    const auto N = serendipity_functions(xi);
    const Matrix3 jacobian = X.transpose() * N.rightCols<3>();
    weight *= dim == 2 ? jacobian.col(0).cross(jacobian.col(1)).norm() : jacobian.determinant();
    for (std::size_t a = 0; a < calculix_nodes.size(); ++a)
      integrals[cell.nodes[static_cast<std::size_t>(calculix_nodes[a])]] +=
          weight * N(static_cast<Eigen::Index>(a), 0);
  }
}

/// True if the cell's face ζ = 1 lies in the plane Z = S.
bool ends_at(const MeshNodes& mesh, const MeshNodes::Cell& cell, double S, double length) {
  return std::all_of(cell.nodes.begin() + 18, cell.nodes.end(), [&](std::size_t node) {
    return std::abs(mesh.nodes[node][2] - S) <= 1e-9 * length;
  });
}

/// A set of nodes or elements, ten to a line.
void write_list(std::ostream& out, const std::vector<std::size_t>& numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out << numbers[i] + 1
        << (i + 1 == numbers.size() || i % nodes_per_line == nodes_per_line - 1 ? "\n" : ", ");
}

std::vector<std::size_t> boundary_nodes(const MeshNodes& mesh, unsigned int boundary,
                                        const std::vector<bool>& used) {
  std::vector<std::size_t> nodes;
  for (const MeshNodes::Face& face : mesh.faces)
    if (face.boundary == boundary)
      for (const std::size_t node : face.nodes)
        if (used[node]) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void write_mesh(std::ostream& out, const MeshNodes& mesh, const std::vector<bool>& used) {
  out << "*NODE, NSET=ALL\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (used[i])
      out << i + 1 << ", " << mesh.nodes[i][0] << ", " << mesh.nodes[i][1] << ", "
          << mesh.nodes[i][2] << "\n";
  unsigned int materials = 0;
  for (const MeshNodes::Cell& cell : mesh.cells) materials = std::max(materials, cell.material + 1);
  for (unsigned int material = 0; material < materials; ++material) {
    out << "*ELEMENT, TYPE=C3D20R, ELSET=SEGMENT" << material << "\n";
    for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
      if (mesh.cells[e].material != material) continue;
      out << e + 1;
      for (std::size_t a = 0; a < calculix_nodes.size(); ++a)
        out << "," << (a == nodes_per_line ? "\n" : " ")
            << mesh.cells[e].nodes[static_cast<std::size_t>(calculix_nodes[a])] + 1;
      out << "\n";
    }
  }
}

void write_materials(std::ostream& out, const Cilium& cilium) {
  for (std::size_t i = 0; i < cilium.segments.size(); ++i)
    out << "*MATERIAL, NAME=MATERIAL" << i << "\n*HYPERELASTIC, NEO HOOKE\n"
        << cilium.segments[i].shear_modulus() / 2 << ", " << 2 / cilium.segments[i].bulk_modulus()
        << "\n*SOLID SECTION, ELSET=SEGMENT" << i << ", MATERIAL=MATERIAL" << i << "\n";
}

/// A finite number as Fortran prints it: an exponent of three digits goes without its letter,
/// "1.234567-101".
std::optional<double> fortran_number(std::string text) {
  text.erase(0, text.find_first_not_of(' '));
  const auto sign = text.find_first_of("+-", 1);
  if (sign != std::string::npos && text.find_first_of("eE") == std::string::npos)
    text.insert(sign, 1, 'E');
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::result_out_of_range && text.find("E-") != std::string::npos) return 0.0;
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

const std::array<int, 20> calculix_nodes{0, 2, 8,  6,  18, 20, 26, 24, 1,  5,
                                         7, 3, 19, 23, 25, 21, 9,  11, 17, 15};

Eigen::Matrix<double, 20, 4> serendipity_functions(const Vector3& at) {
  Eigen::Matrix<double, 20, 4> result;
  for (std::size_t a = 0; a < calculix_nodes.size(); ++a) {
    const int node = calculix_nodes[a];
    const std::array<int, 3> of{node % 3 - 1, node / 3 % 3 - 1, node / 9 - 1};
    // Corner: ∏ (1 + ξξ_a)/8 · (Σ ξξ_a − 2); middle of an edge: (1 − ξ²)/4 ∏ (1 + ηη_a).
    std::array<double, 3> f{};
    std::array<double, 3> g{};
    double sum = -2;
    bool corner = true;
    for (std::size_t d = 0; d < 3; ++d) {
      const double x = at[static_cast<Eigen::Index>(d)];
      f[d] = of[d] == 0 ? 1 - x * x : 1 + x * of[d];
      g[d] = of[d] == 0 ? -2 * x : of[d];
      sum += x * of[d];
      corner = corner && of[d] != 0;
    }
    const double product = f[0] * f[1] * f[2];
    const auto row = static_cast<Eigen::Index>(a);
    result(row, 0) = corner ? product * sum / 8 : product / 4;
    for (std::size_t d = 0; d < 3; ++d) {
      const double slope = g[d] * f[(d + 1) % 3] * f[(d + 2) % 3];
      result(row, static_cast<Eigen::Index>(d) + 1) =
          corner ? (slope * sum + product * of[d]) / 8 : slope / 4;
    }
  }
  return result;
}

std::vector<Vector3> calculix_forces(const MeshNodes& mesh, const Cilium& cilium,
                                     const Load& load) {
  std::vector<double> integrals(mesh.nodes.size());
  double force = 0;
  if (const auto section = load.as<SectionLoad>()) {
    force = section->force;
    for (const MeshNodes::Cell& cell : mesh.cells)
      if (ends_at(mesh, cell, section->arclength, cilium.length()))
        add_integrals<2>(mesh, cell, integrals);
  } else if (const auto dead = load.as<DeadLoad>()) {
    force = dead->force_per_length * cilium.length();
    for (const MeshNodes::Cell& cell : mesh.cells) add_integrals<3>(mesh, cell, integrals);
  } else {
    throw InputError("CalculiX takes the loads 'section' and 'dead', not '" +
                     std::string(type(load)) + "', which follows the current height");
  }
  const double size = std::accumulate(integrals.begin(), integrals.end(), 0.0);
  if (!(size > 0)) throw InputError("the mesh has no plane of cells at the section load's height");
  std::vector<Vector3> forces(mesh.nodes.size());
  for (std::size_t i = 0; i < forces.size(); ++i)
    forces[i] = (is_half(mesh) ? 0.5 : 1) * force * integrals[i] / size * direction(load);
  return forces;
}

void write_calculix_model(std::ostream& out, const MeshNodes& mesh, const Cilium& cilium) {
  const std::vector<bool> used = calculix_node_set(mesh);
  const auto precision = out.precision(digits);
  write_mesh(out, mesh, used);
  write_materials(out, cilium);
  out << "*NSET, NSET=BASE\n";
  write_list(out, boundary_nodes(mesh, meshes::base_id, used));
  out << "*BOUNDARY\nBASE, 1, 3\n";
  if (is_half(mesh)) {
    out << "*NSET, NSET=SYMMETRY\n";
    write_list(out, boundary_nodes(mesh, meshes::symmetry_id, used));
    out << "*BOUNDARY\nSYMMETRY, 2, 2\n";
  }
  out.precision(precision);
}

void write_calculix(std::ostream& out, const MeshNodes& mesh, const Cilium& cilium,
                    const Load& load, double first_increment) {
  const std::vector<Vector3> forces = calculix_forces(mesh, cilium, load);
  write_calculix_model(out, mesh, cilium);
  const auto precision = out.precision(digits);
  out << "*STEP, NLGEOM, INC=" << max_increments << "\n*STATIC\n"
      << first_increment << ", 1.\n*CLOAD\n";
  for (std::size_t i = 0; i < forces.size(); ++i)
    for (int d = 0; d < 3; ++d)
      if (forces[i][d] != 0) out << i + 1 << ", " << d + 1 << ", " << forces[i][d] << "\n";
  out << "*NODE PRINT, NSET=ALL, FREQUENCY=" << max_increments << "\nU\n*END STEP\n";
  out.precision(precision);
}

std::vector<bool> calculix_node_set(const MeshNodes& mesh) {
  std::vector<bool> used(mesh.nodes.size());
  for (const MeshNodes::Cell& cell : mesh.cells)
    for (const int a : calculix_nodes) used[cell.nodes[static_cast<std::size_t>(a)]] = true;
  return used;
}

std::vector<Vector3> read_calculix(std::istream& in, const MeshNodes& mesh) {
  const std::vector<bool> used = calculix_node_set(mesh);
  std::vector<Vector3> displacements;
  std::vector<bool> there;
  double time = 0;
  for (std::string line; std::getline(in, line);) {
    if (in.eof())
      throw FileError("CalculiX's .dat file ends in the middle of a line: is the disk full?");
    if (const auto at = line.find("and time"); at != std::string::npos) {
      time = fortran_number(line.substr(at + 8)).value_or(0);
      displacements.assign(mesh.nodes.size(), Vector3::Zero());
      there.assign(mesh.nodes.size(), false);
      continue;
    }
    std::istringstream fields(line);
    std::size_t node = 0;
    std::array<std::string, 3> texts;
    if (!(fields >> node >> texts[0] >> texts[1] >> texts[2]) || node < 1 || node > there.size())
      continue;
    const std::array u{fortran_number(texts[0]), fortran_number(texts[1]),
                       fortran_number(texts[2])};
    if (!u[0] || !u[1] || !u[2])
      throw FileError("CalculiX's .dat file gives no displacement of node " + std::to_string(node) +
                      ": `" + line + "`");
    displacements[node - 1] = {*u[0], *u[1], *u[2]};
    there[node - 1] = true;
  }
  if (std::abs(time - 1) > 1e-6)
    throw FileError("CalculiX did not reach the whole load: its .dat file ends at time " +
                    std::to_string(time));
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] && !there[i])
      throw FileError("CalculiX's .dat file lacks node " + std::to_string(i + 1) +
                      ": is the disk full?");
  return displacements;
}

}  // namespace ciliaval::fem::calculix
