// SPDX-License-Identifier: LGPL-2.1-or-later
// Faults planted in a good mesh: each is found, and its message says which, where and what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <sstream>
#include <string_view>

#include "meshes/gmsh/gmsh_mesh.h"
#include "meshes/gmsh/write_gmsh.h"
#include "meshes/mesh_nodes.h"
#include "problem/error.h"
#include "tests/support/temporary_folder.h"
#include "text_mesh.h"

namespace ciliaval::meshes::gmsh {
namespace {

using test::TextMesh;

struct Fault {
  std::string name;
  std::function<void(TextMesh&)> plant;
  std::vector<std::string> words;  ///< that the message has
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

void erase_if(TextMesh& mesh, const std::function<bool(const TextMesh::Element&)>& condition) {
  std::erase_if(mesh.elements, condition);
}

void rename(TextMesh& mesh, const std::string& from, const std::string& to) {
  for (TextMesh::Name& name : mesh.names)
    if (name.name == from) name.name = to;
}

/// Gives the cells above the height nodes of their own.
void tear(TextMesh& mesh, double height, const std::function<void(std::array<double, 3>&)>& move) {
  std::map<std::size_t, std::size_t> copies;
  for (TextMesh::Element& element : mesh.elements) {
    if (mesh.centre(element)[2] < height) continue;
    for (std::size_t& node : element.nodes) {
      const auto [copy, added] = copies.emplace(node, mesh.nodes.size() + 1);
      if (added) mesh.nodes.push_back(std::array<double, 3>(mesh.at(node)));
      node = copy->second;
    }
  }
  for (const auto& [unused, copy] : copies) move(mesh.at(copy));
}

std::vector<Fault> name_faults() {
  return {
      {"MisspeltVolume",
       [](TextMesh& m) { rename(m, "magnet", "magnt"); },
       {"'magnt' is no segment", "did you mean 'magnet'?"}},
      {"MisspeltSurface",
       [](TextMesh& m) { rename(m, "mantle", "mantel"); },
       {"no physical surface 'mantle'", "did you mean 'mantel'?", "Physical Surface(\"mantle\")"}},
      {"NoPhysicalNames", [](TextMesh& m) { m.names.clear(); }, {"has no name", "'stub'"}},
      {"VolumeMissing",
       [](TextMesh& m) { erase_if(m, [](const auto& e) { return e.physical == 1; }); },
       {"no physical volume 'stub'", "Physical Volume(\"stub\")"}},
      {"CellWithoutMaterial",
       [](TextMesh& m) {
         TextMesh::Element& cell = m.elements[m.find(5, 0.01, 0.02)];
         cell.physical = 0;
         cell.entity = 99;
       },
       {"of volume 99 at (", "in no physical volume"}},
      {"CellOfTwoMaterials",
       [](TextMesh& m) { m.elements[m.find(5, 0.01, 0.02)].physical = 1; },
       {"volume 2 is in two physical volumes, 'stub' and 'magnet'"}},
      {"Tetrahedra",
       [](TextMesh& m) {
         TextMesh::Element& cell = m.elements[m.find(5, 0, 1)];
         cell.type = 4;
         cell.nodes.resize(4);
       },
       {"Tetrahedron", "hexahedra with 8 or 27 nodes"}},
      {"Prisms",
       [](TextMesh& m) {
         TextMesh::Element& cell = m.elements[m.find(5, 0, 1)];
         cell.type = 6;
         cell.nodes.resize(6);
       },
       {"Prism", "Recombine"}},
      {"TrianglesInANamedSurface",
       [](TextMesh& m) {
         TextMesh::Element& face = m.elements[m.find(3, -1, 1e-6)];
         face.type = 2;
         face.nodes.resize(3);
       },
       {"Triangle", "quadrilaterals"}},
      {"NoHexahedra",
       [](TextMesh& m) { erase_if(m, [](const auto& e) { return e.type == 5; }); },
       {"no hexahedra", "physical volumes"}},
  };
}

std::vector<Fault> place_faults() {
  const auto each_node = [](const std::function<void(std::array<double, 3>&)>& move) {
    return [move](TextMesh& m) { std::for_each(m.nodes.begin(), m.nodes.end(), move); };
  };
  return {
      {"MillimetresTakenForMetres",
       each_node([](auto& x) {
         for (double& c : x) c *= 1000;
       }),
       {"is 20 high, the cilium is 0.02", "mesh_unit = \"1 mm\""}},
      {"WrongHeight", each_node([](auto& x) { x[2] *= 0.9; }), {"is 0.018 high"}},
      {"WrongDiameter",
       each_node([](auto& x) {
         x[0] *= 0.9;
         x[1] *= 0.9;
       }),
       {"has the diameter 0.0027", "the cilium 0.003"}},
      {"LiesAlongX", each_node([](auto& x) { std::swap(x[0], x[2]); }), {"lies along X or Y"}},
      {"AxisBesideZ", each_node([](auto& x) { x[0] += 0.01; }), {"axis stands at (0.01, 0)"}},
      {"StandsHigherUp", each_node([](auto& x) { x[2] += 0.01; }), {"stands on Z = 0.01"}},
      {"OtherSegmentLengths",
       [](TextMesh& m) {
         for (auto& x : m.nodes)
           x[2] = x[2] <= 3e-3 ? x[2] * 4 / 3 : 4e-3 + (x[2] - 3e-3) * 16 / 17;
       },
       {"'stub' spans Z = 0 to 0.004", "segment Z = 0 to 0.003"}},
      {"MaterialInTheWrongSegment",
       [](TextMesh& m) {
         TextMesh::Element& cell = m.elements[m.find(5, 0.01, 0.011)];
         cell.physical = cell.entity = 1;
       },
       {"physical volume 'stub' spans Z = 0 to"}},
  };
}

std::vector<Fault> topology_faults() {
  return {
      {"DoubleNodesAtTheInterface",
       [](TextMesh& m) { tear(m, 3e-3, [](auto&) {}); },
       {"torn at the interface of 'stub' and 'magnet'", "Coherence"}},
      {"OtherSectionMeshAboveTheInterface",
       [](TextMesh& m) {
         tear(m, 3e-3, [](auto& x) {
           const double c = std::cos(0.2);
           const double s = std::sin(0.2);
           x = {c * x[0] - s * x[1] + (std::hypot(x[0], x[1]) < 1e-6 ? 1e-4 : 0),
                s * x[0] + c * x[1], x[2]};  // the node on the axis moves too
         });
       },
       {"no neighbour across the plane Z = 0.003", "do not conform"}},
      {"LayerMissing",
       [](TextMesh& m) {
         const double z = m.centre(m.elements[m.find(5, 0.01, 0.02)])[2];
         erase_if(m, [&](const auto& e) { return std::abs(m.centre(e)[2] - z) < 1e-9; });
       },
       {"several parts", "gap without cells between Z ="}},
      {"CellMissing",
       [](TextMesh& m) {
         m.elements.erase(m.elements.begin() + static_cast<std::ptrdiff_t>(m.find(5, 0.01, 0.02)));
       },
       {"no neighbour across the plane", "hole"}},
      {"HoleAlongTheAxis",
       [](TextMesh& m) {
         erase_if(m, [&](const auto& e) {
           const auto x = m.centre(e);
           return std::hypot(x[0], x[1]) < 0.7e-3;
         });
       },
       {"side without a neighbour", "mantle's radius is 0.0015"}},
      {"SecondCiliumBesideTheFirst",
       [](TextMesh& m) {
         const TextMesh first = m;
         for (auto x : first.nodes) m.nodes.push_back({x[0] + 0.01, x[1], x[2]});
         for (auto e : first.elements) {
           for (std::size_t& node : e.nodes) node += first.nodes.size();
           m.elements.push_back(e);
         }
       },
       {"several parts", "no chain of faces"}},
      {"SameCellTwice",
       [](TextMesh& m) { m.elements.push_back(m.elements[m.find(5, 0.01, 0.02)]); },
       {"are the same cell"}},
      {"NodeMovedSideways",
       [](TextMesh& m) { m.at(m.elements[m.find(5, 0.01, 0.02)].nodes[0])[0] += 1e-4; },
       {"is not extruded along Z", "not vertical"}},
      {"NodeMovedUp",
       [](TextMesh& m) { m.at(m.elements[m.find(5, 0.01, 0.02)].nodes[0])[2] += 1e-4; },
       {"is not extruded along Z", "corners are at the heights", "Extrude"}},
      {"CollapsedCell",
       [](TextMesh& m) {
         TextMesh::Element& cell = m.elements[m.find(5, 0.01, 0.02)];
         cell.nodes[1] = cell.nodes[0];
       },
       {"is degenerate", "eight different corners"}},
      {"FlatCells",
       [](TextMesh& m) {
         // The inner columns nearly onto the rim: rings of slivers.
         for (auto& x : m.nodes) {
           const double r = std::hypot(x[0], x[1]);
           if (r < 0.3e-3 || r > 1.4e-3) continue;
           const double turn = 0.75;
           const double c = std::cos(turn);
           const double s = std::sin(turn);
           x = {1.8 * (c * x[0] - s * x[1]), 1.8 * (s * x[0] + c * x[1]), x[2]};
         }
       },
       {"is badly shaped", "scaled Jacobian"}},
  };
}

std::vector<Fault> boundary_faults() {
  const auto base_face = [](TextMesh& m) -> TextMesh::Element& {
    return m.elements[m.find(3, -1, 1e-6)];
  };
  return {
      {"BaseNotClosed",
       [](TextMesh& m) {
         m.elements.erase(m.elements.begin() + static_cast<std::ptrdiff_t>(m.find(3, -1, 1e-6)));
       },
       {"'base' is not closed: 1 of its 12 faces", "clamped"}},
      {"TipInTheBase",
       [](TextMesh& m) {
         for (TextMesh::Element& e : m.elements)
           if (e.physical == 13) e.physical = e.entity = 11;
         m.elements.push_back(m.elements[m.find(3, 0.005, 0.015)]);
         m.elements.back().physical = m.elements.back().entity = 13;
       },
       {"of the physical surface 'base'", "lies on the tip"}},
      {"InnerFaceInTheBase",
       [=](TextMesh& m) {
         TextMesh::Element face = base_face(m);
         const TextMesh::Element& cell = m.elements[m.find(5, 0.01, 0.02)];
         face.nodes = {cell.nodes[0], cell.nodes[1], cell.nodes[2], cell.nodes[3]};
         m.elements.push_back(face);
       },
       {"'base' at (", "lies inside the body"}},
      {"FacesWithNodesOfTheirOwn",
       [=](TextMesh& m) {
         TextMesh::Element& face = base_face(m);
         m.nodes.push_back(std::array<double, 3>(m.at(face.nodes[0])));
         face.nodes[0] = m.nodes.size();
       },
       {"is not a face of a hexahedron", "is no corner of one"}},
      {"NoMantle",
       [](TextMesh& m) { erase_if(m, [](const auto& e) { return e.physical == 12; }); },
       {"no physical surface 'mantle'"}},
      {"MantleWithAHole",
       [](TextMesh& m) {
         const std::size_t e = m.find(3, 0.005, 0.015);
         m.elements.erase(m.elements.begin() + static_cast<std::ptrdiff_t>(e));
       },
       {"'mantle' is not closed: 1 of its"}},
  };
}

std::vector<Fault> all_faults() {
  std::vector<Fault> all = name_faults();
  for (const auto& list : {place_faults(), topology_faults(), boundary_faults()})
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

std::string message(const std::filesystem::path& file, const Cilium& cilium) {
  try {
    read_gmsh({file}, cilium);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

class PlantedFault : public testing::TestWithParam<Fault> {};

// Oracle: the fault that was planted. The same mesh without it is read (the mutation is what the
// message is about).
TEST_P(PlantedFault, IsToldWithItsPlaceAndRemedy) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  TextMesh mesh = test::built_in(cilium);
  const auto file = folder.path() / "cilium.msh";
  mesh.write(file);
  ASSERT_EQ(message(file, cilium), "no error");
  GetParam().plant(mesh);
  mesh.write(file);
  const std::string text = message(file, cilium);
  EXPECT_THAT(text, testing::StartsWith(file.string() + ": "));
  for (const std::string& words : GetParam().words) EXPECT_THAT(text, testing::HasSubstr(words));
}

INSTANTIATE_TEST_SUITE_P(Gmsh, PlantedFault, testing::ValuesIn(all_faults()),
                         [](const auto& instance) { return instance.param.name; });

TEST(GmshFileFaults, AreFileErrors) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  const std::string good = test::built_in(cilium).text();
  const auto fails = [&](const std::string& name, const std::string& text,
                         const std::string& words) {
    const auto file = folder.path() / name;
    if (!text.empty()) std::ofstream(file) << text;
    try {
      read_gmsh({file}, cilium);
      FAIL() << name << " was read";
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(words));
      EXPECT_THAT(error.what(), testing::HasSubstr(name));
    }
  };
  fails("none.msh", "", "does not exist");
  fails(".", "", "not a regular file");
  fails("script.msh", "SystemCall \"touch " + (folder.path() / "trap").string() + "\";\n",
        "does not begin with `$MeshFormat`");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "trap"));
  fails("cilium.txt", good, "extension .msh");
  fails("half.msh", good.substr(0, good.size() / 2), "truncated");
  fails("old.msh", "$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", "Gmsh cannot read");
}

// A file cut anywhere, also where a section happens to end, is an error and nothing worse.
TEST(GmshFileFaults, ATruncatedFileIsNeverRead) {
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  const std::string good = test::built_in(cilium).text();
  std::vector<std::size_t> cuts{good.find("$Nodes"), good.find("$Elements"),
                                good.find("$PhysicalNames"), good.size() - 20};
  for (std::size_t i = 1; i < 20; ++i) cuts.push_back(good.size() * i / 20);
  for (const std::size_t cut : cuts) {
    for (const char* end : {"", "\n$EndElements\n"}) {
      std::ofstream(folder.path() / "cut.msh") << good.substr(0, cut) << end;
      EXPECT_THROW(read_gmsh({folder.path() / "cut.msh"}, cilium), Error) << cut;
    }
  }
}

/// The message of a file of this content; "read" if it is read.
std::string message_of(const std::string& text, const Cilium& cilium) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "damaged.msh";
  std::ofstream(file, std::ios::binary) << text;
  try {
    read_gmsh({file}, cilium);
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("damaged.msh"));
    return error.what();
  }
  return "read";
}

