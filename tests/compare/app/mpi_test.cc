// SPDX-License-Identifier: LGPL-2.1-or-later
// The program under mpirun.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/synthetic.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;

struct RanksOutcome {
  int code = -1;
  std::string out;
};

/// Runs a command, for mpirun also as root and on a single core.
RanksOutcome execute(const fs::path& folder, const std::string& words) {
  const std::string command =
      "cd '" + folder.string() +
      "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
      "OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none "
      "OMPI_MCA_mpi_yield_when_idle=1 OPENBLAS_NUM_THREADS=1 " +
      words + " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "out.txt")};
}

/// `ciliaval run` on one or two ranks.
RanksOutcome run(const fs::path& folder, int ranks, const std::string& results,
                 const std::string& file = "case.toml") {
  const std::string launcher =
      ranks == 1 ? "" : "'" CILIAVAL_MPIEXEC "' -n " + std::to_string(ranks) + " ";
  return execute(folder, launcher + "'" CILIAVAL_PROGRAM "' run " + file + " -o " + results);
}

/// A short cilium, quickly solved.
constexpr double length = 6e-3;
void write_mpi_case(const fs::path& folder, const std::string& solid,
                    const std::string& forces = R"("1 mN")") {
  std::ofstream(folder / "case.toml") << test::case_text(
      {.name = "mpi", .magnet_length = "3 mm", .force = forces, .height = "5 mm"},
      R"(mechanics = ["elastica", "solid"]
fields = ["line", "mesh"]
[models.solid]
refinement = 0
)" + solid);
}

nlohmann::json solid_step(const fs::path& results, std::size_t step = 0) {
  const auto summary = nlohmann::json::parse(read_text(results / "mpi" / "summary.json"));
  return summary.at("steps").at(step).at("mechanics").at("solid");
}

void expect_same_tip(const fs::path& results, const fs::path& reference, std::size_t step,
                     double tolerance, const std::string& what) {
  const auto tip = solid_step(results, step).at("tip").get<std::vector<double>>();
  const auto expected = solid_step(reference, step).at("tip").get<std::vector<double>>();
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(tip[i], expected[i], tolerance * length) << what << ", step " << step;
}

// Oracle: the run on one rank.
TEST(Mpi, TwoRanksGiveTheTipOfOneTo1e9AndWriteOnce) {
  for (const std::string solver : {"direct", "iterative"}) {
    const TemporaryFolder folder;
    write_mpi_case(folder.path(), "solver = \"" + solver + "\"\n");
    ASSERT_EQ(run(folder.path(), 1, "one").code, 0);
    const RanksOutcome two = run(folder.path(), 2, "two");
    ASSERT_EQ(two.code, 0) << read_text(folder.path() / "err.txt");
    EXPECT_EQ(two.out.find("Results: "), two.out.rfind("Results: ")) << two.out;
    expect_same_tip(folder.path() / "two", folder.path() / "one", 0, 1e-9, solver);
  }
}

/// Expects the solid's steps of two runs to end alike.
void expect_same_steps(const fs::path& results, const fs::path& reference, std::size_t steps) {
  for (std::size_t step = 0; step < steps; ++step) {
    const nlohmann::json own = solid_step(results, step);
    const nlohmann::json expected = solid_step(reference, step);
    ASSERT_EQ(own.at("status"), expected.at("status")) << step;
    if (own.at("status") == "converged")
      expect_same_tip(results, reference, step, 1e-9, results.filename().string());
    else
      EXPECT_NEAR(own.at("slip_off_force").get<double>(),
                  expected.at("slip_off_force").get<double>(),
                  1e-9 * expected.at("slip_off_force").get<double>());
  }
}

/// Each test runs with each solver: the direct one's mesh is whole on all ranks, the iterative
/// one's in parts.
class MpiSolver : public testing::TestWithParam<std::string> {
 protected:
  std::string solver() const { return "solver = \"" + GetParam() + "\"\n"; }
};
class MpiSolverSlow : public MpiSolver {};
INSTANTIATE_TEST_SUITE_P(Solvers, MpiSolverSlow, testing::Values("direct", "iterative"));
INSTANTIATE_TEST_SUITE_P(Solvers, MpiSolver, testing::Values("direct", "iterative"));

