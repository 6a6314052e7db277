// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/fem/calculix/sweep_deck.h"

#include <deal.II/grid/tria.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <ostream>
#include <sstream>
#include <string>

#include "fem/calculix/calculix.h"
#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/error.h"
#include "problem/load.h"
#include "problem/support/child_process.h"

namespace ciliaval::fem::calculix {
namespace {

using meshes::MeshNodes;

// The plate along x, m: beyond all places of the tips of the tests, in lengths of the profile
// that 8-node faces follow.
constexpr double plate_begin = -6e-3;
constexpr double plate_end = 16e-3;
constexpr double plate_width = 6e-3;
constexpr double plate_thickness = 3e-3;
constexpr int plate_elements = 44;

MeshNodes half_mesh(const RefereeSweep& sweep) {
  solid::SolidOptions solid;
  solid.refinement = sweep.refinement;
  const auto options = solid::cylinder_mesh_options(solid, {SweepLoad{}});
  dealii::Triangulation<3> triangulation;
  meshes::cylinder::make_cylinder(sweep.cilium, options, triangulation);
  return meshes::mesh_nodes(triangulation, *meshes::cylinder::cylinder_mapping(triangulation));
}

/// Nodal forces of a unit force on the tip's face of the whole cilium: on the half they sum to 1/2.
std::vector<double> tip_weights(const MeshNodes& mesh, const Cilium& cilium) {
  std::vector<double> weights;
  for (const Vector3& force : calculix_forces(mesh, cilium, SectionLoad{1, cilium.length(), 0}))
    weights.push_back(force.x());
  return weights;
}

/// At rest the plate's lower side is z = height − p(x).
void write_plate(std::ostream& out, const RefereeSweep& sweep, const MeshNodes& mesh,
                 double height) {
  const auto number = [&](int i, int j, int k) {
    return mesh.nodes.size() + 1 + static_cast<std::size_t>(9 * i + 3 * j + k);
  };
  out << "*NODE, NSET=PLATE\n";
  for (int i = 0; i <= 2 * plate_elements; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        if (i % 2 + j % 2 + k % 2 > 1) continue;  // middles of faces and cells
        const double x = plate_begin + (plate_end - plate_begin) * i / (2 * plate_elements);
        const double bottom = height - sweep.surface.at(x).height;
        out << number(i, j, k) << ", " << x << ", " << plate_width * (j - 1) / 2 << ", "
            << bottom + plate_thickness * k / 2 << "\n";
      }
  out << "*ELEMENT, TYPE=C3D20, ELSET=PLATE\n";
  for (int e = 0; e < plate_elements; ++e) {
    out << mesh.cells.size() + 1 + static_cast<std::size_t>(e);
    for (std::size_t a = 0; a < calculix_nodes.size(); ++a) {
      const int node = calculix_nodes[a];
      out << (a == 10 ? ",\n" : ", ") << number(2 * e + node % 3, node / 3 % 3, node / 9);
    }
    out << "\n";
  }
  out << "*MATERIAL, NAME=PLATE\n*ELASTIC\n1e6, 0.\n*SOLID SECTION, ELSET=PLATE, MATERIAL=PLATE\n"
         "*BOUNDARY\nPLATE, 2, 2\n*SURFACE, NAME=PLATE, TYPE=ELEMENT\nPLATE, S1\n";
}

void write_contact(std::ostream& out, const RefereeSweep& sweep,
                   const std::vector<double>& weights) {
  out << "*NSET, NSET=TIP\n";
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] != 0) out << i + 1 << "\n";
  out << "*SURFACE, NAME=TIP, TYPE=NODE\nTIP\n*SURFACE INTERACTION, NAME=TOUCH\n"
         "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n"
      << sweep.stiffness << "\n";
  // How stiff a node sticks is no matter where all slide.
  if (sweep.surface.friction > 0)
    out << "*FRICTION\n" << sweep.surface.friction << ", " << sweep.stiffness / 10 << "\n";
  out << "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=NODE TO SURFACE\nTIP, PLATE\n";
}

/// A step at whose end the plate stands at (x, z) and the tip bears a force along x.
void write_step(std::ostream& out, const RefereeSweep& sweep, const std::vector<double>& weights,
                double x, double z, double force) {
  out << "*STEP, NLGEOM, INC=1000\n*STATIC\n"
      << sweep.increment << ", 1., 1e-6, " << sweep.increment << "\n*BOUNDARY\nPLATE, 1, 1, " << x
      << "\nPLATE, 3, 3, " << z << "\n*CLOAD\n";
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] != 0) out << i + 1 << ", 1, " << force * weights[i] << "\n";
  out << "*NODE PRINT, NSET=PLATE, TOTALS=ONLY, FREQUENCY=1000\nRF\n"
         "*NODE PRINT, NSET=TIP, FREQUENCY=1000\nU\n*END STEP\n";
}

