// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/claims/claim.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/output/text_table.h"

namespace ciliaval::compare::claims {
namespace {

using Json = nlohmann::ordered_json;

/// "6.1 … 7.9 %", "0.96"
std::string value_text(const Finding& finding) {
  const std::string low = fmt::format("{:.4g}", finding.low);
  const std::string high = fmt::format("{:.4g}", finding.high);
  std::string text = low == high ? low : low + " to " + high;
  if (finding.uncertainty > 0) text += fmt::format(" +- {:.2g}", finding.uncertainty);
  return finding.unit.empty() ? text : text + " " + finding.unit;
}

std::string_view holds_text(const std::optional<bool>& holds) {
  if (!holds) return "undecided";
  return *holds ? "yes" : "no";
}

}  // namespace

Finding in_range(std::string models, double low, double high, std::string unit, double at_least,
                 double at_most, double uncertainty) {
  Finding finding{std::move(models), low, high, std::move(unit), uncertainty, std::nullopt};
  if (low - uncertainty >= at_least && high + uncertainty <= at_most)
    finding.holds = true;
  else if (!(low + uncertainty >= at_least && high - uncertainty <= at_most))
    finding.holds = false;
  return finding;
}

Finding judged(std::string models, double low, double high, std::string unit, bool holds) {
  return {std::move(models), low, high, std::move(unit), 0, holds};
}

std::string_view to_string(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::reproduced:
      return "reproduced";
    case ClaimVerdict::not_reproduced:
      return "not reproduced";
    case ClaimVerdict::depends_on_the_model:
      return "depends on the model";
    case ClaimVerdict::not_checkable:
      break;
  }
  return "not checkable";
}

ClaimVerdict Claim::verdict() const {
  const auto count = [&](bool holds) {
    return std::count_if(findings.begin(), findings.end(),
                         [&](const Finding& f) { return f.holds == holds; });
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
    for (const Finding& finding : claim.findings)
      rows.push_back(
          {"  " + finding.models, value_text(finding), std::string(holds_text(finding.holds))});
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
               {"note", claim.note.empty() ? Json(nullptr) : Json(claim.note)},
               {"findings", Json::array()}};
    for (const Finding& f : claim.findings)
      entry["findings"].push_back({{"models", f.models},
                                   {"low", f.low},
                                   {"high", f.high},
                                   {"unit", f.unit},
                                   {"uncertainty", f.uncertainty},
                                   {"holds", f.holds ? Json(*f.holds) : Json(nullptr)}});
    json["claims"].push_back(std::move(entry));
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace ciliaval::compare::claims
