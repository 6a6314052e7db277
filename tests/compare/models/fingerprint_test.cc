// SPDX-License-Identifier: LGPL-2.1-or-later
// Every key of a case file is changed in turn. The fingerprint of a stored state must change with
// it.
#include "compare/models/fingerprint.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/schema/keys.h"
#include "compare/models/registry.h"
#include "tests/support/case_texts.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using input::schema::Key;

const input::MechanicsEntry& solid_entry() {
  return models::entry_of(models::mechanics_models(), "solid");
}

/// A cilium of one segment with what `keys` says of it.
std::string rod(std::string_view section, std::string_view segment = "density = \"1 g/cm3\"\n") {
  return fmt::format(
      "[case]\nname = \"rod\"\ntitle = \"a rod\"\n[cilium]\n{}[[cilium.segment]]\nname = \"a\"\n"
      "length = \"20 mm\"\nyoung_modulus = \"3 MPa\"\npoisson_ratio = 0.45\n"
      "magnetization = \"75 kA/m\"\n{}",
      section, segment);
}
const std::string round_section = "diameter = \"3 mm\"\n";
const std::string models_table =
    "[models]\nmechanics = [\"beam\", \"solid\"]\nfields = [\"line\"]\n";
const std::string sensors =
    "[[sensor]]\nname = \"s\"\nposition = [\"1 mm\", \"0 mm\", \"-2 mm\"]\n"
    "rotation = \"1 deg\"\ngain = 1.1\ncomponents = [\"x\", \"y\"]\n"
    "axes = [\"+x\", \"-y\", \"+z\"]\n";

std::string sweep(std::string_view surface, std::string_view rest = "") {
  return rod(round_section) + sensors +
         "[load]\ntype = \"sweep\"\ninterference = \"1 mm\"\ntravel = \"5 mm\"\nsamples = 4\n"
         "return = false\nspeed = \"5 mm/s\"\nazimuth = \"10 deg\"\n[surface]\n" +
         std::string(surface) + std::string(rest) + models_table;
}