/// Steps that converge, equal loads, another height, a slip-off and a step after it. Oracle: the
/// run on one rank.
void expect_load_path_of_one(const std::string& solver, int ranks) {
  const TemporaryFolder folder;
  write_mpi_case(folder.path(), solver, R"(["8 mN", "8 mN", "10 mN", "4 mN", "40 mN", "8 mN"])");
  std::string text = read_text(folder.path() / "case.toml");
  const std::string height = "height = \"5 mm\"";
  text.replace(text.find(height), height.size(),
               R"(height = ["5 mm", "5 mm", "5 mm", "4 mm", "5 mm", "5 mm"])");
  std::ofstream(folder.path() / "case.toml") << text;
  ASSERT_EQ(run(folder.path(), 1, "one").code, 0) << read_text(folder.path() / "err.txt");
  EXPECT_EQ(solid_step(folder.path() / "one", 4).at("status"), "slipped_off");
  ASSERT_EQ(run(folder.path(), ranks, "more").code, 0) << read_text(folder.path() / "err.txt");
  expect_same_steps(folder.path() / "more", folder.path() / "one", 6);
}

TEST_P(MpiSolver, ThreeRanksFollowAnyLoadPathAsOneDoes) {
  expect_load_path_of_one(solver(), 3);
}

TEST_P(MpiSolverSlow, TwoRanksFollowAnyLoadPathAsOneDoes) {
  expect_load_path_of_one(solver(), 2);
}

// Oracle: the run on one rank.
TEST_P(MpiSolver, TwoRanksFindTheForceOfAProbe) {
  const TemporaryFolder folder;
  write_mpi_case(folder.path(), solver(), R"(["0.3 mm", "1 mm"])");
  std::string text = read_text(folder.path() / "case.toml");
  text.replace(text.find("\"contact\""), 9, "\"probe\"");
  text.replace(text.find("force ="), 7, "displacement =");
  std::ofstream(folder.path() / "case.toml") << text;
  ASSERT_EQ(run(folder.path(), 1, "one").code, 0) << read_text(folder.path() / "err.txt");
  ASSERT_EQ(run(folder.path(), 2, "two").code, 0) << read_text(folder.path() / "err.txt");
  expect_same_steps(folder.path() / "two", folder.path() / "one", 2);
  for (const std::size_t step : {0U, 1U}) {
    const double force = solid_step(folder.path() / "one", step).at("applied_force").get<double>();
    EXPECT_NEAR(solid_step(folder.path() / "two", step).at("applied_force").get<double>(), force,
                1e-9 * force);
  }
}

// Oracle: the run on one rank, with the field of the gathered body.
TEST_P(MpiSolver, RanksShareAUsersMesh) {
  const TemporaryFolder folder;
  write_mpi_case(folder.path(), "");
  ASSERT_EQ(execute(folder.path(), "'" CILIAVAL_PROGRAM "' mesh case.toml -o cilium.msh").code, 0);
  write_mpi_case(folder.path(), "mesh = \"cilium.msh\"\n" + solver());
  std::vector<double> field;
  for (const int ranks : {1, 2, 3}) {
    const std::string results = std::to_string(ranks);
    ASSERT_EQ(run(folder.path(), ranks, results).code, 0) << read_text(folder.path() / "err.txt");
    expect_same_steps(folder.path() / results, folder.path() / "1", 1);
    const auto summary =
        nlohmann::json::parse(read_text(folder.path() / results / "mpi" / "summary.json"));
    field.push_back(summary.at("steps").at(0).at("fields").at("solid/mesh").at("B").at(0).at(2));
  }
  EXPECT_NEAR(field[1], field[0], 1e-9 * std::abs(field[0]));
  EXPECT_NEAR(field[2], field[0], 1e-9 * std::abs(field[0]));
}

