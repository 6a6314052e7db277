// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/sweep.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/models/registry.h"
#include "compare/output/json_file.h"
#include "problem/error.h"

namespace ciliaval::compare::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

}  // namespace

void make_folder(const fs::path& folder) {
  try {
    if (fs::is_symlink(folder))
      throw FileError(fmt::format(
          "`{}` is a link to `{}`, which may belong to something else: remove the link or choose "
          "another folder with -o DIR",
          folder.string(), fs::read_symlink(folder).string()));
    fs::create_directories(folder);
    if (!fs::exists(folder / store_name) && !fs::is_empty(folder))
      throw FileError(
          fmt::format("`{}` is not the folder of a study: it has other files in it; "
                      "move it away or choose another folder with -o DIR",
                      folder.string()));
  } catch (const fs::filesystem_error& error) {
    throw FileError(
        fmt::format("cannot write to the output folder `{}`: {}; choose another with "
                    "-o DIR",
                    folder.string(), error.code().message()));
  }
}

std::string to_bytes(const std::vector<PairResult>& results) {
  Json pairs = Json::array();
  for (const PairResult& result : results) {
    Json values = Json::array();
    for (const auto& value : result.values) values.push_back(output::or_null(value));
    pairs.push_back({static_cast<int>(result.status), result.message, std::move(values),
                     output::or_null(result.uncertainty), output::or_null(result.range_uncertainty),
                     output::or_null(result.model_uncertainty),
                     output::or_null(result.range_model_uncertainty)});
  }
  return pairs.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<PairResult> from_bytes(const std::string& bytes) {
  std::vector<PairResult> results;
  for (const Json& pair : output::parse_json(bytes, "the store of the study")) {
    PairResult& result = results.emplace_back();
    result.status = static_cast<Status>(pair.at(0).get<int>());
    result.message = pair.at(1).get<std::string>();
    for (const Json& value : pair.at(2)) result.values.push_back(output::number_or_none(value));
    result.uncertainty = output::number_or_none(pair.at(3));
    result.range_uncertainty = output::number_or_none(pair.at(4));
    result.model_uncertainty = output::number_or_none(pair.at(5));
    result.range_model_uncertainty = output::number_or_none(pair.at(6));
  }
  return results;
}

std::string Task::name() const {
  return fmt::format("{} at point {}", mechanics, point);
}

bool runs_in_threads(const Study& study, const std::string& mechanics,
                     std::span<const models::MechanicsEntry> mechanics_models,
                     std::span<const models::FieldEntry> field_models) {
  if (models::entry_of(mechanics_models, mechanics).is_collective) return false;
  return std::none_of(study.pairs.begin(), study.pairs.end(), [&](const ModelPair& pair) {
    return pair.mechanics == mechanics && models::entry_of(field_models, pair.field).is_collective;
  });
}

Tasks missing_tasks(const Study& study, const Solutions& solutions,
                    std::span<const models::MechanicsEntry> mechanics_models,
                    std::span<const models::FieldEntry> field_models) {
  Tasks missing;
  for (const std::string& mechanics : study.mechanics()) {
    std::vector<Task>& tasks = runs_in_threads(study, mechanics, mechanics_models, field_models)
                                   ? missing.side_by_side
                                   : missing.one_by_one;
    for (std::size_t point = 0; point < study.all_points(); ++point)
      if (Task task{point, mechanics}; solutions.find(task.name()) == nullptr)
        tasks.push_back(std::move(task));
  }
  return missing;
}

Solutions::Solutions(output::store::Store& store, const Study& study, const std::string& program)
    : store_(&store) {
  support::Fingerprint all = fingerprint(study);
  all.emplace_back("program", program);
  store.require_fingerprint(store_owner, all);
  for (const auto& [name, bytes] : store.read(store_owner)) all_.emplace(name, from_bytes(bytes));
}

const std::vector<PairResult>* Solutions::find(const std::string& name) const {
  const auto place = all_.find(name);
  return place != all_.end() ? &place->second : nullptr;
}

std::size_t Solutions::add(const std::string& name, std::vector<PairResult> results) {
  if (store_ != nullptr) store_->write(store_owner, {{name, to_bytes(results)}});
  const std::lock_guard guard(mutex_);
  all_.emplace(name, std::move(results));
  return all_.size();
}

StudyResult run_study(const Study& study, Solutions& solutions,
                      std::span<const models::MechanicsEntry> mechanics_models,
                      std::span<const models::FieldEntry> field_models, const Progress& progress) {
  const Tasks missing = missing_tasks(study, solutions, mechanics_models, field_models);
  const auto done = [&, all = study.all_points() * study.mechanics().size()](std::size_t solved) {
    return fmt::format("{}: {}/{} solved", study.name, solved, all);
  };
  const auto solve = [&](const Task& task, const Progress& inner) {
    const std::size_t solved =
        solutions.add(task.name(), evaluate(study, study.case_at(task.point), task.mechanics,
                                            mechanics_models, field_models, inner));
    if (progress) progress({done(solved), solved, study.all_points() * study.mechanics().size()});
  };
  // A grain of one: the solutions take different times.
  tbb::parallel_for(std::size_t{0}, missing.side_by_side.size(),
                    [&](std::size_t i) { solve(missing.side_by_side[i], {}); });
  for (const Task& task : missing.one_by_one) {
    const std::string at = study.describe(task.point);
    solve(task, of_a_piece(progress, fmt::format("{}, {}: ", done(solutions.size()), at)));
  }
  StudyResult result{study, {}};
  for (std::size_t point = 0; point < study.all_points(); ++point) {
    std::vector<PairResult>& pairs = result.points.emplace_back();
    for (std::size_t i = 0; i < study.pairs.size(); ++i)
      pairs.push_back(
          (*solutions.find(Task{point, study.pairs[i].mechanics}.name()))[study.place(i)]);
  }
  return result;
}

}  // namespace ciliaval::compare::study