/// Cases that together state every key of a case file, a key a line. The files lie in `folder`.
std::vector<std::string> texts(const test::TemporaryFolder& folder) {
  const auto file = [&](const char* name, const std::string& content) {
    return "\"" + folder.write(name, content).string() + "\"\n";
  };
  const std::string contact =
      "[load]\ntype = \"contact\"\nforce = [\"1 mN\", \"2 mN\"]\nheight = \"16 mm\"\n";
  const std::string magnet =
      "[environment]\ngravity = [\"0 m/s2\", \"0 m/s2\", \"-9.81 m/s2\"]\n"
      "fluid_density = \"1 kg/m3\"\nuniform_field = [\"1 mT\", \"0 mT\", \"0 mT\"]\n"
      "magnetic_energy = \"F\"\n[[environment.magnet]]\nname = \"m\"\n"
      "position = [\"30 mm\", \"0 mm\", \"20 mm\"]\n";
  const std::string profile =
      "x [m], height [m]\n-0.05,0\n-0.02,0.0001\n0.01,0\n0.04,0.0001\n0.09,0\n";
  std::vector<std::string> all{
      rod(round_section) + contact + sensors +
          "[readings]\nmap = \"bx=Ch 1, by=Ch 2, bz=Ch 3\"\nunit = \"mG\"\n"
          "unloaded = \"0 s..1 s\"\n" +
          models_table +
          "[models.solid]\nmaterial = \"yeoh\"\nyeoh_ratios = [0.1, 0.01]\n"
          "[models.volume]\nmethod = \"quadrature\"\n[models.line]\nmethod = \"uniform\"\n"
          "elements = 50\n[models.potential]\nrelative_permeability = 1.1\n"
          "[[models.potential.plate]]\nlower = [\"-9 mm\", \"-9 mm\", \"-5 mm\"]\n"
          "upper = [\"9 mm\", \"9 mm\", \"-4 mm\"]\nrelative_permeability = 1000\n"
          "[[measurement]]\nquantity = \"tip.deflection\"\npoint = [\"1 mm\", \"-0.5 mm\"]\n"
          "step = 1\nvalue = \"3.5 mm\"\nuncertainty = \"0.1 mm\"\nsource = \"photograph\"\n"
          "fitted = true\n[[input_uncertainty]]\nnumber = \"cilium.diameter\"\n"
          "uncertainty = \"0.1 mm\"\nsource = \"calliper\"\n",
      rod(round_section) + contact +
          "[readings]\nscale = \"0.15 uT\"\naverage = \"10 ms\"\n"
          "temperature = \"-0.1 %/K\"\n" +
          models_table +
          "[models.solid]\nmaterial = \"mooney-rivlin\"\nmooney_ratio = 0.2\n"
          "[models.volume]\nmethod = \"uniform\"\nelements = 10\n"
          "[models.line]\nmethod = \"quadrature\"\ntolerance = 1e-9\n" +
          sensors,
      rod("[cilium.section]\nshape = \"rectangle\"\nwidth = \"3 mm\"\nheight = \"2 mm\"\n"
          "orientation = \"10 deg\"\n") +
          "[load]\ntype = \"section\"\nforce = \"1 mN\"\narclength = \"15 mm\"\n"
          "azimuth = \"10 deg\"\n[models]\nmechanics = [\"solid\"]\n",
      rod(round_section + "[cilium.section]\nshape = \"tube\"\ninner_diameter = \"1 mm\"\n") +
          "[load]\ntype = \"dead\"\nforce_per_length = \"0.1 N/m\"\n[models]\nmechanics = "
          "[\"solid\"]\n",
      rod(round_section) + "[load]\ntype = \"flow\"\nforce_per_height = \"0.1 N/m\"\n" +
          "[models]\nmechanics = [\"solid\"]\n",
      rod(round_section) +
          "[load]\ntype = \"flow\"\nvelocity = \"0.5 m/s\"\ndensity = \"900 kg/m3\"\n"
          "drag_coefficient = 1.2\n[models]\nmechanics = [\"solid\"]\n",
      rod(round_section) +
          "[load]\ntype = \"probe\"\ndisplacement = \"1 mm\"\nheight = \"15 mm\"\nslip_off = "
          "\"rim\"\n" +
          "[models]\nmechanics = [\"solid\"]\n",
      rod(round_section) + "[load]\ntype = \"environment\"\nscale = 0.5\nazimuth = \"0 deg\"\n" +
          magnet +
          "shape = \"ball\"\ndiameter = \"5 mm\"\naxis = [1, 0, 0]\nremanence = \"1 T\"\n" +
          "[models]\nmechanics = [\"solid\"]\n",
      rod(round_section) + magnet +
          "shape = \"cylinder\"\ndiameter = \"5 mm\"\nlength = \"4 mm\"\n"
          "rotation = [0.8, 0.6, 0, 0]\nmagnetization = \"900 kA/m\"\n[models]\nmechanics = "
          "[\"solid\"]\n",
      rod(round_section) + magnet +
          "shape = \"cuboid\"\nedges = [\"5 mm\", \"4 mm\", \"3 mm\"]\n"
          "magnetization = [\"900 kA/m\", \"0 A/m\", \"0 A/m\"]\n[models]\nmechanics = "
          "[\"solid\"]\n",
      sweep("profile = \"flat\"\nfriction = 0.3\ntilt = \"1 deg\"\n",
            "[signal]\nsampling_rate = \"100 Hz\"\nnoise = \"1 uT\"\nseed = 2\norder = 3\n"
            "cutoff = \"1 Hz\"\nphase = \"causal\"\n"),
      sweep("profile = \"sine\"\namplitude = \"0.1 mm\"\nwavelength = \"5 mm\"\n"),
      sweep("profile = \"trapezoid\"\nheight = \"1 mm\"\ntop = \"10 mm\"\nbottom = \"9 mm\"\n"
            "flank = \"1 mm\"\nradius = \"0.5 mm\"\n"),
      sweep("profile = \"random\"\nrms = \"40 um\"\nhurst = 0.4\nlongest = \"2 mm\"\n"
            "shortest = \"0.4 mm\"\nseed = 1\n"),
      sweep("profile = \"file\"\npath = " + file("profile.csv", profile)),
      rod(round_section) +
          "[load]\ntype = \"flow\"\nvelocity = \"0.5 m/s\"\ndrag_coefficient = \"cylinder\"\n"
          "viscosity = \"2 mPa s\"\n[models]\nmechanics = [\"solid\"]\n",
      rod(round_section) + "[load]\ntype = \"moment\"\nmoment = \"1 uN m\"\n" +
          "[models]\nmechanics = [\"solid\"]\n"};
  all.push_back(replaced(all[10], "interference = \"1 mm\"", "clearance = \"-1 mm\""));
  for (const char* touch : {"law = \"coulomb\"\nfriction = 0.3\n",
                            "law = \"horizontal\"\nat = \"mantle\"\nradius = \"1 mm\"\n"})
    all.push_back(
        rod(round_section) +
        "[load]\ntype = \"contact\"\nforce = \"1 mN\"\nheight = \"2 mm\"\n[load.touch]\n" + touch +
        "[models]\nmechanics = [\"elastica\"]\n[[input_uncertainty]]\nnumber = \"load.height\"\n"
        "range = [\"1.8 mm\", \"2.3 mm\"]\n");
  return all;
}

