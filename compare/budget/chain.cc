// SPDX-License-Identifier: LGPL-2.1-or-later
// The models on the way from the paper's to the best one.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "analytic/body/mesh_field.h"
#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "compare/budget/budget.h"
#include "fem/beam/beam.h"
#include "fem/potential/potential.h"
#include "problem/error.h"
#include "problem/support/words.h"
#include "problem/surroundings/plane.h"

namespace ciliaval::compare::budget {
namespace {

using analytic::sources::PushForward;
using fem::potential::PotentialOptions;
using Set = std::function<void(input::ModelOptions&)>;

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

/// Sets one option of a field model.
template <class Options, class Value>
Set set(Value Options::*option, Value value) {
  return [=](input::ModelOptions& options) { options.of<Options>().*option = value; };
}

Set set_potential(double relative_permeability, bool plates) {
  return [=](input::ModelOptions& options) {
    auto& potential = options.of<PotentialOptions>();
    potential.push_forward = fem::potential::MagnetPushForward::F;
    potential.relative_permeability = relative_permeability;
    if (!plates) potential.plates.clear();
  };
}

/// The mechanics, with dipoles along the centreline. What is around the cilium, which the paper
/// leaves out, comes at the elastica or, where it does not take it, at the beam.
std::vector<Stage> mechanics_stages(const input::Case& problem) {
  const Set line = set(&analytic::rod::LineOptions::push_forward, PushForward::F);
  const std::string_view around = "weight, fluid and fields around the cilium";
  const Stage elastica{"elastica", "line", "", line, ""};
  const Stage beam{"beam", "line", "", line, "shear and extension of the rod"};
  const Stage solid{
      "solid", "line", "", line,
      "three dimensions: bonded ends, near-incompressibility, a contact of some width"};
  std::vector<Stage> corrected;
  if (problem.options.of<fem::beam::BeamOptions>().joints == joints::Correction::corrected) {
    corrected.push_back(beam);
    corrected.front().joints = true;
    corrected.front().physics = "joints as stiff as bonded sections make them";
  }
  const auto with = [](Stage stage, Around what, std::string_view physics) {
    stage.around = what;
    if (!physics.empty()) stage.physics = physics;
    return stage;
  };
  bool is_empty = true;
  bool has_field = false;
  bool is_for_the_beam = false;  // magnets, or out of the plane of the load
  for (const Load& load : problem.load_path) {
    const surroundings::Environment& environment = load.environment();
    is_empty = is_empty && surroundings::is_empty(environment);
    const bool has_magnets = !environment.magnets.empty();
    is_for_the_beam = is_for_the_beam || has_magnets ||
                      !surroundings::lies_in_plane(environment, problem.cilium, direction(load));
    has_field = has_field || has_magnets || !environment.uniform_field.isZero();
  }
  if (is_empty) {
    std::vector<Stage> stages{elastica, beam};
    stages.insert(stages.end(), corrected.begin(), corrected.end());
    stages.push_back(solid);
    return stages;
  }
  std::vector<Stage> stages{with(elastica, Around::nothing, "")};
  if (is_for_the_beam)
    stages.push_back(with(beam, Around::nothing, ""));
  else
    stages.push_back(with(elastica, Around::all, around));
  stages.push_back(is_for_the_beam ? with(beam, Around::all, around) : beam);
  stages.insert(stages.end(), corrected.begin(), corrected.end());
  if (has_field) {
    const bool is_F =
        problem.load_path.front().environment().magnetic_energy == surroundings::MagneticEnergy::F;
    stages.push_back(with(solid, Around::other_law, ""));
    stages.push_back(with(solid, Around::all,
                          is_F ? "the magnetic energy by F, in place of R"
                               : "the magnetic energy by R, in place of F"));
  } else {
    stages.push_back(solid);
  }
  return stages;
}

/// The fields on the best mechanics.
std::vector<Stage> field_stages(const input::Case& problem, const std::string& mechanics) {
  using analytic::body::MeshOptions;
  using analytic::rod::VolumeOptions;
  std::vector<Stage> stages{
      {mechanics, "volume", "stacked", set(&VolumeOptions::slices, VolumeOptions::Slices::stacked),
       "the magnet's thickness, in flat slices (Eq. 8-9)"},
      {mechanics, "volume", "wedge", set(&VolumeOptions::slices, VolumeOptions::Slices::wedge),
       "wedges in place of flat slices: Jacobian 1 - kappa*offset"},
      {mechanics, "mesh", "R", set(&MeshOptions::push_forward, PushForward::R),
       "the solid's own sections, warped and stretched, with rotated moments"},
      {mechanics, "mesh", "F", set(&MeshOptions::push_forward, PushForward::F),
       "moments carried along by F, in place of the rotation R"},
      {mechanics, "potential", "mu_r = 1", set_potential(1, false),
       "the same physics by another method: a potential by finite elements", false}};
  const auto& potential = problem.options.of<PotentialOptions>();
  const std::string permeability = fmt::format("mu_r = {:g}", potential.relative_permeability);
  if (potential.relative_permeability != 1)
    stages.push_back({mechanics, "potential", permeability,
                      set_potential(potential.relative_permeability, false),
                      "recoil permeability of the magnet", false});
  if (!potential.plates.empty())
    stages.push_back({mechanics, "potential", permeability + ", plates",
                      set_potential(potential.relative_permeability, true), "permeable plates",
                      false});
  return stages;
}

}  // namespace

input::ModelOptions mechanics_options(const Stage& stage, input::ModelOptions options) {
  const auto joints = stage.joints ? joints::Correction::corrected : joints::Correction::none;
  options.of<fem::beam::BeamOptions>().joints = joints;
  options.of<analytic::elastica::ElasticaOptions>().joints = joints;
  return options;
}

std::string Stage::mechanics_name() const {
  if (joints) return mechanics + ", joints corrected";
  switch (around) {
    case Around::nothing:
      return mechanics + " alone";
    case Around::other_law:
      return mechanics + " by the other law";
    default:
      return mechanics;
  }
}

std::string Chain::physics(std::size_t from, std::size_t to) const {
  std::vector<std::string> words;
  for (std::size_t i = from + 1; i <= to; ++i) words.push_back(stages[i].physics);
  return fmt::format("{}", fmt::join(words, "; "));
}

Chain make_chain(const input::Case& problem, const std::vector<std::string>& without) {
  const std::vector<Stage> mechanics = mechanics_stages(problem);
  const std::string paper = mechanics.front().mechanics;
  Stage beside{paper, "dipole", "", [](input::ModelOptions&) {},
               "the whole magnet as one dipole at its centroid"};
  beside.around = mechanics.front().around;
  std::vector<Stage> all = mechanics;
  for (const Stage& stage : field_stages(problem, paper)) all.push_back(stage);
  all.push_back(beside);
  require_words(without, all);
  const auto is_left_out = [&](const std::string& word) {
    return std::ranges::find(without, word) != without.end();
  };
  Chain chain;
  const auto add = [&](const Stage& stage, const std::string& missing) {
    if (missing.empty())
      chain.stages.push_back(stage);
    else
      chain.not_run.push_back(fmt::format("{}: without {}", stage.name(), missing));
  };
  for (const Stage& stage : mechanics) {
    add(stage, is_left_out(stage.mechanics) ? stage.mechanics : "");
    if (!is_left_out(stage.mechanics)) chain.mechanics.push_back(stage);
  }
  const std::string best = chain.mechanics.back().mechanics;
  for (Stage& stage : field_stages(problem, best)) {
    stage.joints = chain.mechanics.back().joints;
    add(stage, is_left_out(stage.field)                   ? stage.field
               : stage.field == "mesh" && best != "solid" ? "solid"
                                                          : "");
  }
  if (is_left_out(beside.field))
    chain.not_run.push_back(fmt::format("{}: without {}", beside.name(), beside.field));
  else
    chain.beside = beside;
  if (is_left_out("sensitivity")) {
    for (Stage& stage : chain.stages) stage.sensitivity = false;
    if (chain.beside) chain.beside->sensitivity = false;
  }
  return chain;
}

}  // namespace ciliaval::compare::budget
