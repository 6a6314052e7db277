// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/regression/baseline.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "compare/input/case_sections.h"
#include "compare/models/registry.h"
#include "compare/output/json_file.h"
#include "problem/error.h"

namespace ciliaval::compare::regression {
namespace {

using Json = nlohmann::ordered_json;

/// A tolerance beyond this part of a value's size tells nothing.
constexpr double widest = 0.1;

/// Reads the members of a JSON object, each once; what was not read is a fault.
class Reader {
 public:
  Reader(const Json& json, std::string file, std::string where)
      : json_(json), file_(std::move(file)), where_(std::move(where)) {
    if (!json_.is_object()) fail("must be an object");
  }

  const Json& get(const char* key) {
    read_.insert(key);
    if (!json_.contains(key)) fail(fmt::format("`{}` is missing", key));
    return json_.at(key);
  }
  std::string text(const char* key) {
    const Json& value = get(key);
    if (!value.is_string()) fail(fmt::format("`{}` must be a text", key));
    if (value.get<std::string>().empty()) fail(fmt::format("`{}` is empty", key));
    return value.get<std::string>();
  }
  double number(const char* key) {
    const Json& value = get(key);
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail(fmt::format("`{}` must be a finite number", key));
    return value.get<double>();
  }
  std::optional<double> number_or_null(const char* key) {
    if (get(key).is_null()) return std::nullopt;
    return number(key);
  }
  const Json& list(const char* key) {
    const Json& value = get(key);
    if (!value.is_array()) fail(fmt::format("`{}` must be a list", key));
    return value;
  }
  /// To be called when all has been read.
  void finish() const {
    for (const auto& [key, value] : json_.items())
      if (!read_.contains(key))
        fail(fmt::format("`{}` is no key here: nothing would read it", key));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}: {}", file_, where_, what));
  }

 private:
  const Json& json_;
  std::string file_;
  std::string where_;
  std::set<std::string> read_;
};

AllowedDeviation read_allowed(Reader& reader, double value) {
  const AllowedDeviation tolerance{reader.number("relative"), reader.number("absolute")};
  if (tolerance.relative < 0 || tolerance.absolute < 0 || tolerance.limit(value, value) <= 0)
    reader.fail("`relative` and `absolute` must not be negative, nor both without effect");
  if (tolerance.relative > widest)
    reader.fail(fmt::format("a `relative` tolerance above {} checks nothing", widest));
  return tolerance;
}

Expected read_expected(const Json& json, const std::string& file) {
  const std::string id =
      json.is_object() && json.contains("id") && json["id"].is_string() ? json["id"] : "";
  Reader reader(json, file, id.empty() ? "quantities" : id);
  Expected expected;
  expected.id = reader.text("id");
  expected.unit = reader.text("unit");
  expected.value = reader.number("value");
  expected.allowed = read_allowed(reader, expected.value);
  if (expected.allowed.relative == 0 || expected.allowed.absolute == 0)
    reader.fail("`relative` and `absolute` must be positive: rounding differs between machines");
  if (json.contains("reference")) {
    Reader from(reader.get("reference"), file, id + "/reference");
    Reference reference{from.text("label"), from.number("value"), {}};
    reference.allowed = read_allowed(from, reference.value);
    from.finish();
    expected.reference = reference;
  }
  reader.finish();
  return expected;
}

output::Provenance read_origin(const Json& json, const std::string& file) {
  Reader reader(json, file, "origin");
  output::Provenance origin;
  origin.version = reader.text("version");
  origin.git = reader.text("git");
  origin.command = reader.text("command");
  origin.date = reader.text("date");
  for (const auto& [name, version] : reader.get("libraries").items())
    origin.libraries[name] = version.get<std::string>();
  reader.finish();
  return origin;
}

template <class List>
void require_unique_ids(const List& entries, const Reader& reader) {
  std::set<std::string> ids;
  for (const auto& entry : entries)
    if (!ids.insert(entry.id).second) reader.fail(fmt::format("`{}` is there twice", entry.id));
}

Baseline from_json(const Json& json, const std::string& file) try {
  Reader reader(json, file, "baseline");
  if (reader.number("schema") != 1) reader.fail("`schema` must be 1");
  Baseline baseline;
  baseline.case_name = reader.text("case");
  for (const Json& line : reader.list("case_text"))
    baseline.case_text.push_back(line.get<std::string>());
  baseline.origin = read_origin(reader.get("origin"), file);
  for (const Json& entry : reader.list("changes")) {
    Reader change(entry, file, "changes");
    baseline.changes.push_back(
        {change.text("id"), change.number_or_null("old"), change.number_or_null("new")});
    change.finish();
  }
  for (const Json& entry : reader.list("outcomes")) {
    Reader outcome(entry, file, "outcomes");
    baseline.outcomes.push_back({outcome.text("id"), outcome.text("value")});
    outcome.finish();
  }
  for (const Json& entry : reader.list("quantities"))
    baseline.quantities.push_back(read_expected(entry, file));
  reader.finish();
  require_unique_ids(baseline.quantities, reader);
  require_unique_ids(baseline.outcomes, reader);
  return baseline;
} catch (const Json::exception& error) {
  throw InputError(fmt::format("{}: not a baseline: {}", file, error.what()));
}

Json with_allowed(Json json, const AllowedDeviation& tolerance) {
  json["relative"] = tolerance.relative;
  json["absolute"] = tolerance.absolute;
  return json;
}

/// A list with a line for each element.
std::string lines(const std::vector<Json>& elements) {
  std::string text = "[";
  for (std::size_t i = 0; i < elements.size(); ++i)
    text += (i == 0 ? "\n  " : ",\n  ") + elements[i].dump();
  return text + "\n ]";
}

/// The part of its scale to which a number of a model is the same on any machine.
double accuracy_class(const std::string& model) {
  double accuracy = 1e-10;
  models::known().for_each([&](const auto& entry) {
    if (entry.id == model) accuracy = entry.accuracy;
  });
  return accuracy;
}

}  // namespace

