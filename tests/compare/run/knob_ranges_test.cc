// SPDX-License-Identifier: LGPL-2.1-or-later
// What the case reader admits, the model must take.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compare/input/case_keys.h"
#include "compare/models/registry.h"

namespace ciliaval::compare {
namespace {

/// The ends of the range of a knob that is a number; otherwise none.
std::vector<input::KnobValue> ends(const input::Knob& knob) {
  const input::KnobValue fallback = knob.get(input::ModelOptions{});
  if (std::holds_alternative<double>(fallback)) return {knob.range.lower, knob.range.upper};
  if (std::holds_alternative<unsigned int>(fallback))
    return {static_cast<unsigned int>(knob.range.lower),
            static_cast<unsigned int>(knob.range.upper)};
  return {};
}

/// Options in which a beam is small, with one knob at one end of its range.
input::ModelOptions options_with(const input::Knob& knob, const input::KnobValue& value) {
  input::ModelOptions options;
  options.beam.degree = 1;
  options.beam.refinement = 0;
  knob.set(options, value);
  return options;
}

/// Solves a straight cilium without force.
void solve_unloaded(const MechanicsModel& model) {
  const Cilium cilium{0.003, {{"whole", 0.02, 1e6, 0.49, 0.0}}};
  const MechanicsResult result = model.solve(cilium, {DeadLoad{0.0, 0.0}});
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
}

// Oracle: a straight cilium without force stays straight, whatever the knobs. The solid's own solve
// takes too long on its finest mesh; its knobs are all checked by its constructor.
TEST(KnobRanges, BothEndsAreTakenByTheMechanicsModel) {
  int count = 0;
  for (const models::MechanicsEntry& entry : models::mechanics_models())
    for (const input::Knob& knob : input::knobs()) {
      if (knob.model != entry.id) continue;
      for (const input::KnobValue& value : ends(knob)) {
        SCOPED_TRACE(entry.id + '.' + std::string(knob.name) + " = " + input::to_toml(knob, value));
        std::unique_ptr<MechanicsModel> model;
        ASSERT_NO_THROW(model = entry.make(options_with(knob, value)));
        if (entry.id != "solid") {
          ASSERT_NO_THROW(solve_unloaded(*model));
        }
        ++count;
      }
    }
  EXPECT_GE(count, 2 * (1 + 5 + 6));  // the numeric knobs of elastica, beam and solid
}

TEST(KnobRanges, BothEndsAreTakenByTheFieldModel) {
  int count = 0;
  for (const models::FieldEntry& entry : models::field_models())
    for (const input::Knob& knob : input::knobs()) {
      if (knob.model != entry.id) continue;
      for (const input::KnobValue& value : ends(knob)) {
        EXPECT_NO_THROW(entry.make(options_with(knob, value)))
            << entry.id << '.' << knob.name << " = " << input::to_toml(knob, value);
        ++count;
      }
    }
  EXPECT_GE(count, 2 * 3);  // the tolerances of line, volume and mesh
}

}  // namespace
}  // namespace ciliaval::compare
