// SPDX-License-Identifier: LGPL-2.1-or-later
// The model must take each option that the case reader admits.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compare/input/described.h"
#include "compare/models/registry.h"
#include "fem/beam/beam.h"

namespace ciliaval::compare {
namespace {

/// The ends of the range of an option that is a number; otherwise none.
std::vector<description::Value> ends(const input::Option& option) {
  const description::Value fallback = option.get(input::ModelOptions{});
  if (std::holds_alternative<double>(fallback)) return {option.range.lower, option.range.upper};
  if (std::holds_alternative<unsigned int>(fallback))
    return {static_cast<unsigned int>(option.range.lower),
            static_cast<unsigned int>(option.range.upper)};
  return {};
}

/// Options in which a beam is small, with one option at one end of its range.
input::ModelOptions options_with(const input::Option& option, const description::Value& value) {
  input::ModelOptions options;
  options.of<fem::beam::BeamOptions>().degree = 1;
  options.of<fem::beam::BeamOptions>().refinement = 0;
  option.set(options, value);
  return options;
}

/// Solves a straight cilium without force.
void solve_unloaded(const MechanicsModel& model) {
  const Cilium cilium{0.003, {{"whole", 0.02, 1e6, 0.49, 0.0}}};
  const MechanicsResult result = model.solve(cilium, {DeadLoad{0.0, 0.0}});
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
}

// Oracle: a straight cilium without force stays straight, whatever the options. The solid's own
// solve takes too long on its finest mesh; its options are all checked by its constructor.
TEST(OptionRanges, BothEndsAreTakenByTheMechanicsModel) {
  int count = 0;
  for (const models::MechanicsEntry& entry : models::mechanics_models())
    for (const input::Option& option : entry.options) {
      for (const description::Value& value : ends(option)) {
        SCOPED_TRACE(entry.id + '.' + std::string(option.name) + " = " +
                     input::to_toml(option, value));
        std::unique_ptr<MechanicsModel> model;
        ASSERT_NO_THROW(model = entry.make(options_with(option, value)));
        if (entry.id != "solid") {
          ASSERT_NO_THROW(solve_unloaded(*model));
        }
        ++count;
      }
    }
  EXPECT_GE(count, 2 * (1 + 5 + 6));  // the numeric options of elastica, beam and solid
}

TEST(OptionRanges, BothEndsAreTakenByTheFieldModel) {
  int count = 0;
  for (const models::FieldEntry& entry : models::field_models())
    for (const input::Option& option : entry.options) {
      for (const description::Value& value : ends(option)) {
        EXPECT_NO_THROW(entry.make(options_with(option, value)))
            << entry.id << '.' << option.name << " = " << input::to_toml(option, value);
        ++count;
      }
    }
  EXPECT_GE(count, 2 * 3);  // the tolerances of line, volume and mesh
}

}  // namespace
}  // namespace ciliaval::compare
