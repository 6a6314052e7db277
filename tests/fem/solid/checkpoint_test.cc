// SPDX-License-Identifier: LGPL-2.1-or-later
// What an interrupted solution goes on from, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "fem/checkpoint_file.h"
#include "fem/solid/solid.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SolidCheckpointFiles : public testing::Test {
 protected:
  SolidCheckpointFiles() {
    static int number = 0;
    folder_ = fs::temp_directory_path() /
              ("ciliaval-checkpoint-" + std::to_string(getpid()) + "-" + std::to_string(number++));
    fs::create_directories(folder_);
  }
  ~SolidCheckpointFiles() override { fs::remove_all(folder_); }

  Checkpoint checkpoint(const std::string& program = "program 1") const {
    return {folder_ / "solid", program};
  }
  fs::path file(const std::string& name) const { return folder_ / name; }

  fs::path folder_;
};

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}
void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// A short cilium, quickly solved.
Cilium stub() {
  return {3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 3e-3, 3e6, 0.49, 75e3}}};
}
LoadPath path(const std::vector<double>& forces) {
  LoadPath result;
  for (const double force : forces) result.emplace_back(ContactLoad{force, 4.5e-3, 0.4});
  return result;
}
SolidOptions coarse() {
  return {.refinement = 0};
}

struct Killed {};

/// Progress that ends the solution at its n-th line.
Progress killed_after(int& lines) {
  return [&lines](const std::string&) {
    if (lines-- == 0) throw Killed();
  };
}

void expect_same(const MechanicsResult& a, const MechanicsResult& b, const std::string& what) {
  ASSERT_EQ(a.steps.size(), b.steps.size()) << what;
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    const MechanicsStep& p = a.steps[i];
    const MechanicsStep& q = b.steps[i];
    EXPECT_EQ(magnitude(p.load), magnitude(q.load)) << what;
    EXPECT_EQ(p.status, q.status) << what;
    EXPECT_EQ(p.applied_force, q.applied_force) << what;
    EXPECT_EQ(p.slip_off_force, q.slip_off_force) << what;
    EXPECT_EQ(p.contact_arclength, q.contact_arclength) << what;
    EXPECT_EQ(p.tip_uncertainty, q.tip_uncertainty) << what;
    EXPECT_EQ(p.iterations, q.iterations) << what;
    EXPECT_EQ(p.unknowns, q.unknowns) << what;
    ASSERT_EQ(p.deformation.has_value(), q.deformation.has_value()) << what;
    if (!p.deformation) continue;
    const Centreline& r = p.deformation->centreline;
    const Centreline& s = q.deformation->centreline;
    for (const double S : r.breaks()) EXPECT_EQ(r.at(S).position, s.at(S).position) << what;
    const auto& cells = p.deformation->body->cells;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      EXPECT_EQ(cells[c].current, q.deformation->body->cells[c].current) << what;
      EXPECT_EQ(cells[c].cauchy_stress, q.deformation->body->cells[c].cauchy_stress) << what;
    }
  }
}

/// Stops the solution again and again, each time after some more lines of progress than before, and
/// compares what comes of it at last with the solution that nothing has stopped.
void stop_and_go_on(const SolidOptions& options, const LoadPath& loads, const Checkpoint& files,
                    int stops) {
  int total = 0;
  const MechanicsResult whole =
      Solid(options).solve(stub(), loads, [&total](const std::string&) { ++total; });
  ASSERT_GT(total, 10);
  bool went_on = false;
  for (int first = total / 4; first < total; first += total / stops) {
    const std::string what = "stopped first at line " + std::to_string(first);
    fs::remove_all(files.path.parent_path());
    fs::create_directories(files.path.parent_path());
    int lines = first;
    EXPECT_THROW(Solid(options).solve_from(stub(), loads, files, killed_after(lines)), Killed);
    went_on = went_on || fs::exists(files.path);
    lines = first + total / 3;
    try {
      Solid(options).solve_from(stub(), loads, files, killed_after(lines));
    } catch (const Killed&) {
    }
    expect_same(Solid(options).solve_from(stub(), loads, files), whole, what);
  }
  EXPECT_TRUE(went_on);
}

