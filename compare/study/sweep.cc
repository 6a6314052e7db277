// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/sweep.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "compare/study/record.h"

namespace ciliaval::compare::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr int journal_format = 1;

/// One mechanics model at one point.
struct Solution {
  std::size_t point = 0;
  std::string mechanics;
  bool operator<(const Solution& other) const {
    return std::tie(point, mechanics) < std::tie(other.point, other.mechanics);
  }
};

/// Whether the models of the study's pairs with this mechanics model may run in several threads
/// beside each other: rods and closed forms do; the solid, the potential (MPI) and CalculiX
/// use the cores themselves.
bool runs_in_threads(const Study& study, const std::string& mechanics) {
  if (mechanics != "elastica" && mechanics != "beam") return false;
  return std::none_of(study.pairs.begin(), study.pairs.end(), [&](const models::ModelPair& pair) {
    return pair.mechanics == mechanics && pair.field == "potential";
  });
}

std::size_t pair_count(const Study& study, const std::string& mechanics) {
  return static_cast<std::size_t>(
      std::count_if(study.pairs.begin(), study.pairs.end(),
                    [&](const models::ModelPair& pair) { return pair.mechanics == mechanics; }));
}

std::string to_record(const Solution& solution, const std::vector<PairResult>& results) {
  return Json{
      {"point", solution.point}, {"mechanics", solution.mechanics}, {"pairs", to_json(results)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// None if the record is not one of this study: its checksum was right, so another format's.
std::optional<std::pair<Solution, std::vector<PairResult>>> from_record(const Study& study,
                                                                        const std::string& text) {
  try {
    const Json json = Json::parse(text);
    const Solution solution{json.at("point").get<std::size_t>(),
                            json.at("mechanics").get<std::string>()};
    if (solution.point >= study.all_points()) return std::nullopt;
    auto results =
        results_from(json.at("pairs"), study.outputs.size(), pair_count(study, solution.mechanics));
    if (!results) return std::nullopt;
    return std::pair(solution, std::move(*results));
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

using Records = std::map<Solution, std::vector<PairResult>>;

Records records_of(const Study& study, const Journal& journal) {
  Records records;
  for (const std::string& text : journal.records())
    if (auto record = from_record(study, text)) records.insert(std::move(*record));
  return records;
}

/// The results of all mechanics models at a point in the order of the study's pairs.
std::vector<PairResult> in_order(const Study& study, std::size_t point, const Records& records) {
  std::vector<PairResult> results;
  std::map<std::string, std::size_t> next;
  for (const models::ModelPair& pair : study.pairs)
    results.push_back(records.at({point, pair.mechanics})[next[pair.mechanics]++]);
  return results;
}

}  // namespace

std::string journal_header(const Study& study, const std::string& program) {
  return Json{
      {"ciliaval study journal", journal_format}, {"program", program}, {"study", resolved(study)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string difference(const std::string& journal_header, const std::string& header) {
  if (journal_header == header) return {};
  const Json there = Json::parse(journal_header, nullptr, false);
  const Json here = Json::parse(header);
  if (!there.is_object() || !there.contains("study") || !there["study"].is_array() ||
      there.value("ciliaval study journal", 0) != journal_format)
    return "it is not a journal of this format";
  if (there.value("program", Json()) != here["program"])
    return fmt::format("it was written by another version, {}, this is {}",
                       there.value("program", Json()).dump(), here["program"].dump());
  const Json& old_lines = there["study"];
  const Json& new_lines = here["study"];
  const auto line = [](const Json& lines, std::size_t i) {
    if (i >= lines.size()) return std::string("nothing");
    const std::string text = lines[i].dump();
    constexpr std::size_t longest = 120;
    return text.size() <= longest ? text : text.substr(0, longest) + "...";
  };
  for (std::size_t i = 0; i < std::max(old_lines.size(), new_lines.size()); ++i)
    if (i >= old_lines.size() || i >= new_lines.size() || old_lines[i] != new_lines[i])
      return fmt::format("it is that of another study: it has {} where the study now has {}",
                         line(old_lines, i), line(new_lines, i));
  return "its first line differs";
}

Extent extent(const Study& study, const Journal& journal) {
  return {study.all_points() * study.mechanics().size(), records_of(study, journal).size()};
}

StudyResult run_study(const Study& study, Journal& journal,
                      std::span<const models::MechanicsEntry> mechanics_models,
                      std::span<const models::FieldEntry> field_models, const Progress& progress) {
  Records records = records_of(study, journal);
  std::vector<Solution> side_by_side;
  std::vector<Solution> one_by_one;
  for (const std::string& mechanics : study.mechanics())
    for (std::size_t point = 0; point < study.all_points(); ++point)
      if (!records.contains({point, mechanics}))
        (runs_in_threads(study, mechanics) ? side_by_side : one_by_one)
            .push_back({point, mechanics});

  const std::size_t all = study.all_points() * study.mechanics().size();
  std::mutex mutex;
  const auto solve = [&](const Solution& solution, const Progress& inner) {
    auto results = evaluate(study, study.case_at(solution.point), solution.mechanics,
                            mechanics_models, field_models, inner);
    journal.append(to_record(solution, results));
    const std::lock_guard guard(mutex);
    records.emplace(solution, std::move(results));
    if (progress) progress(fmt::format("{}: {}/{} solved", study.name, records.size(), all));
  };
  // A grain of one: the solutions take different times.
  tbb::parallel_for(std::size_t{0}, side_by_side.size(),
                    [&](std::size_t i) { solve(side_by_side[i], {}); });
  for (const Solution& solution : one_by_one) {
    Progress inner;
    if (progress)
      inner = [&](const std::string& text) {
        progress(fmt::format("{}: {}/{} solved, {}: {}", study.name, records.size(), all,
                             study.describe(solution.point), text));
      };
    solve(solution, inner);
  }
  journal.flush();
  StudyResult result{study, {}};
  for (std::size_t point = 0; point < study.all_points(); ++point)
    result.points.push_back(in_order(study, point, records));
  return result;
}

}  // namespace ciliaval::compare::study
