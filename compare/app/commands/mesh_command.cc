// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/models/registry.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/output/vtk/datasets.h"
#include "compare/output/vtk/files.h"
#include "meshes/gmsh/write_gmsh.h"
#include "meshes/plain_mesh.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct MeshOptions {
  fs::path problem;
  fs::path output;
  std::optional<unsigned int> refinement;
};

/// Mesh of the most detailed model that has one.
meshes::PlainMesh make_mesh(const input::Case& problem, std::optional<unsigned int> refinement) {
  const auto& entries = models::mechanics_models();
  const auto last = std::find_if(entries.rbegin(), entries.rend(),
                                 [](const models::MechanicsEntry& entry) { return !!entry.mesh; });
  if (last == entries.rend()) throw InputError("no model has a mesh");
  return last->mesh(problem, refinement);
}

/// The meshed section against the exact one, whose sides are along x and y if it has any.
std::string describe(const meshes::SectionProperties& section, const Cilium& cilium) {
  const auto off = [](double meshed, double exact) { return 100 * (meshed / exact - 1); };
  return fmt::format(
      "Section: area {:.6g} m^2 ({:+.1g} % off the exact one), second moments {:.6g} and {:.6g} "
      "m^4 "
      "({:+.1g} %, {:+.1g} %)\n",
      section.area, off(section.area, cilium.area()), section.about_x, section.about_y,
      off(section.about_x, cilium.second_moment(std::numbers::pi / 2)),
      off(section.about_y, cilium.second_moment(0)));
}

/// Writes the mesh on which the solid solves a case, whole (not its half): the built-in one at the
/// case's refinement or at the one given, or the user's of [models.solid] mesh as it was read. A
/// `.msh` has the names of the segments and the boundary and can be named in a case again, a `.vtu`
/// is for ParaView; both keep the curved geometry.
ExitCode execute_mesh(const MeshOptions& options, const std::string& words) {
  const input::Case problem = input::read_case(options.problem, models::known());
  const fs::path& output = options.output;
  output::check_outputs({output}, input_files(options.problem, problem));
  const std::string extension = output.extension().string();
  if (extension != ".msh" && extension != ".vtu")
    throw InputError(
        fmt::format("{}: the mesh is written as .msh (Gmsh) or .vtu (ParaView): give "
                    "the file one of these extensions",
                    output.string()));
  input::Case in_frame = problem;  // as the solid meshes it: a rectangle's sides along the axes
  in_frame.cilium = turned(problem.cilium, -azimuth(problem.load_path.front()));
  const meshes::PlainMesh mesh = make_mesh(in_frame, options.refinement);
  output::write_file(output, [&](const fs::path& file) {
    if (extension == ".msh") {
      meshes::gmsh::write_gmsh(mesh.nodes, problem.cilium, file);
      return;
    }
    const auto grid = output::vtk::mesh_grid(mesh.nodes, problem.cilium);
    output::vtk::add_provenance(*grid, output::provenance(words));
    output::vtk::write(*grid, file);
  });
  std::string text = fmt::format("Mesh: {}: {} hexahedra, {} nodes, {} boundary faces, in metres\n",
                                 output.string(), mesh.nodes.cells.size(), mesh.nodes.nodes.size(),
                                 mesh.nodes.faces.size());
  text += describe(mesh.section, in_frame.cilium);
  for (const std::string& remark : mesh.remarks) text += fmt::format("Remark: {}\n", remark);
  print(text);
  return ExitCode::pass;
}

}  // namespace

void add_mesh(CommandLine& line) {
  const auto options = std::make_shared<MeshOptions>();
  CLI::App* mesh = line.add(
      "mesh",
      "Write the solid's mesh of a case to a file: FILE.msh for Gmsh, with the names of the\n"
      "segments and the boundary, or FILE.vtu for ParaView. A .msh can be changed and named\n"
      "in the case, [models.solid] mesh = \"FILE.msh\" (docs/guide/meshes.md).",
      options, execute_mesh);
  add_file(mesh, "CASE", options->problem, "Case file (TOML)");
  mesh->add_option("-o,--output", options->output,
                   "File to write: .msh or .vtu; one that is there is replaced")
      ->type_name("FILE")
      ->required();
  mesh->add_option("--refinement", options->refinement,
                   "0 coarse, 1 default, 2 fine; left out: as the case says")
      ->type_name("N");
}

}  // namespace ciliaval::compare::app::commands
