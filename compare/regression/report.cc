// SPDX-License-Identifier: LGPL-2.1-or-later
// The findings as text, JSON and JUnit's XML.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "compare/output/json_file.h"
#include "compare/regression/check.h"

namespace ciliaval::compare::regression {
namespace {

using Json = nlohmann::ordered_json;
using Tree = boost::property_tree::ptree;

/// The numbers of a finding, in its unit.
constexpr std::array<std::pair<const char*, std::optional<double> Finding::*>, 4> numbers{
    {{"measured", &Finding::measured},
     {"expected", &Finding::expected},
     {"limit", &Finding::limit},
     {"uncertainty", &Finding::uncertainty}}};

bool all_passed(const std::vector<CheckReport>& reports) {
  return std::all_of(reports.begin(), reports.end(),
                     [](const CheckReport& report) { return report.passed(); });
}

Json finding_json(const Finding& f) {
  Json json{{"id", f.id},
            {"against", f.against},
            {"passed", f.passed},
            {"message", output::or_null(f.message)},
            {"unit", output::or_null(f.unit)}};
  for (const auto& [name, number] : numbers) json[name] = output::or_null(f.*number);
  return json;
}

Tree test_case(const CheckReport& report, const Finding& finding) {
  Tree node;
  node.put("<xmlattr>.classname", report.case_name);
  node.put("<xmlattr>.name", fmt::format("{} against {}", finding.id, finding.against));
  Tree properties;
  for (const auto& [name, number] : numbers) {
    if (!(finding.*number)) continue;
    Tree& property = properties.add("property", "");
    property.put("<xmlattr>.name",
                 fmt::format("{}{}{}", name, finding.unit.empty() ? "" : ", ", finding.unit));
    property.put("<xmlattr>.value", fmt::format("{}", *(finding.*number)));
  }
  if (!properties.empty()) node.add_child("properties", properties);
  if (!finding.passed) node.put("failure.<xmlattr>.message", finding.message);
  return node;
}

}  // namespace

std::string report_text(const std::vector<CheckReport>& reports) {
  std::string text;
  std::size_t compared = 0;
  std::size_t failures = 0;
  for (const CheckReport& report : reports) {
    compared += report.compared();
    failures += report.failures();
    text +=
        fmt::format("{:<16} {}, {} numbers compared, {} failures{}\n", report.case_name,
                    report.passed() ? "passed" : "FAILED", report.compared(), report.failures(),
                    report.left_out > 0
                        ? fmt::format(", {} entries of models that were left out", report.left_out)
                        : "");
    for (const Finding& finding : report.findings)
      if (!finding.passed)
        text += fmt::format("  {} ({}): {}\n", finding.id, finding.against, finding.message);
  }
  return text + fmt::format("{}: {} cases, {} numbers compared, {} failures\n",
                            all_passed(reports) ? "Passed" : "FAILED", reports.size(), compared,
                            failures);
}

std::string report_json(const std::vector<CheckReport>& reports) {
  Json json{{"schema", 1}, {"passed", all_passed(reports)}, {"cases", Json::array()}};
  for (const CheckReport& report : reports) {
    Json entry{{"case", report.case_name},      {"passed", report.passed()},
               {"compared", report.compared()}, {"failures", report.failures()},
               {"left_out", report.left_out},   {"findings", Json::array()}};
    for (const Finding& finding : report.findings)
      entry["findings"].push_back(finding_json(finding));
    json["cases"].push_back(std::move(entry));
  }
  return output::to_text(json);
}

std::string report_junit(const std::vector<CheckReport>& reports) {
  Tree root;
  Tree& suites = root.add_child("testsuites", Tree());
  for (const CheckReport& report : reports) {
    Tree& suite = suites.add_child("testsuite", Tree());
    suite.put("<xmlattr>.name", report.case_name);
    suite.put("<xmlattr>.tests", report.findings.size());
    suite.put("<xmlattr>.failures", report.failures());
    suite.put("<xmlattr>.time", fmt::format("{:.3f}", report.seconds));
    for (const Finding& finding : report.findings)
      suite.add_child("testcase", test_case(report, finding));
  }
  std::ostringstream text;
  boost::property_tree::write_xml(text, root);
  return text.str() + '\n';
}

}  // namespace ciliaval::compare::regression
