// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/gmsh_names.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "meshes/gmsh/gmsh_mesh.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::meshes::gmsh {
namespace {

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  return support::did_you_mean(name, candidates);
}

std::vector<std::string> segment_names(const Cilium& cilium) {
  std::vector<std::string> names;
  for (const Segment& segment : cilium.segments) names.push_back(segment.name);
  return names;
}

std::size_t index_of(const std::string& name, const std::vector<std::string>& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The entities of the named groups of a dimension: the index of the name. `unknown` is called with
/// the names that are not among `names`, `several` with an entity that has two.
template <typename Unknown, typename Several>
std::map<int, std::size_t> name_entities(const GmshFile& file, int dimension,
                                         const std::vector<std::string>& names,
                                         const Unknown& unknown, const Several& several) {
  std::map<int, std::size_t> result;
  for (const GmshGroup& group : file.groups) {
    if (group.dimension != dimension) continue;
    const std::size_t index = index_of(group.name, names);
    if (index == names.size()) {
      unknown(group);
      continue;
    }
    for (const int entity : group.entities) {
      const auto [first, added] = result.emplace(entity, index);
      if (!added && first->second != index) several(entity, first->second, index);
    }
  }
  return result;
}

/// Throws if a name has no entity.
void require_all(const UserMesh& mesh, const std::map<int, std::size_t>& entities,
                 const std::vector<std::string>& names, const std::string& kind,
                 const std::vector<std::string>& found) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto is_named = [i](const auto& entity) { return entity.second == i; };
    if (std::any_of(entities.begin(), entities.end(), is_named)) continue;
    mesh.fail(fmt::format(
        "there is no physical {} '{}'; the file has {}{}; add `Physical {}(\"{}\") = {{…}};`", kind,
        names[i], found.empty() ? "none" : fmt::format("'{}'", fmt::join(found, "', '")),
        did_you_mean(names[i], found), kind == "volume" ? "Volume" : "Surface", names[i]));
  }
}

}  // namespace

void UserMesh::fail(const std::string& what) const {
  throw InputError(source.path.string() + ": " + what);
}

std::string UserMesh::node(std::size_t index) const {
  const dealii::Point<3>& x = file.nodes[index];
  return fmt::format("node {} at ({:.6g}, {:.6g}, {:.6g})", file.node_tags[index], x[0], x[1],
                     x[2]);
}

std::string UserMesh::hexahedron(std::size_t index) const {
  const GmshElement& element = file.hexahedra[index];
  dealii::Point<3> x;
  for (const std::size_t n : element.nodes)
    x += file.nodes[n] / static_cast<double>(element.nodes.size());
  for (unsigned int c = 0; c < 3; ++c)  // rounding of the mean is not worth a digit
    if (std::abs(x[c]) < 1e-9 * in_file(cilium.diameter)) x[c] = 0;
  const std::string of = segments.empty()
                             ? fmt::format("volume {}", element.entity)
                             : fmt::format("'{}'", cilium.segments[segments[index]].name);
  return fmt::format("element {} of {} at ({:.6g}, {:.6g}, {:.6g})", element.tag, of, x[0], x[1],
                     x[2]);
}

const std::vector<std::string>& boundary_names() {
  static const std::vector<std::string> names{"base", "mantle", "tip"};
  return names;
}

void find_segments(UserMesh& mesh) {
  const std::vector<std::string> names = segment_names(mesh.cilium);
  std::vector<std::string> found;
  for (const GmshGroup& group : mesh.file.groups)
    if (group.dimension == 3) found.push_back(group.name);
  const auto unknown = [&](const GmshGroup& group) {
    if (group.name.empty())
      mesh.fail(fmt::format("physical volume {} has no name; it must have that of a segment: '{}'",
                            group.tag, fmt::join(names, "', '")));
    mesh.fail(fmt::format("the physical volume '{}' is no segment of the cilium, which has '{}'{}",
                          group.name, fmt::join(names, "', '"), did_you_mean(group.name, names)));
  };
  const auto several = [&](int entity, std::size_t a, std::size_t b) {
    mesh.fail(
        fmt::format("volume {} is in two physical volumes, '{}' and '{}': a cell has one material",
                    entity, names[a], names[b]));
  };
  const auto entities = name_entities(mesh.file, 3, names, unknown, several);
  require_all(mesh, entities, names, "volume", found);
  std::vector<std::size_t> segments;
  for (std::size_t e = 0; e < mesh.file.hexahedra.size(); ++e) {
    const auto segment = entities.find(mesh.file.hexahedra[e].entity);
    if (segment == entities.end())
      mesh.fail(mesh.hexahedron(e) + " is in no physical volume, so it has no material");
    segments.push_back(segment->second);
  }
  mesh.segments = std::move(segments);
}

std::map<int, unsigned int> find_boundaries(UserMesh& mesh) {
  const std::vector<std::string>& names = boundary_names();
  std::vector<std::string> found;
  std::vector<std::string> others;
  for (const GmshGroup& group : mesh.file.groups)
    if (group.dimension == 2) found.push_back(group.name);
  const auto unknown = [&](const GmshGroup& group) { others.push_back(group.name); };
  const auto several = [&](int entity, std::size_t a, std::size_t b) {
    mesh.fail(fmt::format("surface {} is in two physical surfaces, '{}' and '{}'", entity, names[a],
                          names[b]));
  };
  const auto entities = name_entities(mesh.file, 2, names, unknown, several);
  require_all(mesh, entities, names, "surface", found);
  for (const std::string& name : others)
    mesh.remarks.push_back(fmt::format("the physical surface '{}' is not used (used are '{}')",
                                       name, fmt::join(names, "', '")));
  return {entities.begin(), entities.end()};
}

}  // namespace ciliaval::meshes::gmsh
