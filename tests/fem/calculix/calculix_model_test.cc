// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/calculix/calculix_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "fem/parallel.h"
#include "fem/solid/solid.h"
#include "problem/error.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::fem::calculix {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Cilium cilium() {
  Segment base;
  base.length = 3e-3;
  base.young_modulus = 1e5;
  base.poisson_ratio = 0.49;
  Segment magnet = base;
  magnet.length = 7e-3;
  magnet.young_modulus = 3e6;
  magnet.magnetization = 75e3;
  return {3e-3, {base, magnet}};
}

const LoadPath section_path{SectionLoad{.force = 2e-3, .arclength = 8e-3, .azimuth = 0}};

/// A folder for one test, in which the models' temporary folders lie, and fake programs.
class CalculixModel : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(temporary_);
    start_mpi();  // before, so that its files are elsewhere
    setenv("TMPDIR", temporary_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("TMPDIR");
    setenv("PATH", path_.c_str(), 1);
  }

  /// A shell script in place of CalculiX, called with `-i cilium` in its folder.
  fs::path script(const std::string& body) const {
    const fs::path file = folder_ / "fake_ccx";
    std::ofstream(file) << "#!/bin/sh\n" << body << "\n";
    fs::permissions(file, fs::perms::owner_all);
    return file;
  }

  CalculixOptions options(const fs::path& program) const {
    CalculixOptions result;
    result.refinement = 0;
    result.error_estimate = false;
    result.program = program;
    return result;
  }

  /// The message of the one step, which must have failed; nothing may be left behind.
  std::string failure(const CalculixOptions& options) const {
    const MechanicsResult result = Calculix(options).solve(cilium(), section_path);
    EXPECT_EQ(result.steps.size(), 1U);
    EXPECT_EQ(result.steps[0].status, Status::failed);
    EXPECT_FALSE(result.steps[0].deformation.has_value());
    EXPECT_FALSE(result.undeformed.centreline.pieces().empty());
    EXPECT_TRUE(fs::is_empty(temporary_)) << "a temporary folder was left behind";
    return result.steps[0].message;
  }

  const test::TemporaryFolder own_;
  const fs::path folder_ = own_.path();
  const fs::path temporary_ = folder_ / "tmp";
  const std::string path_ = std::getenv("PATH");
};

TEST_F(CalculixModel, SaysWhatToInstallWhereThereIsNoCcx) {
  setenv("PATH", folder_.c_str(), 1);
  EXPECT_EQ(failure(options("ccx")), "ccx is not installed: apt-get install calculix-ccx");
  EXPECT_THAT(failure(options(folder_ / "nowhere")),
              HasSubstr("nowhere` is not there (models.calculix.program)"));
}

TEST_F(CalculixModel, SaysThatAFileCannotBeStarted) {
  const fs::path program = script("exit 0");
  fs::permissions(program, fs::perms::owner_read);
  EXPECT_THAT(failure(options(program)), HasSubstr("cannot be started: Permission denied"));
}

TEST_F(CalculixModel, GivesTheExitCodeAndWhatTheProgramComplainsOf) {
  EXPECT_THAT(failure(options(script("echo first; echo ' *ERROR: no way out'; exit 3"))),
              HasSubstr("ended with the exit code 3; it said: *ERROR: no way out"));
}

TEST_F(CalculixModel, NamesTheSignalThatKilledTheProgram) {
  EXPECT_THAT(failure(options(script("kill -SEGV $$"))), HasSubstr("killed by the signal 11"));
}

