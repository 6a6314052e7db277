// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/mesh_command.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <system_error>

#include "compare/output/provenance.h"
#include "compare/output/vtk/files.h"
#include "compare/output/vtk/mesh.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "meshes/gmsh/write_gmsh.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;

/// Writes to a temporary name of the same extension in the same folder, then renames.
void write_and_rename(const fs::path& output, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary =
      output.parent_path() /
      fmt::format(".{}.{}.tmp{}", output.stem().string(), getpid(), output.extension().string());
  std::error_code error;
  if (fs::is_directory(output, error))
    throw FileError(output.string() + ": is a folder, not a file that a mesh could replace");
  if (output.has_parent_path() && !fs::is_directory(output.parent_path(), error))
    throw FileError(output.string() + ": its folder does not exist");
  try {
    write(temporary);
    fs::rename(temporary, output);
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

struct CaseMesh {
  meshes::MeshNodes nodes;
  std::vector<std::string> remarks;
};

CaseMesh make_mesh(const Case& problem, std::optional<unsigned int> refinement) {
  fem::SolidOptions options = problem.options.solid;
  dealii::Triangulation<3> triangulation;
  if (options.mesh.empty()) {
    options.symmetry = false;
    if (refinement) options.refinement = *refinement;
    meshes::make_cylinder(problem.cilium, fem::cylinder_mesh_options(options, problem.load_path),
                          triangulation);
    return {meshes::mesh_nodes(triangulation, *meshes::cylinder_mapping(triangulation)), {}};
  }
  if (refinement)
    throw InputError(
        fmt::format("the case has a mesh of its own ({}), which has no refinement: "
                    "leave out --refinement",
                    options.mesh.string()));
  meshes::GmshMesh mesh =
      meshes::read_gmsh({options.mesh, options.mesh_unit}, problem.cilium, triangulation);
  return {meshes::mesh_nodes(triangulation, *mesh.mapping), std::move(mesh.remarks)};
}

}  // namespace

std::string write_case_mesh(const Case& problem, const fs::path& output,
                            std::optional<unsigned int> refinement, const std::string& command) {
  const std::string extension = output.extension().string();
  if (extension != ".msh" && extension != ".vtu")
    throw InputError(
        fmt::format("{}: the mesh is written as .msh (Gmsh) or .vtu (ParaView): give "
                    "the file one of these extensions",
                    output.string()));
  const CaseMesh mesh = make_mesh(problem, refinement);
  write_and_rename(output, [&](const fs::path& file) {
    if (extension == ".msh") {
      meshes::write_gmsh(mesh.nodes, problem.cilium, file);
      return;
    }
    const auto grid = vtk::mesh_grid(mesh.nodes, problem.cilium);
    vtk::add_provenance(*grid, provenance(command));
    vtk::write(*grid, file);
  });
  std::string text = fmt::format("Mesh: {}: {} hexahedra, {} nodes, {} boundary faces, in metres\n",
                                 output.string(), mesh.nodes.cells.size(), mesh.nodes.nodes.size(),
                                 mesh.nodes.faces.size());
  for (const std::string& remark : mesh.remarks) text += fmt::format("Remark: {}\n", remark);
  return text;
}

std::vector<std::string> check_case_mesh(const Case& problem) {
  const fem::SolidOptions& options = problem.options.solid;
  const auto& ids = problem.mechanics;
  if (options.mesh.empty() || std::find(ids.begin(), ids.end(), "solid") == ids.end()) return {};
  dealii::Triangulation<3> triangulation;
  return meshes::read_gmsh({options.mesh, options.mesh_unit}, problem.cilium, triangulation)
      .remarks;
}

}  // namespace ciliaval::compare
