// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/report/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "compare/output/json_file.h"
#include "compare/report/pictures.h"
#include "compare/report/sections.h"
#include "problem/error.h"

namespace ciliaval::compare::report {
namespace {

namespace fs = std::filesystem;

/// In the order of the page.
enum class Kind { run, study, budget, convergence, bench, readings, claims, check };

struct Document {
  fs::path file;
  Kind kind = Kind::run;
  Json json;
  std::string name;  ///< of the case or study; empty if it has none
};

/// Throws Error if the file is no JSON or not that of a result.
Document parse(const fs::path& file) {
  Document document;
  document.file = file;
  document.json = output::read_json(file, "result");
  const Json& json = document.json;
  const auto has = [&](std::initializer_list<const char*> keys) {
    return json.is_object() && json.contains("schema") &&
           std::all_of(keys.begin(), keys.end(),
                       [&](const char* key) { return json.contains(key); });
  };
  if (has({"steps", "comparisons"}))
    document.kind = Kind::run;
  else if (has({"study", "points"}))
    document.kind = Kind::study;
  else if (has({"chain", "rows"}))
    document.kind = Kind::budget;
  else if (has({"case", "studies"}))
    document.kind = Kind::convergence;
  else if (has({"sources", "by_magnitude"}))
    document.kind = Kind::bench;
  else if (has({"samples", "noise"}))
    document.kind = Kind::readings;
  else if (has({"claims"}))
    document.kind = Kind::claims;
  else if (has({"passed", "cases"}))
    document.kind = Kind::check;
  else
    throw FileError(file.string() + ": it is not a result of `ciliaval`; move it away");
  try {
    document.name = text_at(json, document.kind == Kind::study ? "study" : "case");
  } catch (const Json::exception& error) {
    throw FileError(fmt::format("{}: it is damaged: {}", file.string(), error.what()));
  }
  return document;
}

std::string title_of(const Document& document) {
  const std::string title = text_at(document.json, "title");
  switch (document.kind) {
    case Kind::run:
      return fmt::format("Case {}{}{}", document.name, title.empty() ? "" : ": ", title);
    case Kind::study:
      return fmt::format("Study {}{}{}", document.name, title.empty() ? "" : ": ", title);
    case Kind::budget:
      return "Error budget of " + document.name;
    case Kind::convergence:
      return "Convergence of " + document.name;
    case Kind::bench:
      return "Simulated test bench: " + title;
    case Kind::readings:
      return "Loads from readings, case " + document.name;
    case Kind::claims:
      return "The paper's claims";
    case Kind::check:
      break;
  }
  return "Regression check";
}

std::string content_of(const Document& document, Figures& figures) {
  switch (document.kind) {
    case Kind::run:
      return case_content(document.json, document.file.parent_path(), figures);
    case Kind::study:
      return study_content(document.json, figures);
    case Kind::budget:
      return budget_content(document.json, figures);
    case Kind::convergence:
      return convergence_content(document.json, figures);
    case Kind::bench:
      return bench_content(document.json, figures);
    case Kind::readings:
      return readings_content(document.json);
    case Kind::claims:
      return claims_content(document.json);
    case Kind::check:
      break;
  }
  return check_content(document.json);
}

/// Throws FileError if the file is damaged.
Section section_of(const Document& document, const std::string& id, Figures& figures) {
  try {
    // What the overview and the table of origins will read.
    if (document.kind == Kind::run) case_row(document.json);
    provenance_cells(document.json);
    libraries_text(document.json);
    return {id, title_of(document), content_of(document, figures)};
  } catch (const Json::exception& error) {
    throw FileError(fmt::format("{}: it is damaged: {}", document.file.string(), error.what()));
  } catch (const Error& error) {
    throw FileError(fmt::format("{}: it is damaged: {}", document.file.string(), error.what()));
  }
}

/// The JSON files of a folder and of the folders in it, sorted; hidden ones are unfinished.
std::vector<fs::path> json_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (auto it = fs::recursive_directory_iterator(folder); it != fs::recursive_directory_iterator();
       ++it) {
    if (it->path().filename().string().starts_with('.')) {
      if (it->is_directory()) it.disable_recursion_pending();
      continue;
    }
    if (it.depth() >= 1 && it->is_directory()) it.disable_recursion_pending();
    if (it->is_regular_file() && it->path().extension() == ".json") files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_of_figure_4(const Document& document) {
  return document.kind == Kind::study && document.name.starts_with("fig4");
}

/// What the page would show, had these commands been given.
std::vector<std::string> missing(const std::vector<Document>& documents, bool pictures,
                                 const std::string& folder) {
  std::vector<std::string> lines;
  const auto there = [&](Kind kind, const std::string& name) {
    return std::any_of(documents.begin(), documents.end(), [&](const Document& d) {
      return d.kind == kind && (name.empty() || d.name == name);
    });
  };
  const auto need = [&](bool found, const std::string& what, const std::string& command) {
    if (!found) lines.push_back(fmt::format("{}: {}", what, command));
  };
  need(there(Kind::run, ""), "No case", fmt::format("ciliaval run CASE.toml -o {}", folder));
  for (const char* name : {"fig4a-e1", "fig4a-e2", "fig4b", "fig4c"})
    need(there(Kind::study, name), fmt::format("No study {}", name),
         fmt::format("ciliaval study cases/paper/{}.study.toml -o {}", name, folder));
  need(there(Kind::budget, ""), "No error budget",
       fmt::format("ciliaval budget CASE.toml --json {}/NAME.budget.json", folder));
  need(there(Kind::convergence, ""), "No convergence study",
       fmt::format("ciliaval converge CASE.toml --json {}/NAME.converge.json", folder));
  need(there(Kind::bench, "") || there(Kind::readings, ""), "No loads from readings",
       fmt::format("ciliaval sense BENCH.sense.toml --json {}/NAME.sense.json", folder));
  need(there(Kind::claims, ""), "No ledger of the paper's claims",
       fmt::format("ciliaval claims --json {}/claims.json", folder));
  need(pictures, "No pictures",
       fmt::format("pvpython {0}/CASE/vtk/open.py {0}/pictures/NAME.png", folder));
  return lines;
}

/// Says so if the results are of different states of the program.
std::string origins(const std::vector<Document>& documents, const fs::path& folder) {
  Table table{"Which program made which file, when and how", {"file"}, {}};
  const std::vector<std::string> columns = provenance_columns();
  table.head.insert(table.head.end(), columns.begin(), columns.end());
  std::set<std::string> states;
  std::set<std::string> libraries;
  for (const Document& document : documents) {
    std::vector<Cell> row{document.file.lexically_relative(folder).string()};
    for (Cell& cell : provenance_cells(document.json)) row.push_back(std::move(cell));
    const Json& origin = at_or_null(document.json, "provenance");
    if (!origin.is_null()) states.insert(text_at(origin, "git"));
    if (!origin.is_null()) libraries.insert(libraries_text(document.json));
    table.rows.push_back(std::move(row));
  }
  std::string text;
  if (states.size() > 1)
    text += paragraph(
        fmt::format("The files come from {} different states of the program: their numbers need "
                    "not belong together.",
                    states.size()),
        "bad");
  text += html(table);
  for (const std::string& line : libraries) text += paragraph(line);
  return text;
}

Section overview(const std::vector<Document>& documents, const std::vector<Section>& sections) {
  Table table{"The cases", {"case"}, {}};
  const std::vector<std::string> columns = case_columns();
  table.head.insert(table.head.end(), columns.begin(), columns.end());
  for (std::size_t i = 0; i < documents.size(); ++i) {
    if (documents[i].kind != Kind::run) continue;
    Cell name(documents[i].name);
    name.link = sections[i].id;
    std::vector<Cell> row{std::move(name)};
    for (Cell& cell : case_row(documents[i].json)) row.push_back(std::move(cell));
    table.rows.push_back(std::move(row));
  }
  return {"overview", "What was run", html(table)};
}

}  // namespace

std::string case_page(const fs::path& folder, Figures& figures) {
  const Document document = parse(folder / "summary.json");
  if (document.kind != Kind::run)
    throw FileError(document.file.string() + ": it is not the summary of a case");
  return figures.drawn(
      page(fmt::format("CiliaVal: {}", document.name), "", {section_of(document, "case", figures)},
           "Made by `ciliaval run` from summary.json and the centrelines beside it."));
}

Report results_page(const fs::path& folder, const output::Provenance& maker, Figures& figures) {
  Report report;
  std::vector<Document> found;
  for (const fs::path& file : json_files(folder)) try {
      found.push_back(parse(file));
    } catch (const Error& error) {
      report.damaged.emplace_back(error.what());
    }
  std::stable_sort(found.begin(), found.end(), [](const Document& a, const Document& b) {
    return std::pair(a.kind, !is_of_figure_4(a)) < std::pair(b.kind, !is_of_figure_4(b));
  });
  std::vector<Document> documents;
  std::vector<Section> sections;
  std::set<std::string> ids;
  for (Document& document : found) try {
      std::string id = "part-" + identifier(document.file.lexically_relative(folder).string());
      while (!ids.insert(id).second) id += "-";
      sections.push_back(section_of(document, id, figures));
      documents.push_back(std::move(document));
    } catch (const FileError& error) {
      report.damaged.emplace_back(error.what());
    }
  const std::string pictures = pictures_content(folder, figures, report.damaged);
  if (documents.empty() && pictures.empty() && report.damaged.empty())
    throw FileError(
        fmt::format("there are no results in `{}`: `ciliaval run CASE.toml -o {}` "
                    "makes some",
                    folder.string(), folder.string()));
  Section first = overview(documents, sections);
  if (!pictures.empty()) sections.push_back({"pictures", "Pictures", pictures});
  sections.insert(sections.begin(), std::move(first));
  if (!report.damaged.empty())
    sections.insert(sections.begin() + 1,
                    {"damaged", "Files that could not be shown", list(report.damaged)});
  const std::vector<std::string> absent = missing(documents, !pictures.empty(), folder.string());
  if (!absent.empty())
    sections.push_back({"missing", "What is not here, and how to make it", list(absent)});
  sections.push_back({"provenance", "Provenance", origins(documents, folder)});
  report.html = figures.drawn(
      page("CiliaVal: report of results",
           "Models of a magnetic-cilium tactile sensor beside each other, and what separates them. "
           "Every number is read from the result files named under Provenance.",
           sections,
           fmt::format("Page made by ciliaval {} (git {}) on {}: {}", maker.version, maker.git,
                       maker.date, maker.command)));
  return report;
}

}  // namespace ciliaval::compare::report