/// The content of a good file, as Gmsh writes it.
std::string good_text(const GmshFormat& format, const Cilium& cilium) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "good.msh";
  test::built_in(cilium).write(file);
  const GmshMesh mesh = read_gmsh({file}, cilium);
  write_gmsh(mesh_nodes(*mesh.triangulation, *mesh.mapping), cilium, file, format);
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// Gmsh 4.8 crashes on both: an element with a node out of range, and a number of names that stands
// twice.
TEST(GmshFileFaults, DamageThatCrashesGmshIsAnError) {
  const Cilium cilium = test::stub_and_magnet();
  TextMesh mesh = test::built_in(cilium);
  mesh.elements.front().nodes.front() = static_cast<std::size_t>(-1);
  EXPECT_THAT(message_of(mesh.text(), cilium), testing::HasSubstr("Gmsh cannot read"));
  std::string names = good_text({.version = 4.1}, cilium);
  const std::string head = "$PhysicalNames\n5\n";
  names.replace(names.find(head), head.size(), head + "5\n");
  EXPECT_THAT(message_of(names, cilium), testing::HasSubstr("Gmsh cannot read"));
}

/// The file with one fault: a line gone or doubled, or a word that is out of range or of the wrong
/// kind; of a binary file a byte changed, or bytes gone.
std::string mutated(const std::string& text, bool binary, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  std::string result = text;
  if (binary) {
    const std::size_t at = 30 + below(text.size() - 60);
    if (below(2) == 0) return result.erase(at, 1 + below(20));
    result[at] = static_cast<char>(below(256));
    return result;
  }
  std::size_t begin = text.find('\n', below(text.size() - 20)) + 1;
  if (below(2) == 0) {  // near the head of a section
    begin = text.find("\n$", below(text.size() - 20)) + 1;
    for (std::size_t lines = below(4); lines > 0; --lines) begin = text.find('\n', begin) + 1;
  }
  const std::size_t end = text.find('\n', begin) + 1;
  if (end == 0) return result;
  switch (below(4)) {
    case 0:
      return result.erase(begin, end - begin);
    case 1:
      return result.insert(begin, text.substr(begin, end - begin));
    default:
      break;
  }
  const std::vector<std::string> words{"-1",         "0", "3",   "15", "99999999999",
                                       "4294967296", "x", "nan", "",   "1e300"};
  const std::size_t word = begin + below(end - begin);
  const std::size_t from = text.find_last_of(" \n", word == 0 ? 0 : word - 1) + 1;
  return result.replace(from, text.find_first_of(" \n", from) - from, words[below(words.size())]);
}

