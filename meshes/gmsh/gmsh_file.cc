// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/gmsh_file.h"

#include <fmt/core.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <unordered_map>

#include "meshes/gmsh/gmsh_process.h"
#include "problem/error.h"

namespace ciliaval::meshes::gmsh {
namespace {

namespace fs = std::filesystem;

/// Gmsh would run a file that is not a mesh as a script: the file must begin and end as a mesh.
void require_mesh_file(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw FileError(name + ": the mesh file does not exist");
  if (!fs::is_regular_file(status)) throw FileError(name + ": is not a regular file, not a mesh");
  if (path.extension() != ".msh")
    throw FileError(fmt::format(
        "{}: a mesh file has the extension .msh; in Gmsh use File > Export, or `gmsh -3 -o x.msh`",
        name));
  std::ifstream in(path, std::ios::binary);
  constexpr std::string_view first = "$MeshFormat";
  std::string head(first.size(), '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (!in.is_open() || in.bad())
    throw FileError(
        fmt::format("{}: the mesh file cannot be read: {}", name, std::strerror(errno)));
  if (head != first)
    throw FileError(
        fmt::format("{}: is not a Gmsh mesh: it does not begin with `{}`", name, first));
  in.clear();
  in.seekg(0, std::ios::end);
  const std::streamoff tail_size = std::min<std::streamoff>(in.tellg(), 64);
  in.seekg(-tail_size, std::ios::end);
  std::string tail(static_cast<std::size_t>(tail_size), '\0');
  in.read(tail.data(), tail_size);
  while (!tail.empty() && (tail.back() == '\n' || tail.back() == '\r' || tail.back() == ' '))
    tail.pop_back();
  const std::size_t line = tail.rfind('\n');
  if (line == std::string::npos || tail.compare(line + 1, 4, "$End") != 0)
    throw FileError(fmt::format(
        "{}: the mesh file is truncated: its last line is not the `$End…` of a section; write or "
        "copy it again",
        name));
}

/// Gmsh's table of an element type.
struct ElementProperties {
  std::string name;
  int dimension = 0;
  int order = 0;
  int nodes = 0;
  std::vector<double> coordinates;  ///< of the nodes, in [−1, 1]

  explicit ElementProperties(int type) {
    int primary_nodes = 0;
    ::gmsh::model::mesh::getElementProperties(type, name, dimension, order, nodes, coordinates,
                                              primary_nodes);
  }
};

using Indices = std::unordered_map<std::size_t, std::size_t>;

Indices read_nodes(GmshFile& file) {
  std::vector<double> coordinates;
  std::vector<double> parameters;
  ::gmsh::model::mesh::getNodes(file.node_tags, coordinates, parameters);
  Indices index;
  for (std::size_t i = 0; i < file.node_tags.size(); ++i) {
    file.nodes.emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
    index.emplace(file.node_tags[i], i);
  }
  return index;
}

void read_groups(GmshFile& file) {
  ::gmsh::vectorpair groups;
  ::gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, tag] : groups) {
    if (dimension < 2) continue;
    GmshGroup group{dimension, tag, {}, {}};
    ::gmsh::model::getPhysicalName(dimension, tag, group.name);
    ::gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, group.entities);
    file.groups.push_back(std::move(group));
  }
}

/// Elements of one type in one entity, as Gmsh hands them over.
struct Block {
  int type = 0;
  int entity = 0;
  std::vector<std::size_t> tags;
  std::vector<std::size_t> nodes;
};

std::vector<Block> read_blocks(int dimension, const std::vector<int>& entities) {
  std::vector<Block> blocks;
  for (const int entity : entities) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags;
    std::vector<std::vector<std::size_t>> nodes;
    ::gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
    for (std::size_t i = 0; i < types.size(); ++i)
      blocks.push_back({types[i], entity, std::move(tags[i]), std::move(nodes[i])});
  }
  return blocks;
}

/// All volumes, or the surfaces of the physical groups.
std::vector<int> entities_of(int dimension, const GmshFile& file) {
  std::vector<int> entities;
  if (dimension == 3) {
    ::gmsh::vectorpair all;
    ::gmsh::model::getEntities(all, dimension);
    for (const auto& [unused, tag] : all) entities.push_back(tag);
  } else {
    for (const GmshGroup& group : file.groups)
      if (group.dimension == dimension)
        entities.insert(entities.end(), group.entities.begin(), group.entities.end());
  }
  std::sort(entities.begin(), entities.end());
  entities.erase(std::unique(entities.begin(), entities.end()), entities.end());
  return entities;
}

