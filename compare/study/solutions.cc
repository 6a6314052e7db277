// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/solutions.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "compare/output/json_file.h"

namespace ciliaval::compare::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* owner = "study";

std::string to_bytes(const std::vector<PairResult>& results) {
  Json pairs = Json::array();
  for (const PairResult& result : results) {
    Json values = Json::array();
    for (const auto& value : result.values) values.push_back(output::or_null(value));
    pairs.push_back({static_cast<int>(result.status), result.message, std::move(values),
                     output::or_null(result.uncertainty)});
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
  }
  return results;
}

}  // namespace

Solutions::Solutions(output::store::Store& store, const Study& study, const std::string& program)
    : store_(&store) {
  support::Fingerprint all = fingerprint(study);
  all.emplace_back("program", program);
  store.require_fingerprint(owner, all);
  for (const auto& [name, bytes] : store.read(owner)) all_.emplace(name, from_bytes(bytes));
}

const std::vector<PairResult>* Solutions::find(const std::string& name) const {
  const auto place = all_.find(name);
  return place != all_.end() ? &place->second : nullptr;
}

std::size_t Solutions::add(const std::string& name, std::vector<PairResult> results) {
  if (store_ != nullptr) store_->write(owner, {{name, to_bytes(results)}});
  const std::lock_guard guard(mutex_);
  all_.emplace(name, std::move(results));
  return all_.size();
}

}  // namespace ciliaval::compare::study
