// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/mesh_command.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/output/vtk/files.h"
#include "compare/output/vtk/mesh.h"
#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "meshes/gmsh/write_gmsh.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

namespace fs = std::filesystem;

struct CaseMesh {
  meshes::MeshNodes nodes;
  std::vector<std::string> remarks;
};

CaseMesh make_mesh(const input::Case& problem, std::optional<unsigned int> refinement) {
  fem::solid::SolidOptions options = problem.options.solid;
  dealii::Triangulation<3> triangulation;
  if (options.mesh.empty()) {
    options.symmetry = false;
    if (refinement) options.refinement = *refinement;
    meshes::cylinder::make_cylinder(problem.cilium,
                          fem::solid::cylinder_mesh_options(options, problem.load_path),
                          triangulation);
    return {meshes::mesh_nodes(triangulation, *meshes::cylinder::cylinder_mapping(triangulation)), {}};
  }
  if (refinement)
    throw InputError(
        fmt::format("the case has a mesh of its own ({}), which has no refinement: "
                    "leave out --refinement",
                    options.mesh.string()));
  meshes::gmsh::GmshMesh mesh =
      meshes::gmsh::read_gmsh({options.mesh, options.mesh_unit}, problem.cilium, triangulation);
  return {meshes::mesh_nodes(triangulation, *mesh.mapping), std::move(mesh.remarks)};
}

}  // namespace

std::string write_case_mesh(const input::Case& problem, const fs::path& output,
                            std::optional<unsigned int> refinement, const std::string& command) {
  const std::string extension = output.extension().string();
  if (extension != ".msh" && extension != ".vtu")
    throw InputError(
        fmt::format("{}: the mesh is written as .msh (Gmsh) or .vtu (ParaView): give "
                    "the file one of these extensions",
                    output.string()));
  const CaseMesh mesh = make_mesh(problem, refinement);
  output::write_file(output, [&](const fs::path& file) {
    if (extension == ".msh") {
      meshes::gmsh::write_gmsh(mesh.nodes, problem.cilium, file);
      return;
    }
    const auto grid = output::vtk::mesh_grid(mesh.nodes, problem.cilium);
    output::vtk::add_provenance(*grid, output::provenance(command));
    output::vtk::write(*grid, file);
  });
  std::string text = fmt::format("Mesh: {}: {} hexahedra, {} nodes, {} boundary faces, in metres\n",
                                 output.string(), mesh.nodes.cells.size(), mesh.nodes.nodes.size(),
                                 mesh.nodes.faces.size());
  for (const std::string& remark : mesh.remarks) text += fmt::format("Remark: {}\n", remark);
  return text;
}

std::vector<std::string> check_case_mesh(const input::Case& problem) {
  const fem::solid::SolidOptions& options = problem.options.solid;
  const auto& ids = problem.mechanics;
  if (options.mesh.empty() || std::find(ids.begin(), ids.end(), "solid") == ids.end()) return {};
  dealii::Triangulation<3> triangulation;
  return meshes::gmsh::read_gmsh({options.mesh, options.mesh_unit}, problem.cilium, triangulation)
      .remarks;
}

}  // namespace ciliaval::compare::app::commands