std::vector<GmshElement> read_elements(const fs::path& path, int dimension, const Indices& index,
                                       GmshFile& file) {
  const std::array<GmshElementType, 2> types{gmsh_element_type(dimension, false),
                                             gmsh_element_type(dimension, true)};
  std::vector<GmshElement> elements;
  for (const Block& block : read_blocks(dimension, entities_of(dimension, file))) {
    if (block.tags.empty()) continue;
    const bool quadratic = block.type == types[1].type;
    const GmshElementType& type = types[quadratic ? 1 : 0];
    if (block.type != type.type)
      throw InputError(fmt::format(
          "{}: element {} ({} {}) is a {}: the {} must be {} with {} nodes, all of them; mesh by "
          "extrusion with Recombine (Mesh.SecondOrderIncomplete = 0 for second order)",
          path.string(), block.tags.front(), dimension == 3 ? "volume" : "surface", block.entity,
          ElementProperties(block.type).name, dimension == 3 ? "volumes" : "named surfaces",
          dimension == 3 ? "hexahedra" : "quadrilaterals", dimension == 3 ? "8 or 27" : "4 or 9"));
    if (elements.empty() && dimension == 3) file.quadratic = quadratic;
    if (quadratic != file.quadratic)
      throw InputError(fmt::format(
          "{}: element {} is of {} order, others are of {}: set the order of the whole mesh "
          "(Gmsh: Mesh > Set order)",
          path.string(), block.tags.front(), quadratic ? "second" : "first",
          quadratic ? "first" : "second"));
    const std::size_t n = type.lexicographic.size();
    for (std::size_t e = 0; e < block.tags.size(); ++e) {
      GmshElement element{block.tags[e], block.entity, std::vector<std::size_t>(n)};
      for (std::size_t a = 0; a < n; ++a) {
        const auto found = index.find(block.nodes[e * n + a]);
        if (found == index.end())
          throw FileError(fmt::format("{}: element {} has the node {}, which is not in the file",
                                      path.string(), element.tag, block.nodes[e * n + a]));
        element.nodes[type.lexicographic[a]] = found->second;
      }
      elements.push_back(std::move(element));
    }
  }
  return elements;
}

}  // namespace

GmshElementType gmsh_element_type(int dimension, bool quadratic) {
  const int order = quadratic ? 2 : 1;
  GmshElementType result;
  result.type =
      ::gmsh::model::mesh::getElementType(dimension == 3 ? "Hexahedron" : "Quadrangle", order);
  const ElementProperties properties(result.type);
  for (int a = 0; a < properties.nodes; ++a) {
    long lexicographic = 0;
    for (int c = dimension - 1; c >= 0; --c) {
      const auto entry = static_cast<std::size_t>(a) * static_cast<std::size_t>(dimension) +
                         static_cast<std::size_t>(c);
      const double x = properties.coordinates[entry];
      lexicographic = lexicographic * (order + 1) + std::lround((x + 1) / 2 * order);
    }
    result.lexicographic.push_back(static_cast<std::size_t>(lexicographic));
  }
  return result;
}

GmshFile read_gmsh_file(const fs::path& path) {
  require_mesh_file(path);
  const std::string text = in_gmsh_process(path, "read the mesh file", [&] {
    ::gmsh::open(path.string());
    GmshFile read;
    const Indices index = read_nodes(read);
    read_groups(read);
    read.hexahedra = read_elements(path, 3, index, read);
    read.quadrilaterals = read_elements(path, 2, index, read);
    std::ostringstream packed;
    boost::archive::binary_oarchive(packed) << read;
    return packed.str();
  });
  GmshFile file;
  std::istringstream packed(text);
  boost::archive::binary_iarchive(packed) >> file;
  if (file.hexahedra.empty())
    throw InputError(fmt::format(
        "{}: the mesh has no hexahedra: mesh the volumes (`gmsh -3`), and put them into physical "
        "volumes, for Gmsh saves only those once there is one physical group",
        path.string()));
  return file;
}

}  // namespace ciliaval::meshes::gmsh