// Oracle: the solution that nothing has stopped, to the last bit: steps, iterations, shape, stress.
TEST_F(SolidCheckpointFiles, GoOnToTheSameBits) {
  stop_and_go_on(coarse(), path({2e-3, 4e-3, 1e-3}), checkpoint(), 4);
}

// … on the way to the slip-off and with its bracket half closed.
using SolidCheckpointFilesSlow = SolidCheckpointFiles;
TEST_F(SolidCheckpointFilesSlow, GoOnInTheSearchForTheSlipOff) {
  stop_and_go_on(coarse(), path({3e-3, 1.0}), checkpoint(), 2);
}

// What a failed step leaves can be gone on from with more iterations; it ends as it would have.
TEST_F(SolidCheckpointFiles, KeepTheStateBeforeAFailureForMoreIterations) {
  SolidOptions impatient = coarse();
  impatient.initial_guess = InitialGuess::none;
  impatient.max_iterations = 3;
  impatient.max_cutbacks = 0;
  const LoadPath loads = path({1e-6, 6e-3});
  const MechanicsResult failed = Solid(impatient).solve_from(stub(), loads, checkpoint());
  EXPECT_EQ(failed.steps.at(0).status, Status::converged) << failed.steps[0].message;
  ASSERT_EQ(failed.steps.at(1).status, Status::failed);
  EXPECT_THAT(failed.steps[1].message, HasSubstr("step 2/2"));
  EXPECT_THAT(failed.steps[1].message, HasSubstr("relative residuals"));
  EXPECT_THAT(failed.steps[1].message, HasSubstr("the last load that converged is 1e-06 N"));
  EXPECT_THAT(failed.steps[1].message, HasSubstr(file("solid").string()));
  SolidOptions patient = impatient;
  patient.max_iterations = 25;
  EXPECT_EQ(Solid(patient).finished_steps(stub(), loads, checkpoint()), 1u);
  const MechanicsResult result = Solid(patient).solve_from(stub(), loads, checkpoint());
  expect_same(result, Solid(patient).solve(stub(), loads), "with more iterations");
}

// A solution that has ended is not solved again: it takes no iteration, hence no progress.
TEST_F(SolidCheckpointFiles, OfAFinishedPathAreNotSolvedAgain) {
  const LoadPath loads = path({1e-3, 2e-3});
  const MechanicsResult whole = Solid(coarse()).solve_from(stub(), loads, checkpoint());
  int lines = 0;
  expect_same(Solid(coarse()).solve_from(stub(), loads, checkpoint(), killed_after(lines)), whole,
              "again");
}

/// What is said of the checkpoint's files; both functions must say the same.
std::string complaint(const Checkpoint& files, const Cilium& cilium, const LoadPath& loads,
                      const SolidOptions& options) {
  const auto message = [](const std::function<void()>& work) -> std::string {
    try {
      work();
    } catch (const CheckpointError& error) {
      return error.what();
    }
    return "nothing is wrong";
  };
  const std::string checked = message([&] { Solid(options).finished_steps(cilium, loads, files); });
  EXPECT_EQ(message([&] { Solid(options).solve_from(cilium, loads, files); }), checked);
  return checked;
}

class DamagedCheckpoint : public SolidCheckpointFiles {
 protected:
  DamagedCheckpoint() {
    Solid(coarse()).solve_from(stub(), loads_, checkpoint());
    for (const char* name : {"solid", "solid.0000", "solid.0001"}) {
      EXPECT_GT(fs::file_size(file(name)), 1000u);
      names_.emplace_back(name);
    }
  }

