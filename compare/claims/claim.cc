// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/claims/claim.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/output/json_file.h"
#include "compare/output/text_table.h"

namespace ciliaval::compare::claims {
namespace {

using Json = nlohmann::ordered_json;

/// "6.1 to 7.9 %", "0.96"
std::string value_text(const Evidence& evidence) {
  const Span& values = evidence.values;
  const std::string low = fmt::format("{:.4g}", values.low);
  const std::string high = fmt::format("{:.4g}", values.high);
  std::string text = low == high ? low : low + " to " + high;
  if (values.uncertainty > 0) text += fmt::format(" +- {:.2g}", values.uncertainty);
  return evidence.unit.empty() ? text : text + " " + evidence.unit;
}

std::string_view holds_text(const std::optional<bool>& holds) {
  if (!holds) return "undecided";
  return *holds ? "yes" : "no";
}

}  // namespace

void Span::add(double value, double off) {
  low = std::min(low, value);
  high = std::max(high, value);
  uncertainty = std::max(uncertainty, off);
}

Evidence in_range(std::string models, const Span& values, std::string unit, double at_least,
                  double at_most) {
  const auto [low, high, off] = values;
  std::optional<bool> holds;
  if (low - off >= at_least && high + off <= at_most)
    holds = true;
  else if (!(low + off >= at_least && high - off <= at_most))
    holds = false;
  return {std::move(models), values, std::move(unit), holds};
}

std::string_view to_string(ClaimVerdict verdict) {
  constexpr std::array<std::string_view, 4> names{"reproduced", "not reproduced",
                                                  "depends on the model", "not checkable"};
  return names.at(static_cast<std::size_t>(verdict));
}

ClaimVerdict Claim::verdict() const {
  const auto count = [&](bool holds) {
    return std::count_if(evidence.begin(), evidence.end(),
                         [&](const Evidence& f) { return f.holds == holds; });
  };
  if (count(true) == 0 && count(false) == 0) return ClaimVerdict::not_checkable;
  if (count(false) == 0) return ClaimVerdict::reproduced;
  return count(true) == 0 ? ClaimVerdict::not_reproduced : ClaimVerdict::depends_on_the_model;
}

std::string claims_text(const std::vector<Claim>& claims) {
  std::string text;
  int counts[4] = {};
  for (const Claim& claim : claims) {
    ++counts[static_cast<int>(claim.verdict())];
    text +=
        fmt::format("{}: {}\n  -> {}\n", claim.place, claim.statement, to_string(claim.verdict()));
    output::TextRows rows;
    for (const Evidence& e : claim.evidence)
      rows.push_back({"  " + e.models, value_text(e), std::string(holds_text(e.holds))});
    text += output::text_table(rows, "<");
    if (!claim.note.empty()) text += fmt::format("     {}\n", claim.note);
    text += '\n';
  }
  return text + fmt::format(
                    "{} claims: {} reproduced, {} not reproduced, {} depend on the model, "
                    "{} not checkable\n",
                    claims.size(), counts[0], counts[1], counts[2], counts[3]);
}

std::string claims_json(const std::vector<Claim>& claims, const output::Provenance& provenance) {
  Json json{{"schema", 1}, {"provenance", to_json(provenance)}, {"claims", Json::array()}};
  for (const Claim& claim : claims) {
    Json entry{{"place", claim.place},
               {"statement", claim.statement},
               {"verdict", to_string(claim.verdict())},
               {"note", output::or_null(claim.note)},
               {"findings", Json::array()}};
    for (const Evidence& f : claim.evidence)
      entry["findings"].push_back({{"models", f.models},
                                   {"low", f.values.low},
                                   {"high", f.values.high},
                                   {"unit", f.unit},
                                   {"uncertainty", f.values.uncertainty},
                                   {"holds", f.holds ? Json(*f.holds) : Json(nullptr)}});
    json["claims"].push_back(std::move(entry));
  }
  return output::to_text(json);
}

}  // namespace ciliaval::compare::claims