/// A line of a case file that states a key.
struct Line {
  std::size_t begin = 0;  ///< of the value
  std::size_t end = 0;
  std::string key;  ///< with its table: "cilium.segment.length"
};

std::vector<Line> key_lines(const std::string& text) {
  std::vector<Line> result;
  std::string table;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    if (line.starts_with('[')) {
      const std::size_t first = line.find_first_not_of('[');
      table = line.substr(first, line.find(']') - first);
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      result.push_back({begin + equals + 3, end, table + "." + line.substr(0, equals)});
    }
    begin = end + 1;
  }
  return result;
}

/// Other values in place of a value: another choice, the other flag, each number a little larger or
/// smaller, a longer text. Some may be refused.
std::vector<std::string> other_values(const std::string& value, const Key& key) {
  std::vector<std::string> all;
  if (value == "true") all.emplace_back("false");
  if (value == "false") all.emplace_back("true");
  for (const std::string_view choice : key.choices)
    all.push_back(value.starts_with('[') ? fmt::format("[\"{}\"]", choice)
                                         : fmt::format("\"{}\"", choice));
  for (std::size_t at = 0; at < value.size();) {
    const bool begins =
        at == 0 || std::string_view(" \"[").find(value[at - 1]) != std::string::npos;
    char* stop = nullptr;
    const double number = std::strtod(value.c_str() + at, &stop);
    const auto end = static_cast<std::size_t>(stop - value.c_str());
    if (!begins || end == at || value[at] == ' ') {
      ++at;
      continue;
    }
    for (const double other : {number * 1.01, number * 0.99, number + 1, number - 1, number + 90})
      all.push_back(value.substr(0, at) + fmt::format("{:.12g}", other) + value.substr(end));
    at = end;
  }
  if (value.starts_with('"')) all.push_back(value.substr(0, value.size() - 1) + "x\"");
  return all;
}

/// True if a key may be changed between a run that was killed and the one that goes on with its
/// solid: keys of numbers that are computed from the solid's result or set beside it, and the two
/// limits that are raised after a failure.
bool cannot_change_the_solid(std::string_view key) {
  for (const std::string_view table :
       {"case.", "sensor.", "signal.", "readings.", "measurement.", "input_uncertainty."})
    if (key.starts_with(table)) return true;
  if (key == "models.solid.max_iterations" || key == "models.solid.max_cutbacks") return true;
  return key.starts_with("models.") && !key.starts_with("models.solid.");
}

/// Keys of files, which are changed below by their content, and of other programs' results.
bool is_of_a_file(const Key& key) {
  const std::string name = key.table + "." + std::string(key.name);
  return key.kind == Key::Kind::file || key.kind == Key::Kind::files ||
         name == "measurement.column" || name == "measurement.load" ||
         name == "measurement.scale" || name == "models.solid.mesh_unit" ||
         key.table == "models.external";
}

/// Keys of which no other value is right by itself: choices with keys of their own, of which the
/// texts above have all; the four numbers of a unit quaternion; what was
/// measured, with its unit; the axes of a chip, of which each stands once; an error limit in place
/// of a refinement, which has a test below.
bool is_changed_with_others(std::string_view key) {
  for (const std::string_view with_others :
       {"cilium.section.shape", "load.type", "sensor.axes", "environment.magnet.shape",
        "surface.profile", "environment.magnet.rotation", "measurement.quantity",
        "models.solid.tolerance", "models.solid.tolerance_of"})
    if (key == with_others) return true;
  return false;
}