double AllowedDeviation::limit(double a, double b) const {
  return std::max(relative * std::max(std::abs(a), std::abs(b)), absolute);
}

std::filesystem::path baseline_path(const std::filesystem::path& case_file) {
  return case_file.parent_path() / (case_file.stem().string() + ".baseline.json");
}

std::vector<std::string> case_text(const input::Case& problem) {
  input::Case portable = problem;
  input::change_files(models::known(), portable,
                      [](input::Option::File kind, std::filesystem::path& file) {
                        file = kind == input::Option::File::folder ? "" : file.filename();
                      });
  std::istringstream text(input::to_toml(portable, models::known()));
  const auto used = [&](const std::string& model) {
    const auto among = [&](const std::vector<std::string>& ids) {
      return std::find(ids.begin(), ids.end(), model) != ids.end();
    };
    return model == "external" || among(problem.mechanics) || among(problem.fields);
  };
  std::vector<std::string> result;
  bool kept = true;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with('[')) {
      const auto begin = line.find_first_not_of('[');
      kept = line.find("models.") != begin ||
             used(line.substr(begin + 7, line.find_first_of(".]", begin + 7) - begin - 7));
    }
    if (kept && !line.empty()) result.push_back(line);
  }
  return result;
}

Baseline read_baseline(std::string_view text, std::string_view file) {
  return from_json(output::parse_json(text, file), std::string(file));
}

Baseline read_baseline(const std::filesystem::path& file) {
  return from_json(output::read_json(file, "baseline"), file.string());
}

std::string to_json(const Baseline& baseline) {
  std::vector<Json> changed;
  for (const Change& c : baseline.changes)
    changed.push_back({{"id", c.id},
                       {"old", output::or_null(c.old_value)},
                       {"new", output::or_null(c.new_value)}});
  std::vector<Json> outcomes;
  for (const Outcome& o : baseline.outcomes) outcomes.push_back({{"id", o.id}, {"value", o.value}});
  std::vector<Json> quantities;
  for (const Expected& q : baseline.quantities) {
    Json json = with_allowed({{"id", q.id}, {"unit", q.unit}, {"value", q.value}}, q.allowed);
    if (q.reference)
      json["reference"] = with_allowed(
          {{"label", q.reference->label}, {"value", q.reference->value}}, q.reference->allowed);
    quantities.push_back(std::move(json));
  }
  const std::vector<Json> text(baseline.case_text.begin(), baseline.case_text.end());
  return fmt::format(
      "{{\n \"schema\": 1,\n \"case\": {},\n \"case_text\": {},\n \"origin\": {},\n \"changes\": "
      "{},\n \"outcomes\": {},\n \"quantities\": {}\n}}\n",
      Json(baseline.case_name).dump(), lines(text), output::to_json(baseline.origin).dump(),
      lines(changed), lines(outcomes), lines(quantities));
}

AllowedDeviation allowed_deviation(const results::Observation& quantity) {
  const double part = quantity.is_estimate ? 1e-10
                                           : std::max(accuracy_class(quantity.mechanics),
                                                      accuracy_class(quantity.field));
  // Two digits, so that rounding of the group does not show in the file.
  return {quantity.is_estimate ? 1e-3 : part,
          std::stod(fmt::format("{:.1e}", part * quantity.size()))};
}

Baseline make_baseline(const input::Case& problem, const Measurements& measured,
                       const output::Provenance& origin, const Baseline* old) {
  Baseline baseline{problem.name, case_text(problem), origin, {}, {}, measured.outcomes};
  for (const Outcome& outcome : measured.outcomes)
    if (outcome.value == "failed")
      throw SolverError(fmt::format("case \"{}\": `{}` is \"failed\": that is no baseline",
                                    problem.name, outcome.id));
  std::map<std::string, Expected> before;
  if (old != nullptr)
    for (const Expected& expected : old->quantities) before[expected.id] = expected;
  for (const results::Observation& q : measured.quantities) {
    const std::string id = q.id();
    if (!std::isfinite(q.value))
      throw SolverError(
          fmt::format("case \"{}\": `{}` is not finite: that is no baseline", problem.name, id));
    Expected expected{id, q.unit, q.value, allowed_deviation(q), {}};
    std::optional<double> old_value;
    if (const auto then = before.extract(id)) {
      old_value = then.mapped().value;
      expected.reference = then.mapped().reference;
      // Rounding is no change, and does not add up from baseline to baseline.
      if (std::abs(q.value - *old_value) <= then.mapped().allowed.limit(q.value, *old_value))
        expected.value = *old_value;
    }
    if (old != nullptr && old_value != expected.value)
      baseline.changes.push_back({id, old_value, expected.value});
    baseline.quantities.push_back(std::move(expected));
  }
  for (const auto& [id, expected] : before)
    baseline.changes.push_back({id, expected.value, std::nullopt});
  if (baseline.quantities.empty())
    throw SolverError(
        fmt::format("case \"{}\" gives no quantity: that is no baseline", problem.name));
  return baseline;
}

}  // namespace ciliaval::compare::regression