TEST_F(CalculixModel, EndsAProgramThatHangsWithAllItsChildren) {
  CalculixOptions hanging =
      options(script("sleep 300 & echo $! > '" + (folder_ / "pid").string() + "'; wait"));
  hanging.time_limit = 0.5;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(
      failure(hanging),
      HasSubstr("did not end by itself and was killed after 0.5 s, models.calculix.time_limit"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  pid_t child = 0;
  std::ifstream(folder_ / "pid") >> child;
  ASSERT_GT(child, 1);
  // Killed; init may not have reaped it yet: a zombie has no command line.
  std::string command;
  for (int i = 0; i < 100; ++i) {
    command.clear();
    std::getline(std::ifstream("/proc/" + std::to_string(child) + "/cmdline"), command);
    if (command.empty()) break;
    usleep(10000);
  }
  EXPECT_EQ(command, "");
}

// The fake program tells this one to end, as Ctrl-C or `kill` would.
TEST_F(CalculixModel, TidiesUpBeforeASignalEndsTheProgram) {
  const CalculixOptions signalling =
      options(script("touch '" + (folder_ / "ran").string() + "'; kill -TERM $PPID; sleep 300"));
  const pid_t child = fork();
  if (child == 0) {
    Calculix(signalling).solve(cilium(), section_path);
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
  EXPECT_TRUE(fs::exists(folder_ / "ran"));
  EXPECT_TRUE(fs::is_empty(temporary_));
}

TEST_F(CalculixModel, RefusesADamagedResult) {
  EXPECT_THAT(failure(options(script("echo bye"))), HasSubstr("wrote no .dat file; it said: bye"));
  EXPECT_THAT(failure(options(script("echo ' and time 0.25E+00' > cilium.dat"))),
              HasSubstr("did not reach the whole load: its .dat file ends at time 0.25"));
  EXPECT_THAT(failure(options(script("printf ' and time 0.1E+01\\n 1 0. 0. 0.\\n' > cilium.dat"))),
              HasSubstr("lacks node"));
  EXPECT_THAT(failure(options(script("printf ' and time 0.1E+01\\n 1 0. 0' > cilium.dat"))),
              HasSubstr("ends in the middle of a line: is the disk full?"));
}

TEST_F(CalculixModel, RefusesLoadsThatFollowTheHeight) {
  try {
    Calculix().solve(cilium(), {ContactLoad{.force = 1e-3, .height = 8e-3}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("takes the loads 'section' and 'dead', not 'contact'"));
  }
}

TEST_F(CalculixModel, SaysWhichFolderCannotBeMade) {
  CalculixOptions kept = options(script("exit 0"));
  kept.keep = folder_ / "fake_ccx" / "kept";  // below a file
  EXPECT_THAT(failure(kept), HasSubstr("cannot make the folder `" + kept.keep.string()));
  setenv("TMPDIR", (folder_ / "fake_ccx").c_str(), 1);
  EXPECT_THAT(failure(options(script("exit 0"))), HasSubstr("TMPDIR"));
}

TEST_F(CalculixModel, NeedsNoProgramWithoutAForce) {
  const MechanicsResult result =
      Calculix(options(folder_ / "nowhere")).solve(cilium(), {DeadLoad{.force_per_length = 0}});
  ASSERT_EQ(result.steps[0].status, Status::converged);
  const Vector3 tip = result.steps[0].deformation->centreline.at(10e-3).position;
  EXPECT_NEAR((tip - Vector3(0, 0, 10e-3)).norm(), 0, 1e-17);
}

/// awk that gives every node of cilium.inp the displacement of a rotation by 30° about the y axis.
const std::string rotate = R"(awk -F, '
  /^\*/ { nodes = /^\*NODE, NSET/; next }
  nodes { c = cos(atan2(0, -1) / 6); s = sin(atan2(0, -1) / 6)
          if (!n++) print " and time  0.1000000E+01"
          printf "%10d %13.6E %13.6E %13.6E\n", $1, c*$2 + s*$4 - $2, 0, -s*$2 + c*$4 - $4 }
  ' cilium.inp > cilium.dat)";

// Oracle: a rigid rotation, which a fake program gives, needs no program installed: the centreline
// is straight and tilted, every section turned, J = 1; n and m are by hand. It prints seven digits:
// 5e-7 of 1e-2 m at a node; the means have less, the rotation 1e-8/R = 3e-6.
TEST_F(CalculixModel, MakesCentrelineAndBodyFromTheDisplacementsOfNodes) {
  const double angle = std::numbers::pi / 6;
  for (const double azimuth : {0.0, 2.0}) {
    LoadPath path = section_path;
    path[0] = with_azimuth(path[0], azimuth);
    const MechanicsResult result = Calculix(options(script(rotate))).solve(cilium(), path);
    ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
    EXPECT_DOUBLE_EQ(result.steps[0].applied_force, 2e-3);
    const Deformation& deformation = *result.steps[0].deformation;
    const Vector3 e(std::cos(azimuth), std::sin(azimuth), 0);
    const Vector3 axis = std::sin(angle) * e + std::cos(angle) * Vector3::UnitZ();
    for (const double S : {0.0, 1e-3, 2.9e-3, 7e-3, 10e-3}) {
      const CentrelinePoint p = deformation.centreline.at(S);
      EXPECT_NEAR((p.position - S * axis).norm(), 0, 5e-9) << S;
      EXPECT_NEAR((p.normal() - axis).norm(), 0, 1e-5) << S;
      const Vector3 force = S < 8e-3 ? Vector3(2e-3 * e) : Vector3::Zero();
      EXPECT_NEAR((p.forces.force - force).norm(), 0, 1e-15) << S;
      const Vector3 moment = ((8e-3 - S) * axis).cross(force);
      EXPECT_NEAR((p.forces.moment - moment).norm(), 0, 2e-11) << S;
    }
    ASSERT_NE(deformation.body, nullptr);
    for (const SolidCell& cell : deformation.body->cells)
      for (std::size_t i = 0; i < cell.current.size(); ++i) {
        const Eigen::AngleAxisd turn(angle, Vector3::UnitZ().cross(e));
        EXPECT_NEAR((cell.current[i] - turn * cell.reference[i]).norm(), 0, 3e-8);
        EXPECT_NEAR(cell.jacobian[i], 1, 1e-3);
      }
    EXPECT_TRUE(fs::is_empty(temporary_));
  }
}

// Oracle: the same rotation; statics of a load spread over the length.
TEST_F(CalculixModel, BalancesASpreadLoadByStatics) {
  const MechanicsResult result =
      Calculix(options(script(rotate))).solve(cilium(), {DeadLoad{.force_per_length = 0.2}});
  ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  for (const double S : {0.0, 1e-3, 5e-3, 9.9e-3}) {
    const SectionForces forces = result.steps[0].deformation->centreline.at(S).forces;
    const double above = 10e-3 - S;
    EXPECT_NEAR((forces.force - 0.2 * above * Vector3::UnitX()).norm(), 0, 1e-12) << S;
    const double moment = 0.2 * above * above / 2 * std::cos(std::numbers::pi / 6);
    EXPECT_NEAR((forces.moment - moment * Vector3::UnitY()).norm(), 0, 5e-11) << S;
  }
}

TEST_F(CalculixModel, KeepsItsFilesOnDemand) {
  CalculixOptions kept = options(script(rotate));
  kept.keep = folder_ / "kept";
  kept.error_estimate = true;
  const MechanicsResult result = Calculix(kept).solve(cilium(), section_path);
  EXPECT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  for (const char* run : {"step_1", "step_1_coarser"})
    for (const char* file : {"cilium.inp", "cilium.dat", "ccx.log"})
      EXPECT_TRUE(fs::exists(kept.keep / run / file)) << run << '/' << file;
  // Files that were kept must not pass for the next run's result.
  std::ofstream(folder_ / "fake_ccx") << "#!/bin/sh\n";
  EXPECT_THAT(failure(kept), HasSubstr("wrote no .dat file"));
}

TEST_F(CalculixModel, GivesNoEstimateWhereTheCoarserMeshFails) {
  CalculixOptions half =
      options(script("test -e '" + (folder_ / "once").string() + "' && exit 7; touch '" +
                     (folder_ / "once").string() + "'; " + rotate));
  half.error_estimate = true;
  const MechanicsStep step = Calculix(half).solve(cilium(), section_path).steps[0];
  EXPECT_EQ(step.status, Status::converged);
  EXPECT_FALSE(step.tip_uncertainty.has_value());
  EXPECT_THAT(step.message, HasSubstr("next coarser mesh failed"));
}

bool has_ccx() {
  return std::system("command -v ccx > /dev/null 2>&1") == 0;
}
constexpr const char* no_ccx = "CalculiX is not installed: apt-get install calculix-ccx";

// Oracle: Timoshenko's cantilever, w = F L³/(3EI) + F L/(k G A), ν = 0, k = 6/7 for a circle, at a
// load that bends it by a thousandth of its length. Measured on the coarse mesh: 0.10 % too stiff.
TEST_F(CalculixModel, BendsASlenderRodAsTimoshenkoSays) {
  if (!has_ccx()) GTEST_SKIP() << no_ccx;
  const Cilium rod{1e-3, {{"whole", 10e-3, 1e6, 0.0, 0.0}}};
  const double I = std::numbers::pi * std::pow(1e-3, 4) / 64;
  const double L = rod.length();
  const double compliance = L * L * L / (3 * 1e6 * I) + L / (6.0 / 7 * 0.5e6 * rod.area());
  const double force = 1e-3 * L / compliance;
  const MechanicsResult result =
      Calculix(options("ccx"))
          .solve(rod, {SectionLoad{.force = force, .arclength = L, .azimuth = 0}});
  ASSERT_EQ(result.steps[0].status, Status::converged) << result.steps[0].message;
  const double w = result.steps[0].deformation->centreline.at(L).position.x();
  RecordProperty("error", std::to_string(w / (1e-3 * L) - 1));
  EXPECT_NEAR(w, 1e-3 * L, 0.003 * 1e-3 * L);
  EXPECT_TRUE(fs::is_empty(temporary_));
}

/// Oracle: the solid, another code with another element, on the mesh of the same refinement. The
/// two differ by less than what both state as the errors of their tips, along the whole centreline.
void expect_agreement_with_the_solid(unsigned int refinement) {
  for (const LoadPath& path :
       {section_path, LoadPath{DeadLoad{.force_per_length = 0.3, .azimuth = 1}}}) {
    CalculixOptions calculix;
    calculix.refinement = refinement;
    const MechanicsStep theirs = Calculix(calculix).solve(cilium(), path).steps[0];
    const MechanicsStep ours =
        solid::Solid({.refinement = refinement}).solve(cilium(), path).steps[0];
    ASSERT_EQ(theirs.status, Status::converged) << theirs.message;
    ASSERT_TRUE(theirs.tip_uncertainty && ours.tip_uncertainty);
    const double bound = *theirs.tip_uncertainty + *ours.tip_uncertainty;
    const Centreline& a = theirs.deformation->centreline;
    const Centreline& b = ours.deformation->centreline;
    const double w = b.at(b.length()).position.head<2>().norm();
    EXPECT_GT(w, 0.5e-3);
    EXPECT_LT(bound, (refinement == 0 ? 0.05 : 0.01) * w);
    for (const double S : {2e-3, 3e-3, 5e-3, 8e-3, 10e-3})
      EXPECT_LT((a.at(S).position - b.at(S).position).norm(), bound) << S;
    // n and m: by statics here, from nodal forces there.
    const SectionForces n = a.at(1e-3).forces;
    const SectionForces m = b.at(1e-3).forces;
    EXPECT_NEAR((n.force - m.force).norm(), 0, 1e-6 * m.force.norm());
    EXPECT_NEAR((n.moment - m.moment).norm(), 0, 0.01 * m.moment.norm());
    ASSERT_NE(theirs.deformation->body, nullptr);
    std::printf("tip: %.4f %% apart, uncertainties %.4f %% and %.4f %%; %d iterations, %.1f s\n",
                100 * (a.at(10e-3).position - b.at(10e-3).position).norm() / w,
                100 * *theirs.tip_uncertainty / w, 100 * *ours.tip_uncertainty / w,
                theirs.iterations, theirs.seconds);
  }
}

TEST_F(CalculixModel, AgreesWithTheSolidWithinTheirUncertainties) {
  if (!has_ccx()) GTEST_SKIP() << no_ccx;
  expect_agreement_with_the_solid(0);
  // The solid's MPI may keep a folder of its own there.
  for (const auto& entry : fs::directory_iterator(temporary_))
    EXPECT_FALSE(entry.path().filename().string().starts_with("ciliaval-")) << entry.path();
}

TEST(CalculixModelSlow, AgreesWithTheSolidOnFineMeshes) {
  if (!has_ccx()) GTEST_SKIP() << no_ccx;
  expect_agreement_with_the_solid(2);
}

}  // namespace
}  // namespace ciliaval::fem::calculix
