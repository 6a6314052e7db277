// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/registry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "compare/models/run.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

TEST(Registry, MakesEveryModelUnderAnIdOfItsOwn) {
  std::set<std::string> ids;
  models::known().for_each([&](const auto& entry) {
    EXPECT_NE(entry.make({}), nullptr) << entry.id;
    EXPECT_TRUE(ids.insert(entry.id).second) << entry.id;
    EXPECT_FALSE(entry.description.empty()) << entry.id;
  });
}

// The coarsest levels may be coarser than a case file may state.
TEST(Registry, RefinesByOptionsThatTheModelHasDownToValuesInTheirRange) {
  models::known().for_each([](const auto& entry) {
    for (const input::Refinement& refinement : entry.refinements) {
      const auto option =
          std::find_if(entry.options.begin(), entry.options.end(),
                       [&](const input::Option& o) { return o.name == refinement.option; });
      ASSERT_NE(option, entry.options.end()) << entry.id << '.' << refinement.option;
      EXPECT_TRUE(option->range.contains(refinement.values.back()))
          << entry.id << '.' << refinement.option;
    }
  });
}

/// The names under which the fingerprints of the solid in two cases differ.
std::vector<std::string> differences(const input::Case& a, const input::Case& b) {
  const models::MechanicsEntry& solid = models::entry_of(models::mechanics_models(), "solid");
  const auto before = models::fingerprint(a, solid);
  const auto after = models::fingerprint(b, solid);
  std::vector<std::string> names;
  for (const auto& entry : *after)
    if (std::find(before->begin(), before->end(), entry) == before->end())
      names.push_back(entry.first);
  return names;
}

TEST(Fingerprint, HasAllOfCiliumAndLoadsThatTheSolutionDependsOn) {
  const input::Case usual = test::paper_case({1e-3, 2e-3});
  const auto expect = [&](const std::string& name, const std::function<void(input::Case&)>& set) {
    input::Case other = usual;
    set(other);
    const std::vector<std::string> names = differences(usual, other);
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  };
  const std::string of = " of segment `" + usual.cilium.segments.back().name + "`";
  expect("diameter", [](input::Case& c) { c.cilium.diameter = 2.9e-3; });
  expect("length" + of, [](input::Case& c) { c.cilium.segments.back().length *= 1.01; });
  expect("young_modulus" + of,
         [](input::Case& c) { c.cilium.segments.back().young_modulus *= 1 + 4e-16; });
  expect("poisson_ratio" + of,
         [](input::Case& c) { c.cilium.segments.back().poisson_ratio = 0.4; });
  expect("magnetization" + of,
         [](input::Case& c) { c.cilium.segments.back().magnetization = 7e4; });
  expect("number of segments", [](input::Case& c) {
    c.cilium.segments.push_back({"top", 1e-3, 1e5, 0.4, 0});
  });
  expect("number of load steps", [](input::Case& c) { c.load_path.push_back(c.load_path.back()); });
  expect("load of step 2", [](input::Case& c) { c.load_path[1].set_value(0, 2.5e-3); });
  expect("load of step 1",
         [](input::Case& c) { c.load_path[0] = with_azimuth(c.load_path[0], 0.3); });
  expect("load of step 1", [](input::Case& c) { c.load_path[0] = SectionLoad{1e-3, 16e-3, 0}; });
}

TEST(Fingerprint, HasEveryOptionButThoseThatMayBeRaisedAfterAFailure) {
  const input::Case usual = test::paper_case({1e-3});
  for (const input::Option& option :
       models::entry_of(models::mechanics_models(), "solid").options) {
    input::Case other = usual;
    input::OptionValue value = option.get(other.options);
    if (auto* flag = std::get_if<bool>(&value)) *flag = !*flag;
    if (auto* whole = std::get_if<unsigned int>(&value)) ++*whole;
    if (auto* real = std::get_if<double>(&value)) *real = *real == 0 ? 1 : 1.01 * *real;
    if (auto* pair = std::get_if<std::array<double, 2>>(&value)) (*pair)[1] *= 1.01;
    if (auto* text = std::get_if<std::string>(&value))
      *text = option.choices.empty() ? "a.msh" : std::string(option.choices.back());
    option.set(other.options, value);
    const bool may_change = option.name == "max_iterations" || option.name == "max_cutbacks";
    const std::vector<std::string> expected{"models.solid." + std::string(option.name)};
    EXPECT_EQ(differences(usual, other), may_change ? std::vector<std::string>() : expected);
  }
}

}  // namespace
}  // namespace ciliaval::compare