  /// Expects the refusal of a file, with a reason.
  void refused(const std::string& name, const std::string& reason, const std::string& what) {
    const std::string message = complaint(checkpoint(), stub(), loads_, coarse());
    EXPECT_THAT(message, HasSubstr(file(name).string())) << what;
    EXPECT_THAT(message, testing::ContainsRegex(reason)) << what;
    EXPECT_THAT(message, HasSubstr("--fresh")) << what;
  }

  LoadPath loads_ = path({1e-6, 2e-6});
  std::vector<std::string> names_;
};

// Oracle: CRC-32 of "123456789", the check value of the standard's tables.
TEST(CheckpointFile, HasTheStandardsChecksum) {
  EXPECT_EQ(checksum("123456789"), 0xCBF43926u);
}

TEST_F(DamagedCheckpoint, CutShortAtAnyLengthIsRefused) {
  for (const std::string& name : names_) {
    const std::string whole = read(file(name));
    for (const std::size_t length :
         {std::size_t{1}, std::size_t{10}, std::size_t{20}, std::size_t{25}, std::size_t{40},
          std::size_t{60}, whole.size() / 3, whole.size() - 1}) {
      write(file(name), whole.substr(0, length));
      refused(name, "cut short|not a checkpoint", name + " of " + std::to_string(length));
    }
    write(file(name), "");
    refused(name, "it is empty", name);
    write(file(name), whole + "x");
    refused(name, "damaged", name + " with a byte more");
    write(file(name), whole);
  }
  EXPECT_EQ(complaint(checkpoint(), stub(), loads_, coarse()), "nothing is wrong");
}

// Each bit of the first line and of the program's name; 40 places all over the rest.
TEST_F(DamagedCheckpoint, AFlippedBitAnywhereIsRefused) {
  for (const std::string& name : names_) {
    const std::string whole = read(file(name));
    const std::size_t head = whole.find('\n', whole.find('\n') + 1) + 1;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < head; ++i) places.push_back(i);
    for (std::size_t i = 0; i < 40; ++i) places.push_back(head + (whole.size() - head) * i / 40);
    places.push_back(whole.size() - 1);
    for (const std::size_t place : places) {
      std::string flipped = whole;
      flipped[place] = static_cast<char>(flipped[place] ^ (1 << place % 8));
      write(file(name), flipped);
      EXPECT_THROW(Solid(coarse()).finished_steps(stub(), loads_, checkpoint()), CheckpointError)
          << name << " byte " << place;
    }
    refused(name, "damaged", name);  // by solve_from too
    write(file(name), whole);
  }
}

TEST_F(DamagedCheckpoint, AnotherKindOfFileIsRefused) {
  for (const std::string& name : names_) {
    const std::string whole = read(file(name));
    fs::remove(file(name));
    fs::create_directory(file(name));
    refused(name, "it is a folder", name);
    fs::remove(file(name));
    fs::create_symlink(name, file(name));  // a link to itself cannot be read, by root neither
    refused(name, "symbolic links", name);
    fs::remove(file(name));
    write(file(name), whole);
  }
  const std::string next = read(file("solid.0001"));
  fs::remove(file("solid.0001"));
  refused("solid.0001", "missing", "no file of step 2");
  fs::copy_file(file("solid.0000"), file("solid.0001"));
  refused("solid.0001", "another run", "the file of another step");
  write(file("solid.0001"), next);
  std::string later = read(file("solid"));
  later.replace(later.find(" 1 "), 3, " 2 ");
  write(file("solid"), later);
  refused("solid", "its format is 2", "another format");
}

// Without the file itself there is no checkpoint, whatever lies beside it.
TEST_F(DamagedCheckpoint, FilesOfStepsAloneAreNone) {
  fs::remove(file("solid"));
  EXPECT_EQ(Solid(coarse()).finished_steps(stub(), loads_, checkpoint()), 0u);
}

TEST_F(DamagedCheckpoint, OfAnotherProgramIsRefused) {
  EXPECT_THAT(complaint(checkpoint("program 2"), stub(), loads_, coarse()),
              HasSubstr("written by program 1, and this is program 2"));
}

