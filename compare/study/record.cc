// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/record.h"

#include <string>
#include <utility>

#include "compare/output/results.h"

namespace ciliaval::compare::study {
namespace {

using Json = nlohmann::ordered_json;

Status status_of(const std::string& text) {
  for (const Status status : {Status::converged, Status::slipped_off})
    if (output::to_string(status) == text) return status;
  return Status::failed;
}

std::optional<double> number(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional<double>(json.get<double>());
}

}  // namespace

Json to_json(const std::optional<double>& value) {
  return value ? Json(*value + 0.0) : Json(nullptr);
}

Json to_json(const std::vector<PairResult>& results) {
  Json pairs = Json::array();
  for (const PairResult& result : results) {
    Json values = Json::array();
    for (const auto& value : result.values) values.push_back(to_json(value));
    pairs.push_back({{"status", output::to_string(result.status)},
                     {"message", result.message},
                     {"values", std::move(values)},
                     {"uncertainty", to_json(result.uncertainty)}});
  }
  return pairs;
}

std::optional<std::vector<PairResult>> results_from(const Json& json, std::size_t outputs,
                                                    std::size_t pairs) {
  std::vector<PairResult> results;
  for (const Json& pair : json) {
    PairResult result{status_of(pair.at("status").get<std::string>()),
                      pair.at("message").get<std::string>(),
                      {},
                      number(pair.at("uncertainty"))};
    for (const Json& value : pair.at("values")) result.values.push_back(number(value));
    if (result.values.size() != outputs) return std::nullopt;
    results.push_back(std::move(result));
  }
  if (pairs == 0 || results.size() != pairs) return std::nullopt;
  return results;
}

}  // namespace ciliaval::compare::study
