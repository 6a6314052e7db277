// SPDX-License-Identifier: LGPL-2.1-or-later
// The program under mpirun.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "synthetic.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;

struct Outcome {
  int code = -1;
  std::string out;
};

/// Runs a command, for mpirun also as root and on a single core.
Outcome execute(const fs::path& folder, const std::string& words) {
  const std::string command =
      "cd '" + folder.string() +
      "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
      "OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none "
      "OMPI_MCA_mpi_yield_when_idle=1 " +
      words + " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "out.txt")};
}

/// `ciliaval run` on one or two ranks.
Outcome run(const fs::path& folder, int ranks, const std::string& results,
            const std::string& file = "case.toml") {
  const std::string launcher =
      ranks == 1 ? "" : "'" CILIAVAL_MPIEXEC "' -n " + std::to_string(ranks) + " ";
  return execute(folder, launcher + "'" CILIAVAL_PROGRAM "' run " + file + " -o " + results);
}

void write_case(const fs::path& folder, const std::string& solid) {
  std::ofstream(folder / "case.toml") << R"([case]
name = "mpi"
title = "On several ranks"
[cilium]
diameter = "3 mm"
[[cilium.segment]]
name = "base"
length = "3 mm"
young_modulus = "0.1 MPa"
poisson_ratio = 0.49
[[cilium.segment]]
name = "magnet"
length = "17 mm"
young_modulus = "3 MPa"
poisson_ratio = 0.49
magnetization = "75 kA/m"
[load]
type = "contact"
force = "1 mN"
height = "16 mm"
azimuth = "30 deg"
[sensor]
position = ["-0.1 mm", "0.2 mm", "-1.55 mm"]
[models]
mechanics = ["elastica", "solid"]
fields = ["line", "mesh"]
[models.solid]
refinement = 0
)" << solid;
}

nlohmann::json solid_step(const fs::path& results) {
  const auto summary = nlohmann::json::parse(read_text(results / "mpi" / "summary.json"));
  return summary.at("steps").at(0).at("mechanics").at("solid");
}

// Oracle: the run on one rank.
TEST(Mpi, TwoRanksGiveTheTipOfOneTo1e9AndWriteOnce) {
  for (const std::string solver : {"direct", "iterative"}) {
    const TemporaryFolder folder;
    write_case(folder.path(), "solver = \"" + solver + "\"\n");
    ASSERT_EQ(run(folder.path(), 1, "one").code, 0);
    const Outcome two = run(folder.path(), 2, "two");
    ASSERT_EQ(two.code, 0) << read_text(folder.path() / "err.txt");
    EXPECT_EQ(two.out.find("Results: "), two.out.rfind("Results: ")) << two.out;
    const auto one = solid_step(folder.path() / "one").at("tip").get<std::vector<double>>();
    const auto both = solid_step(folder.path() / "two").at("tip").get<std::vector<double>>();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(both[i], one[i], 1e-9 * 20e-3) << solver;
  }
}

// Oracle: the contract of the exit codes.
TEST(Mpi, AFailureEndsAllRanksWithItsExitCode) {
  const TemporaryFolder folder;
  write_case(folder.path(), "max_iterations = 1\nmax_cutbacks = 0\n");
  EXPECT_EQ(run(folder.path(), 2, "two").code, 3);
  EXPECT_EQ(solid_step(folder.path() / "two").at("status"), "failed");
  EXPECT_EQ(run(folder.path(), 2, "two", "none.toml").code, 2);
}

/// How often a text occurs.
int count(const std::string& text, const std::string& part) {
  int result = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++result;
  return result;
}

// Rank 1 or rank 0 alone runs out of memory, at several places of the solution: both end, with the
// exit code of a solver's failure, and the one that failed says so, once. Oracle: the contract; a
// minute's `timeout` stands for "waits forever" (code 124).
TEST(MpiSlow, AFaultOfOneRankAloneEndsAllOfThem) {
  const TemporaryFolder folder;
  write_case(folder.path(), "");
  const std::string program = "'" CILIAVAL_PROGRAM "' run case.toml -o out";
  for (const int failing : {1, 0})
    for (const int allocation : {1, 20}) {
      fs::remove_all(folder.path() / "out");
      const std::string faulty = "env LD_PRELOAD='" CILIAVAL_FAILING_NEW "' CILIAVAL_FAIL_AT=" +
                                 std::to_string(allocation) + " " + program;
      const Outcome outcome =
          execute(folder.path(), "timeout 60 '" CILIAVAL_MPIEXEC "' -n 1 " +
                                     (failing == 0 ? faulty : program) + " : -n 1 " +
                                     (failing == 1 ? faulty : program));
      const std::string said = read_text(folder.path() / "err.txt");
      const std::string what =
          "rank " + std::to_string(failing) + ", allocation " + std::to_string(allocation);
      EXPECT_EQ(outcome.code, 3) << what << ": " << said;
      EXPECT_EQ(count(said, "rank " + std::to_string(failing) + " of 2 failed alone: "), 1)
          << what << ": " << said;
      EXPECT_EQ(count(said, "ciliaval: "), 1) << what << ": " << said;
      EXPECT_FALSE(fs::exists(folder.path() / "out" / "mpi"));
    }
}

}  // namespace
}  // namespace ciliaval