// Seeded: a damaged file is read, or refused with an Error that names it; nothing else comes of it.
TEST(GmshFileFaults, MutatedFilesAreReadOrRefused) {
  const Cilium cilium = test::stub_and_magnet();
  std::size_t refused = 0;
  for (const double version : {2.2, 4.1})
    for (const bool binary : {false, true}) {
      const std::string text = good_text({.version = version, .binary = binary}, cilium);
      ASSERT_EQ(message_of(text, cilium), "read");
      std::mt19937 random(20261);
      for (int i = 0; i < 60; ++i)
        refused += message_of(mutated(text, binary, random), cilium) != "read";
    }
  EXPECT_GT(refused, 60U);
}

// The Gmsh library writes preferences into ~/.fltk.
TEST(GmshFile, LeavesTheHomeFolderAlone) {
  const test::TemporaryFolder home;
  const test::TemporaryFolder folder;
  const Cilium cilium = test::stub_and_magnet();
  const std::string before = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
  setenv("HOME", home.path().c_str(), 1);
  test::built_in(cilium).write(folder.path() / "cilium.msh");
  EXPECT_EQ(message(folder.path() / "cilium.msh", cilium), "no error");
  EXPECT_TRUE(std::filesystem::is_empty(home.path()));
  setenv("HOME", before.c_str(), 1);
}

}  // namespace
}  // namespace ciliaval::meshes::gmsh