/// The tip is bent aside while the plate comes down; the force on the tip is taken away while the
/// plate moves to the first sample, so that the tip slides the same way on the plate throughout.
void write_sweep(std::ostream& out, const RefereeSweep& sweep, const MeshNodes& mesh) {
  out.precision(12);
  const std::vector<double> weights = tip_weights(mesh, sweep.cilium);
  const double height = sweep.cilium.length() + sweep.interference;
  write_calculix_model(out, mesh, sweep.cilium);
  write_plate(out, sweep, mesh, height);
  write_contact(out, sweep, weights);
  const double z = -2 * sweep.interference;
  write_step(out, sweep, weights, sweep.travels.front() - sweep.run_in, z, sweep.holding_force);
  for (const double s : sweep.travels) write_step(out, sweep, weights, s, z, 0);
}

/// Content of a .dat file for the end of a step.
struct Printed {
  Vector3 reaction = Vector3::Zero();            ///< of the plate of half of the cilium, N
  std::map<std::size_t, Vector3> displacements;  ///< of the tip's nodes, m
};

std::vector<Printed> read_steps(std::istream& in) {
  std::vector<Printed> steps;
  bool totals = false;
  for (std::string line; std::getline(in, line);) {
    if (line.find("and time") != std::string::npos) {
      totals = line.find("total force") != std::string::npos;
      if (totals) steps.emplace_back();
      continue;
    }
    if (steps.empty()) continue;
    std::istringstream fields(line);
    std::size_t node = 0;
    Vector3 value;
    if (!totals) fields >> node;
    if (!(fields >> value[0] >> value[1] >> value[2])) continue;
    (totals ? steps.back().reaction : steps.back().displacements[node]) = value;
  }
  return steps;
}

/// r = 2 Σ w x over the face of the half, which CalculiX's shape functions integrate, and the angle
/// of ∫ (x − r) X dA, by the same rule.
SweepState state_of(const Printed& printed, const RefereeSweep& sweep, double travel,
                    const MeshNodes& mesh, const std::vector<double>& weights) {
  SweepState state;
  Vector3 direction = Vector3::Zero();
  Vector3 highest = Vector3::Zero();
  for (const auto& [number, u] : printed.displacements) {
    const auto& X = mesh.nodes.at(number - 1);
    const Vector3 x = Vector3(X[0], X[1], X[2]) + u;
    state.tip += 2 * weights.at(number - 1) * x;
    direction += weights.at(number - 1) * X[0] * x;
    if (x.z() > highest.z()) highest = x;
  }
  state.tip.y() = 0;
  state.angle = std::atan2(-direction.z(), direction.x());
  const double slope = sweep.surface.at(highest.x() - travel).slope;
  const double w = std::sqrt(1 + slope * slope);
  const Vector3 force = 2 * printed.reaction;  // of the plate on the cilium
  state.normal_force = force.dot(Vector3(-slope, 0, -1)) / w;
  state.friction_force = force.dot(Vector3(1, 0, -slope)) / w;
  return state;
}

}  // namespace

std::vector<SweepState> run_referee(const RefereeSweep& sweep,
                                    const std::filesystem::path& folder) {
  const MeshNodes mesh = half_mesh(sweep);
  std::ofstream deck(folder / "sweep.inp");
  write_sweep(deck, sweep, mesh);
  deck.close();
  const support::ChildEnd end = support::run_child(
      {"ccx", {"-i", "sweep"}, folder, folder / "ccx.log", 3600, {{"OMP_NUM_THREADS", "1"}}});
  if (!end.succeeded()) throw SolverError("ccx " + end.text());
  std::ifstream output(folder / "sweep.dat");
  const std::vector<Printed> steps = read_steps(output);
  if (steps.size() != sweep.travels.size() + 1)
    throw SolverError("ccx printed " + std::to_string(steps.size()) + " steps");
  const std::vector<double> weights = tip_weights(mesh, sweep.cilium);
  std::vector<SweepState> states;
  for (std::size_t i = 0; i < sweep.travels.size(); ++i)
    states.push_back(state_of(steps[i + 1], sweep, sweep.travels[i], mesh, weights));
  return states;
}

}  // namespace ciliaval::fem::calculix
