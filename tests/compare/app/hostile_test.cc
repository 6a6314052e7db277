// SPDX-License-Identifier: LGPL-2.1-or-later
// Names, files and limits that the program does not choose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "compare/output/store/store.h"
#include "tests/support/program.h"
#include "tests/support/synthetic.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr const char* both_rods =
    "mechanics = [\"elastica\", \"beam\"]\nfields = [\"line\", \"volume\"]\n";

void write_case(const fs::path& folder, const std::string& models) {
  std::ofstream(folder / "a.toml")
      << test::case_text({.name = "a", .force = R"(["1 mN", "9 mN"])"}, models);
}

// Folders and files that look like options, for the program and for the Python that it starts.
TEST(Hostile, NamesMayBeginWithADash) {
  const TemporaryFolder folder;
  write_case(folder.path(), both_rods);
  const Outcome run =
      run_program(folder.path(), "run --output=-out a.toml", "unset CILIAVAL_PYTHON; ");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(fs::exists(folder.path() / "-out" / "a" / "report.html"));
  EXPECT_EQ(run_program(folder.path(), "report --output=-page.html -- -out").code, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "-page.html"));
  EXPECT_EQ(run_program(folder.path(), "draw --output=-a.svg a.toml").code, 0);
  EXPECT_TRUE(fs::exists(folder.path() / "-a.svg"));
}

TEST(Hostile, AStudysStoreUnderARunsNameIsLeftAsItIs) {
  const TemporaryFolder folder;
  write_case(folder.path(), "mechanics = [\"solid\"]\n[models.solid]\nrefinement = 0\n");
  fs::create_directory(folder.path() / "out");
  const fs::path file = folder.path() / "out" / ".a.sqlite";
  {
    compare::output::store::Store store(file);
    store.require_fingerprint("study", {{"program", "any"}});
    store.write("study", {{"0", "bytes"}});
  }
  for (const char* fresh : {"", "--fresh "}) {
    const Outcome run = run_program(folder.path(), std::string("run ") + fresh + "a.toml -o out");
    EXPECT_EQ(run.code, 4);
    EXPECT_THAT(run.err, HasSubstr("holds results of something else, `study`; move it away"));
    EXPECT_EQ(compare::output::store::Store(file).read("study").size(), 1U);
  }
}

// A limit of the shell's, `ulimit -f`, would kill the program with SIGXFSZ at a write.
TEST(Hostile, AWriteBeyondTheLimitOfAFilesSizeIsSaid) {
  const TemporaryFolder folder;
  write_case(folder.path(), both_rods);
  const Outcome run = run_program(folder.path(), "run a.toml -o out", "ulimit -f 8 && ");
  EXPECT_EQ(run.code, 4) << run.err;
  EXPECT_THAT(run.err, HasSubstr("File too large"));
  EXPECT_FALSE(fs::exists(folder.path() / "out" / "a" / "summary.json"));
}

}  // namespace
}  // namespace ciliaval
