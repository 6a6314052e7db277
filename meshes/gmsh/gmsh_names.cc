// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/gmsh_names.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "meshes/boundary_ids.h"
#include "meshes/gmsh/gmsh_mesh.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::meshes::gmsh {
namespace {

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  return support::did_you_mean(name, candidates);
}

/// The entities of the physical groups of a dimension, each with the index of its group's name.
/// `unknown` is called with a group whose name is not among `names`. Throws if an entity has two
/// names, or a name has no entity.
template <typename Unknown>
std::map<int, std::size_t> name_entities(const UserMesh& mesh, int dimension,
                                         const std::vector<std::string>& names,
                                         const Unknown& unknown) {
  const std::string kind = dimension == 3 ? "volume" : "surface";
  std::map<int, std::size_t> result;
  std::vector<std::string> found;
  for (const GmshGroup& group : mesh.file.groups) {
    if (group.dimension != dimension) continue;
    found.push_back(group.name);
    const auto name = std::find(names.begin(), names.end(), group.name);
    if (name == names.end()) {
      unknown(group);
      continue;
    }
    for (const int entity : group.entities) {
      const auto [first, added] =
          result.emplace(entity, static_cast<std::size_t>(name - names.begin()));
      if (!added && names[first->second] != *name)
        mesh.fail(fmt::format("{0} {1} is in two physical {0}s, '{2}' and '{3}'{4}", kind, entity,
                              names[first->second], *name,
                              dimension == 3 ? ": a cell has one material" : ""));
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto is_named = [i](const auto& entity) { return entity.second == i; };
    if (std::any_of(result.begin(), result.end(), is_named)) continue;
    mesh.fail(fmt::format(
        "there is no physical {} '{}'; the file has {}{}; add `Physical {}(\"{}\") = {{…}};`", kind,
        names[i], found.empty() ? "none" : fmt::format("'{}'", fmt::join(found, "', '")),
        did_you_mean(names[i], found), dimension == 3 ? "Volume" : "Surface", names[i]));
  }
  return result;
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

void find_segments(UserMesh& mesh) {
  std::vector<std::string> names;
  for (const Segment& segment : mesh.cilium.segments) names.push_back(segment.name);
  const auto unknown = [&](const GmshGroup& group) {
    if (group.name.empty())
      mesh.fail(fmt::format("physical volume {} has no name; it must have that of a segment: '{}'",
                            group.tag, fmt::join(names, "', '")));
    mesh.fail(fmt::format("the physical volume '{}' is no segment of the cilium, which has '{}'{}",
                          group.name, fmt::join(names, "', '"), did_you_mean(group.name, names)));
  };
  const auto entities = name_entities(mesh, 3, names, unknown);
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
  const std::vector<std::string>& names = boundary_names;
  const auto entities = name_entities(mesh, 2, names, [&](const GmshGroup& group) {
    mesh.remarks.push_back(fmt::format("the physical surface '{}' is not used (used are '{}')",
                                       group.name, fmt::join(names, "', '")));
  });
  return {entities.begin(), entities.end()};
}

}  // namespace ciliaval::meshes::gmsh
