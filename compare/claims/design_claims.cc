// SPDX-License-Identifier: LGPL-2.1-or-later
// What the paper says of its parameter studies (section 3.4, Fig. 4).
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "compare/claims/claim.h"
#include "compare/models/registry.h"
#include "compare/study/reader/study_reader.h"
#include "compare/study/summary/report.h"
#include "problem/error.h"

namespace ciliaval::compare::claims {
namespace {

using study::Output;
using study::StudyResult;
using study::summary::Trend;

/// A study with one output alone, at all its points.
StudyResult evaluated(study::Study study, Output output, const Progress& progress) {
  study.outputs = {output};
  study::Solutions in_memory;
  return run_study(study, in_memory, models::mechanics_models(), models::field_models(), progress);
}

/// The first and the last point that have a value: the values increase.
std::array<std::size_t, 2> ends(const StudyResult& result, std::size_t pair) {
  std::array<std::size_t, 2> found{result.points.size(), 0};
  for (std::size_t point = 0; point < result.points.size(); ++point)
    if (result.points[point][pair].values[0]) found = {std::min(found[0], point), point};
  return found;
}

/// The study at every second point.
StudyResult thinned(const StudyResult& result) {
  StudyResult thin{result.study, {}};
  std::vector<double>& values = thin.study.parameters.front().values;
  values.clear();
  for (std::size_t point = 0; point < result.points.size(); point += 2) {
    values.push_back(result.study.parameters.front().values[point]);
    thin.points.push_back(result.points[point]);
  }
  return thin;
}

/// |ΔB| of each pair from end to end of the parameter, and whether its trend is the one claimed.
template <class Holds>
void add_trends(const StudyResult& result, const Holds& holds, Claim& claim) {
  for (std::size_t pair = 0; pair < result.study.pairs.size(); ++pair) {
    const Trend trend = study::summary::trend(result, pair, 0);
    double off = 0;
    for (const std::size_t end : ends(result, pair))
      off = std::max(off, 1e6 * result.points[end][pair].uncertainty.value());
    claim.evidence.push_back({result.study.pairs[pair].name() + ": dB from end to end",
                              {1e6 * trend.first, 1e6 * trend.last, off},
                              "uT",
                              holds(trend)});
  }
}

/// Where each pair has its peak.
void add_peaks(const StudyResult& result, Claim& claim) {
  const StudyResult every_second = thinned(result);
  for (std::size_t pair = 0; pair < result.study.pairs.size(); ++pair) {
    const std::string name = result.study.pairs[pair].name();
    const Trend trend = study::summary::trend(result, pair, 0);
    if (trend.kind == Trend::Kind::peak)
      claim.evidence.push_back(in_range(
          name + ": peak at",
          {trend.extreme_at, trend.extreme_at,
           std::abs(study::summary::trend(every_second, pair, 0).extreme_at - trend.extreme_at)},
          "", 0.7, 0.9));
    else
      claim.evidence.push_back({name + ": no peak", {0, 0}, "", false});
  }
}

}  // namespace

std::vector<Claim> design_claims(const std::filesystem::path& folder, bool with_solid,
                                 const Progress& progress) {
  const auto run = [&](const char* name, Output output) {
    return evaluated(study::reader::read_study(folder / name), output, progress);
  };
  std::vector<Claim> claims;
  claims.push_back({"3.4.1, Fig. 4a", "the signal falls as E1 grows", {}, {}});
  add_trends(
      run("fig4a-e1.study.toml", Output::dB_norm),
      [](const Trend& t) { return t.kind == Trend::Kind::falling; }, claims.back());

  const StudyResult e2 = run("fig4a-e2.study.toml", Output::dB_norm);
  claims.push_back(
      {"3.4.1, Fig. 4a",
       "the signal |dB| grows with E2",
       "Below some 0.2 MPa the magnet bends so far that dB_x has the other sign, and |dB| falls "
       "first; above it grows (docs/evidence/studies.md). The paper's range of E2 is not given.",
       {}});
  add_trends(
      e2, [](const Trend& t) { return t.kind == Trend::Kind::rising; }, claims.back());
  const StudyResult e2_x = run("fig4a-e2.study.toml", Output::dB_x);
  claims.push_back({"3.4.1, Fig. 4a",
                    "dB_x grows with E2 and reaches a plateau",
                    "A plateau: 95 % of the change by half of the range.",
                    {}});
  const double middle = e2_x.study.parameters.front().values.back() / 2;
  add_trends(
      e2_x, [&](const Trend& t) { return t.kind == Trend::Kind::rising && t.settled_at < middle; },
      claims.back());

  claims.push_back({"3.4.2, Fig. 4b",
                    "the signal grows with the aspect ratio (thinner cilia)",
                    "Where the cilium bears the force at all: thinner ones slip off "
                    "(docs/evidence/studies.md).",
                    {}});
  add_trends(
      run("fig4b.study.toml", Output::dB_norm),
      [](const Trend& t) { return t.kind == Trend::Kind::falling; }, claims.back());

  claims.push_back({"3.4.3, Fig. 4c",
                    "the signal has its peak at L2/L0 = 0.7 to 0.9",
                    "+-: what it moves by with every second point of the study.",
                    {}});
  add_peaks(run("fig4c.study.toml", Output::dB_norm), claims.back());
  if (with_solid) {
    // About the peaks of the others: elsewhere the rods have shown that there is none.
    study::Study about_the_peak = study::reader::read_study(folder / "fig4c.study.toml");
    about_the_peak.pairs = {{"solid", "mesh"}};
    std::vector<double>& proportions = about_the_peak.parameters.front().values;
    proportions.clear();
    for (int percent = 84; percent <= 94; ++percent) proportions.push_back(percent / 100.0);
    add_peaks(evaluated(std::move(about_the_peak), Output::dB_norm, progress), claims.back());
  }
  return claims;
}

}  // namespace ciliaval::compare::claims
