// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "compare/claims/claim.h"
#include "compare/output/provenance.h"
#include "tests/support/program.h"
#include "tests/support/study_texts.h"

namespace ciliaval::test {

/// A folder with results of every kind, made by the program as a user calls it (the claims, which
/// take longer, by their own writer), and the report of it: a case of two loads and a study of five
/// points on the rods, its budget, its convergence, a reading, a picture.
class Results {
 public:
  /// `title` is that of the case; any text but three apostrophes.
  explicit Results(const std::string& title = "A test") {
    std::string text =
        case_text({.name = "one", .force = R"(["1 mN", "2 mN"])"},
                  "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n");
    const std::string old_title = "\"A test\"";
    text.replace(text.find(old_title), old_title.size(), "'''" + title + "'''");
    std::ofstream(folder_.path() / "one.toml") << text;
    program("run one.toml -o results");
    program("budget one.toml --without solid --without potential --json results/one.budget.json");
    program("converge one.toml --json results/one.converge.json");
    std::ofstream(folder_.path() / "readings.csv")
        << "sample, dBx [uT], dBy [uT], dBz [uT]\nfirst, 77.0, 44.1, 3.4\n";
    program("sense one.toml readings.csv --json results/one.sense.json");
    write_study_case(folder_.path());
    write_study(folder_.path(),
                study_text("pairs = [\"elastica/line\", \"beam/volume\"]\n", modulus_range));
    program("study varied.study.toml -o results");
    const compare::claims::Claim claim{"3.3", "a < b & \"c\"", "n", {{"x", {1, 2}, "%", false}}};
    std::ofstream(results() / "claims.json")
        << compare::claims::claims_json({claim}, compare::output::provenance("ciliaval claims"));
    std::filesystem::create_directory(results() / "pictures");
    std::filesystem::copy_file(CILIAVAL_SOURCE_DIR "/docs/figures/fig3b.png",
                               results() / "pictures/fig3b.png");
    program("report results");
  }

  /// Where the program is called; the results are in `results`.
  const std::filesystem::path& folder() const { return folder_.path(); }
  std::filesystem::path results() const { return folder_.path() / "results"; }

 private:
  void program(const std::string& arguments) {
    const Outcome outcome = run_program(folder_.path(), arguments);
    if (outcome.code != 0) throw std::runtime_error(arguments + ": " + outcome.err);
  }

  TemporaryFolder folder_;
};

}  // namespace ciliaval::test
