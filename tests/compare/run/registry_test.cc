// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/registry.h"

#include <gtest/gtest.h>

#include "compare/input/case_keys.h"

namespace ciliaval::compare {
namespace {

// The case reader knows the models' names without the models: both lists are held together here.
TEST(Registry, HasTheModelsThatTheCaseReaderKnows) {
  std::vector<std::string> mechanics;
  for (const models::MechanicsEntry& entry : models::mechanics_models())
    mechanics.push_back(entry.id);
  EXPECT_EQ(mechanics,
            std::vector<std::string>(input::mechanics_ids().begin(), input::mechanics_ids().end()));
  std::vector<std::string> fields;
  for (const models::FieldEntry& entry : models::field_models()) fields.push_back(entry.id);
  EXPECT_EQ(fields, std::vector<std::string>(input::field_ids().begin(), input::field_ids().end()));
}

TEST(Registry, MakesEveryModel) {
  const input::ModelOptions options;
  for (const models::MechanicsEntry& entry : models::mechanics_models())
    EXPECT_NE(entry.make(options), nullptr);
  for (const models::FieldEntry& entry : models::field_models())
    EXPECT_EQ(entry.make(options)->needs_body(), entry.id == "mesh");
}

}  // namespace
}  // namespace ciliaval::compare