// Oracle: the run on one rank. The meshes are the same, the sums are in another order, and the
// algebraic multigrid is another one: what is left is the residual of 1e-8 of conjugate gradients.
TEST(Mpi, TwoRanksGiveThePotentialsFieldOfOne) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "case.toml")
      << test::case_text({.name = "mpi", .force = R"("1 mN")"}, R"(mechanics = ["elastica"]
fields = ["potential"]
[models.potential]
tolerance = 1e-2
)");
  std::vector<nlohmann::json> B;
  for (const int ranks : {1, 2}) {
    const std::string results = std::to_string(ranks);
    ASSERT_EQ(run(folder.path(), ranks, results).code, 0) << read_text(folder.path() / "err.txt");
    const fs::path folder_of_case = folder.path() / results / "mpi";
    const auto summary = nlohmann::json::parse(read_text(folder_of_case / "summary.json"));
    B.push_back(summary.at("steps").at(0).at("fields").at("elastica/potential").at("B").at(0));
    EXPECT_TRUE(fs::exists(folder_of_case / "vtk" / "field_elastica_potential_0000.vtu"));
  }
  const double scale = std::abs(B[0].at(2).get<double>());
  EXPECT_GT(scale, 2e-3);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(B[0].at(i).get<double>(), B[1].at(i).get<double>(), 1e-6 * scale);
}

// A program in CalculiX's place counts its runs and turns every node by 30°: one rank runs it, both
// draw the field of what it gave.
TEST(Mpi, OneRankRunsCalculixForBoth) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "fake") << R"(#!/bin/sh
echo >> "$COUNT"
awk -F, '/^\*/ { nodes = /^\*NODE, NSET/; next }
  nodes { if (!n++) print " and time  0.1000000E+01"
          printf "%10d %13.6E %13.6E %13.6E\n", $1, 0.866*$2 + 0.5*$4 - $2, 0, -0.5*$2 + 0.866*$4 - $4 }
  ' cilium.inp > cilium.dat
)";
  fs::permissions(folder.path() / "fake", fs::perms::owner_all);
  std::string text = test::case_text({.name = "mpi"}, R"(mechanics = ["calculix"]
fields = ["mesh", "potential"]
[models.calculix]
program = "./fake"
refinement = 0
error_estimate = false
[models.potential]
tolerance = 1e-2
)");
  text.replace(text.find("\"contact\""), 9, "\"section\"");
  text.replace(text.find("height"), 6, "arclength");
  std::ofstream(folder.path() / "case.toml") << text;
  setenv("COUNT", (folder.path() / "count").c_str(), 1);
  ASSERT_EQ(run(folder.path(), 2, "two").code, 0) << read_text(folder.path() / "err.txt");
  EXPECT_EQ(read_text(folder.path() / "count"), "\n");
  const auto summary = nlohmann::json::parse(read_text(folder.path() / "two/mpi/summary.json"));
  const auto& step = summary.at("steps").at(0);
  EXPECT_NEAR(step.at("mechanics").at("calculix").at("tip").at(2).get<double>(), 0.866 * 20e-3,
              1e-8);
  const double mesh = step.at("fields").at("calculix/mesh").at("B").at(0).at(2).get<double>();
  const double field = step.at("fields").at("calculix/potential").at("B").at(0).at(2).get<double>();
  EXPECT_NEAR(field, mesh, 0.1 * std::abs(mesh));  // μ_r = 1.05 there, 1 here
}

// A transport that there is not, asked for by the user: Open MPI must hear of it.
TEST(Mpi, WhatTheUserAsksOfOpenMpiStands) {
  const TemporaryFolder folder;
  write_mpi_case(folder.path(), "");
  const RanksOutcome outcome = execute(
      folder.path(), "OMPI_MCA_pml=nowhere '" CILIAVAL_PROGRAM "' run case.toml -o results");
  EXPECT_NE(outcome.code, 0);
  EXPECT_NE(read_text(folder.path() / "err.txt").find("nowhere"), std::string::npos)
      << read_text(folder.path() / "err.txt");
}

// Oracle: the contract of the exit codes.
TEST(Mpi, AFailureEndsAllRanksWithItsExitCode) {
  const TemporaryFolder folder;
  write_mpi_case(folder.path(), "max_iterations = 1\nmax_cutbacks = 0\n");
  EXPECT_EQ(run(folder.path(), 2, "two").code, 3);
  EXPECT_EQ(solid_step(folder.path() / "two").at("status"), "failed");
  EXPECT_EQ(run(folder.path(), 2, "two", "none.toml").code, 2);
}

/// Runs the case on two ranks and kills mpirun and the ranks (which would go on for a while) once
/// the solid has saved its fourth step: SQLite writes the two columns of an entry's name side by
/// side.
void interrupt_two_ranks(const fs::path& folder) {
  execute(folder,
          "sh -c '\"" CILIAVAL_MPIEXEC "\" -n 2 \"" CILIAVAL_PROGRAM
          "\" run case.toml -o out & launcher=$!; "
          "while kill -0 $launcher && ! grep -qs solid4 out/.mpi.sqlite*; do sleep 0.02; done; "
          "kill -9 $(cat /proc/$launcher/task/*/children) $launcher; wait'");
  ASSERT_TRUE(fs::exists(folder / "out/.mpi.sqlite")) << read_text(folder / "err.txt");
}

