// SPDX-License-Identifier: LGPL-2.1-or-later
// The models on the way from the paper's to the best one.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "compare/budget/budget.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::budget {
namespace {

using Options = input::ModelOptions;

/// Throws InputError unless each word names a model of the stages, which begin with the paper's,
/// or the sensitivity.
void require_words(const std::vector<std::string>& without, std::span<const Stage> stages) {
  const Stage& paper = stages.front();
  std::vector<std::string_view> words;
  for (const Stage& stage : stages)
    for (const std::string* id : {&stage.mechanics, &stage.field})
      if (*id != paper.mechanics && *id != paper.field &&
          std::ranges::find(words, *id) == words.end())
        words.push_back(*id);
  words.emplace_back("sensitivity");
  for (const std::string& word : without) {
    if (word == paper.mechanics || word == paper.field)
      throw InputError(fmt::format(
          "--without {0}: {0} is the paper's model, which the budget begins with", word));
    if (std::ranges::find(words, word) == words.end())
      throw InputError(
          fmt::format("--without {}: there is nothing of that name to leave out{}; "
                      "there are {}",
                      word, support::did_you_mean(word, words), fmt::join(words, ", ")));
  }
}

/// Sets the options of a mechanics model's stage, then those of a field model's.
std::function<void(Options&)> both(const input::BudgetStage& mechanics,
                                   const input::BudgetStage& field) {
  return [=](Options& options) {
    for (const auto& set : {mechanics.set, field.set})
      if (set) set(options);
  };
}

/// A model's stage, with its entry.
template <class Entry>
struct Of {
  const Entry* entry;
  input::BudgetStage stage;
};

template <class Entry>
std::vector<Of<Entry>> stages_of(std::span<const Entry> entries, const Options& options) {
  std::vector<Of<Entry>> all;
  for (const Entry& entry : entries)
    if (entry.budget_stages)
      for (const input::BudgetStage& stage : entry.budget_stages(options))
        all.push_back({&entry, stage});
  return all;
}

using MechanicsStages = std::vector<Of<models::MechanicsEntry>>;
using FieldStages = std::vector<Of<models::FieldEntry>>;

Stage stage(const Of<models::MechanicsEntry>& mechanics, const Of<models::FieldEntry>& field) {
  return {mechanics.entry->id,
          field.entry->id,
          mechanics.stage.variant,
          field.stage.variant,
          both(mechanics.stage, field.stage),
          mechanics.stage.physics,
          field.stage.bears_differences};
}

/// The mechanics, with the field of the paper's model. The environment, which the paper leaves out,
/// comes at the first model that takes it.
std::vector<Stage> mechanics_stages(const input::Case& problem, const MechanicsStages& mechanics,
                                    const Of<models::FieldEntry>& field) {
  std::vector<Stage> plain;
  for (const auto& of : mechanics) plain.push_back(stage(of, field));
  plain.front().physics =
      fmt::format("the paper's model: {}, {}", plain.front().physics, field.stage.physics);
  bool is_empty = true;
  bool has_field = false;
  for (const Load& load : problem.load_path) {
    const surroundings::Environment& environment = load.environment();
    is_empty = is_empty && surroundings::is_empty(environment);
    has_field = has_field || !environment.magnets.empty() || !environment.uniform_field.isZero();
  }
  if (is_empty) return plain;
  const auto takes_it = [&](std::size_t i) {
    input::Case of_stage = problem;
    plain[i].set(of_stage.options);
    return models::fault_of(*mechanics[i].entry, of_stage).empty();
  };
  std::size_t first = 0;
  while (first + 1 < plain.size() && !takes_it(first)) ++first;
  std::vector<Stage> stages;
  for (std::size_t i = 0; i <= first; ++i) {
    stages.push_back(plain[i]);
    stages.back().around = Around::nothing;
  }
  plain[first].physics = "weight, fluid and fields around the cilium";
  stages.insert(stages.end(), plain.begin() + static_cast<std::ptrdiff_t>(first), plain.end());
  if (!has_field) return stages;
  Stage other = stages.back();
  other.around = Around::other_law;
  const bool is_F =
      problem.load_path.front().environment().magnetic_energy == surroundings::MagneticEnergy::F;
  stages.back().physics =
      is_F ? "the magnetic energy by F, in place of R" : "the magnetic energy by R, in place of F";
  stages.insert(stages.end() - 1, other);
  return stages;
}

}  // namespace