TEST_F(DamagedCheckpoint, OfAnotherProblemIsRefusedByNameOfWhatDiffers) {
  const auto expect = [&](const Cilium& cilium, const LoadPath& loads, const SolidOptions& options,
                          const std::string& name) {
    EXPECT_THAT(complaint(checkpoint(), cilium, loads, options), HasSubstr(name + " was "));
  };
  const auto other_cilium = [&](const std::string& name, const std::function<void(Cilium&)>& set) {
    Cilium cilium = stub();
    set(cilium);
    expect(cilium, loads_, coarse(), name);
  };
  other_cilium("diameter", [](Cilium& c) { c.diameter = 2.9e-3; });
  other_cilium("length of segment `base`", [](Cilium& c) { c.segments[0].length = 3.1e-3; });
  other_cilium("young_modulus of segment `magnet`",
               [](Cilium& c) { c.segments[1].young_modulus = 3000000.0000000005; });
  other_cilium("poisson_ratio of segment `base`",
               [](Cilium& c) { c.segments[0].poisson_ratio = 0.48; });
  other_cilium("magnetization of segment `magnet`",
               [](Cilium& c) { c.segments[1].magnetization = 7e4; });
  other_cilium("number of segments", [](Cilium& c) {
    c.segments.push_back({"top", 1e-3, 1e5, 0.4, 0});
  });
  const auto other_loads = [&](const std::string& name, const LoadPath& loads) {
    expect(stub(), loads, coarse(), name);
  };
  other_loads("number of load steps", path({1e-6, 2e-6, 3e-6}));
  other_loads("load of step 2", path({1e-6, 2.5e-6}));
  other_loads("load of step 1", {ContactLoad{1e-6, 4.4e-3, 0.4}, loads_[1]});
  other_loads("load of step 2", {loads_[0], ContactLoad{2e-6, 4.5e-3, 0.3}});
  other_loads("load of step 1", {SectionLoad{1e-6, 4.5e-3, 0.4}, SectionLoad{2e-6, 4.5e-3, 0.4}});
  const auto other_options = [&](const std::string& name,
                                 const std::function<void(SolidOptions&)>& set) {
    SolidOptions options = coarse();
    set(options);
    expect(stub(), loads_, options, "models.solid." + name);
  };
  using Material = SolidOptions::Material;
  other_options("material", [](SolidOptions& o) { o.material = Material::yeoh; });
  other_options("mooney_ratio", [](SolidOptions& o) { o.mooney_ratio = 0.3; });
  other_options("yeoh_ratios", [](SolidOptions& o) { o.yeoh_ratios[1] = 0.02; });
  other_options("refinement", [](SolidOptions& o) { o.refinement = 1; });
  other_options("initial_guess", [](SolidOptions& o) { o.initial_guess = InitialGuess::none; });
  other_options("symmetry", [](SolidOptions& o) { o.symmetry = false; });
  other_options("kernel_width", [](SolidOptions& o) { o.kernel_width = 0.4e-3; });
  other_options("tolerance", [](SolidOptions& o) { o.tolerance = 1e-8; });
  other_options("solver", [](SolidOptions& o) { o.solver = solvers::SolverKind::direct; });
}

// The disk is full: the program's error, not one of the solution, and what was saved is still
// there.
TEST_F(SolidCheckpointFiles, ThatCannotBeWrittenAreAnError) {
  fs::create_directory(file("solid.tmp"));
  EXPECT_THROW(Solid(coarse()).solve_from(stub(), path({1e-6}), checkpoint()), CheckpointError);
  const Checkpoint nowhere{folder_ / "none" / "solid", "program 1"};
  EXPECT_THROW(Solid(coarse()).solve_from(stub(), path({1e-6}), nowhere), CheckpointError);
}

}  // namespace
}  // namespace ciliaval::fem::solid