/// Goes on from there, as soon as the killed run's ranks have noticed and are gone.
RanksOutcome go_on(const fs::path& folder, int ranks) {
  RanksOutcome outcome;
  for (int attempt = 0; attempt < 100; ++attempt) {
    outcome = run(folder, ranks, "out");
    if (read_text(folder / "err.txt").find("another run writes to") == std::string::npos) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  return outcome;
}

// Oracle: an undisturbed run on two ranks.
TEST_P(MpiSolverSlow, AKilledRunOfTwoRanksGoesOnOnAnyNumber) {
  const TemporaryFolder folder;
  write_mpi_case(folder.path(), solver(),
                 R"(["0.5 mN", "1 mN", "1.5 mN", "2 mN", "2.5 mN", "3 mN", "3.5 mN", "4 mN"])");
  ASSERT_EQ(run(folder.path(), 2, "undisturbed").code, 0);
  for (const int ranks : {2, 1, 3}) {
    fs::remove_all(folder.path() / "out");
    interrupt_two_ranks(folder.path());
    ASSERT_EQ(go_on(folder.path(), ranks).code, 0) << read_text(folder.path() / "err.txt");
    EXPECT_NE(read_text(folder.path() / "err.txt").find("goes on at step"), std::string::npos);
    for (std::size_t step = 0; step < 8; ++step)
      expect_same_tip(folder.path() / "out", folder.path() / "undisturbed", step,
                      ranks == 2 ? 1e-12 : 1e-9, std::to_string(ranks) + " ranks");
  }
}

/// Number of occurrences of a text.
int count(const std::string& text, const std::string& part) {
  int result = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++result;
  return result;
}

// Rank 1 or rank 0 alone runs out of memory, at several places of the solution: both end, with the
// exit code of a solver's failure, and the one that failed says so, once. Oracle: the contract; a
// minute's `timeout` stands for "waits forever" (code 124).
void expect_fault_of_one_rank_ends_all(const fs::path& folder,
                                       const std::vector<int>& allocations) {
  const std::string program = "'" CILIAVAL_PROGRAM "' run case.toml -o out";
  for (const int failing : {1, 0})
    for (const int allocation : allocations) {
      fs::remove_all(folder / "out");
      const std::string faulty = "env LD_PRELOAD='" CILIAVAL_FAILING_NEW "' CILIAVAL_FAIL_AT=" +
                                 std::to_string(allocation) + " " + program;
      const RanksOutcome outcome = execute(
          folder, "timeout 60 '" CILIAVAL_MPIEXEC "' -n 1 " + (failing == 0 ? faulty : program) +
                      " : -n 1 " + (failing == 1 ? faulty : program));
      const std::string said = read_text(folder / "err.txt");
      const std::string what =
          "rank " + std::to_string(failing) + ", allocation " + std::to_string(allocation);
      EXPECT_EQ(outcome.code, 3) << what << ": " << said;
      EXPECT_EQ(count(said, "rank " + std::to_string(failing) + " of 2 failed alone: "), 1)
          << what << ": " << said;
      EXPECT_EQ(count(said, "ciliaval: "), 1) << what << ": " << said;
      EXPECT_FALSE(fs::exists(folder / "out" / "mpi"));
    }
}

TEST_P(MpiSolverSlow, AFaultOfOneRankAloneEndsAllOfThem) {
  const TemporaryFolder folder;
  write_mpi_case(folder.path(), solver());
  expect_fault_of_one_rank_ends_all(folder.path(), {1, 20});
}

TEST(MpiPotentialSlow, AFaultOfOneRankAloneEndsAllOfThem) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "case.toml")
      << test::case_text({.name = "mpi"},
                         "mechanics = [\"elastica\"]\nfields = [\"potential\"]\n"
                         "[models.potential]\ntolerance = 0.05\n");
  expect_fault_of_one_rank_ends_all(folder.path(), {1, 20});
}

}  // namespace
}  // namespace ciliaval