TEST(Fingerprint, ChangesWithEveryKeyOfACaseFile) {
  const test::TemporaryFolder folder;
  std::map<std::string, Key> keys;
  for (const Key& key : input::schema::all_keys(models::known()))
    keys.emplace(key.table + "." + std::string(key.name), key);
  std::set<std::string> changed;
  for (const std::string& stated : texts(folder)) {
    const input::Case usual = read(stated);
    const std::string written = input::to_toml(usual, models::known());
    const support::Fingerprint whole = models::fingerprint(usual);
    const auto of_solid = models::fingerprint(usual, solid_entry());
    for (const std::string& text : {stated, written})  // the second one states all options
      for (const Line& line : key_lines(text)) {
        ASSERT_TRUE(keys.contains(line.key)) << line.key;
        const std::string value = text.substr(line.begin, line.end - line.begin);
        for (const std::string& other : other_values(value, keys.at(line.key))) {
          std::string with_other = text;
          with_other.replace(line.begin, value.size(), other);
          input::Case c;
          try {
            c = read(with_other);
          } catch (const InputError&) {
            continue;
          }
          if (input::to_toml(c, models::known()) == written) continue;  // the same in other words
          changed.insert(line.key);
          const bool is_name = line.key.starts_with("case.");
          EXPECT_EQ(models::fingerprint(c) == whole, is_name) << line.key << " = " << other;
          EXPECT_EQ(models::fingerprint(c, solid_entry()) == of_solid,
                    cannot_change_the_solid(line.key))
              << line.key << " = " << other;
        }
      }
  }
  for (const auto& [name, key] : keys)
    EXPECT_TRUE(changed.contains(name) || is_of_a_file(key) || is_changed_with_others(name))
        << name << " was never changed";
}

TEST(Fingerprint, ChangesWithTheContentOfAFileAndNotWithItsPlace) {
  const test::TemporaryFolder folder;
  input::Case c = read(texts(folder).at(14));
  ASSERT_FALSE(c.surface->file.empty());
  const auto before = models::fingerprint(c, solid_entry());
  ASSERT_TRUE(before);
  const std::string content = test::read_text(c.surface->file);
  c.surface->file = folder.write("moved.csv", content);
  EXPECT_EQ(models::fingerprint(c, solid_entry()), before);
  c.surface->file = folder.write("profile.csv", content + "0.1,0.0001\n");
  EXPECT_NE(models::fingerprint(c, solid_entry()), before);
}

TEST(Fingerprint, HasSensorsAndFieldModelsWhereTheErrorOfTheFieldIsLimited) {
  const test::TemporaryFolder folder;
  const std::string usual = texts(folder).at(0) + "[models.mesh]\ntolerance = 1e-7\n";
  const std::string limited = replaced(usual, "material = \"yeoh\"\nyeoh_ratios = [0.1, 0.01]",
                                       "tolerance = \"1 %\"\ntolerance_of = \"field\"");
  const auto differs = [&](const std::string& text, std::string_view part, std::string_view by) {
    return models::fingerprint(read(text), solid_entry()) !=
           models::fingerprint(read(replaced(text, part, by)), solid_entry());
  };
  EXPECT_NE(models::fingerprint(read(usual), solid_entry()),
            models::fingerprint(read(limited), solid_entry()));
  EXPECT_TRUE(differs(limited, "\"1 %\"", "\"2 %\""));
  EXPECT_TRUE(differs(limited, "\"field\"", "\"tip\""));
  EXPECT_TRUE(differs(limited, "\"-2 mm\"", "\"-3 mm\""));
  EXPECT_TRUE(differs(limited, "tolerance = 1e-7", "tolerance = 1e-6"));
  EXPECT_FALSE(differs(usual, "\"-2 mm\"", "\"-3 mm\""));
  EXPECT_FALSE(differs(usual, "tolerance = 1e-7", "tolerance = 1e-6"));
}

TEST(Fingerprint, IsOfModelsThatKeepACheckpoint) {
  const input::Case c = test::paper_case({1e-3});
  EXPECT_TRUE(models::fingerprint(c, solid_entry()));
  EXPECT_FALSE(models::fingerprint(c, models::entry_of(models::mechanics_models(), "elastica")));
}

}  // namespace
}  // namespace ciliaval::compare