std::string Stage::mechanics_name() const {
  std::string name =
      mechanics_variant.empty() ? mechanics : fmt::format("{}, {}", mechanics, mechanics_variant);
  switch (around) {
    case Around::nothing:
      return name + " alone";
    case Around::other_law:
      return name + " by the other law";
    default:
      return name;
  }
}

std::string Chain::physics(std::size_t from, std::size_t to) const {
  std::vector<std::string> words;
  for (std::size_t i = from + 1; i <= to; ++i) words.push_back(stages[i].physics);
  return fmt::format("{}", fmt::join(words, "; "));
}

Chain make_chain(const input::Case& problem,
                 std::span<const models::MechanicsEntry> mechanics_entries,
                 std::span<const models::FieldEntry> field_entries,
                 const std::vector<std::string>& without) {
  const MechanicsStages of_mechanics = stages_of(mechanics_entries, problem.options);
  FieldStages of_fields = stages_of(field_entries, problem.options);
  const auto on_the_way = std::stable_partition(of_fields.begin(), of_fields.end(),
                                                [](const auto& of) { return !of.stage.is_beside; });
  const FieldStages of_beside(on_the_way, of_fields.end());
  of_fields.erase(on_the_way, of_fields.end());
  if (of_mechanics.empty() || of_fields.empty())
    throw InputError("no model says what it adds to the others: there is no budget");
  const std::vector<Stage> mechanics = mechanics_stages(problem, of_mechanics, of_fields.front());
  std::vector<Stage> all = mechanics;
  for (const auto& of : of_fields) all.push_back(stage(of_mechanics.front(), of));
  for (const auto& of : of_beside) all.push_back(stage(of_mechanics.front(), of));
  require_words(without, all);
  const auto is_left_out = [&](const std::string& word) {
    return std::ranges::find(without, word) != without.end();
  };
  const auto without_name = [](const Stage& stage, const std::string& missing) {
    return fmt::format("{}: without {}", stage.name(), missing);
  };
  Chain chain;
  const auto add = [&](const Stage& stage, const std::string& missing) {
    if (missing.empty())
      chain.stages.push_back(stage);
    else
      chain.not_run.push_back(without_name(stage, missing));
  };
  std::string left_out_body;  // the model whose body is missing
  const models::MechanicsEntry* best = nullptr;
  for (const Stage& stage : mechanics) {
    add(stage, is_left_out(stage.mechanics) ? stage.mechanics : "");
    const models::MechanicsEntry& entry = models::entry_of(mechanics_entries, stage.mechanics);
    if (entry.has_body && is_left_out(stage.mechanics)) left_out_body = stage.mechanics;
    if (is_left_out(stage.mechanics)) continue;
    chain.mechanics.push_back(stage);
    best = &entry;
  }
  const auto best_stage = std::ranges::find_if(of_mechanics.rbegin(), of_mechanics.rend(),
                                               [&](const auto& of) { return of.entry == best; });
  for (std::size_t i = 1; i < of_fields.size(); ++i) {
    Stage on_best = stage(*best_stage, of_fields[i]);
    on_best.physics = of_fields[i].stage.physics;
    on_best.around = chain.mechanics.back().around;
    const bool has_no_body = of_fields[i].entry->has_body && !best->has_body;
    add(on_best, is_left_out(on_best.field) ? on_best.field : has_no_body ? left_out_body : "");
  }
  for (const auto& of : of_beside) {
    Stage beside = stage(of_mechanics.front(), of);
    beside.physics = of.stage.physics;
    beside.around = mechanics.front().around;
    if (is_left_out(beside.field))
      chain.not_run.push_back(without_name(beside, beside.field));
    else
      chain.beside = beside;
  }
  if (is_left_out("sensitivity")) {
    for (Stage& stage : chain.stages) stage.sensitivity = false;
    if (chain.beside) chain.beside->sensitivity = false;
  }
  return chain;
}

}  // namespace ciliaval::compare::budget
