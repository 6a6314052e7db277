// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/registry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

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

}  // namespace
}  // namespace ciliaval::compare
