// SPDX-License-Identifier: LGPL-2.1-or-later
// A study that is killed and started again.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "compare/output/output_file.h"
#include "compare/output/store/store.h"
#include "tests/support/study_texts.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;
using Seconds = std::chrono::duration<double>;

/// 24 points, of which the softest slip off: a second or so.
void write_files(const fs::path& folder) {
  test::write_study_case(folder);
  test::write_study(folder, test::study_text(R"(pairs = ["elastica/line", "beam/volume"]
outputs = ["dB_x", "dB_norm", "sensitivity"])",
                                             R"([[parameter]]
path = "cilium.segment.base.young_modulus"
from = "0.02 MPa"
to = "1 MPa"
count = 12
spacing = "logarithmic"
[[parameter]]
path = "load.azimuth"
values = ["0 deg", "77 deg"]
)"));
}

/// An optimisation of some thousand evaluations: a second or so.
void write_optimisation(const fs::path& folder) {
  test::write_study_case(folder);
  test::write_study(folder, test::study_text(R"(pairs = ["elastica/volume", "beam/volume"]
outputs = ["dB_x", "dB_norm", "sensitivity", "range"])",
                                             R"([optimise]
maximise = "dB_norm"
at_least.range = "2 mN"
[[parameter]]
path = "cilium.diameter"
from = "1 mm"
to = "5 mm"
[[parameter]]
path = "cilium.segment.magnet.proportion"
from = 0.05
to = 0.95
)"));
}

pid_t start(const fs::path& folder, const std::string& output) {
  const pid_t child = fork();
  if (child != 0) return child;
  const auto redirect = [](const char* file, int to) {
    dup2(open(file, O_WRONLY | O_CREAT | O_TRUNC, 0666), to);
  };
  if (chdir(folder.c_str()) != 0) _exit(126);
  redirect((output + ".out").c_str(), STDOUT_FILENO);
  redirect((output + ".err").c_str(), STDERR_FILENO);
  execl(CILIAVAL_PROGRAM, CILIAVAL_PROGRAM, "study", "varied.study.toml", "-o", output.c_str(),
        static_cast<char*>(nullptr));
  _exit(127);
}

/// The exit code, −1 of a process that was killed, −2 of one that another signal has ended.
int code_of(int status) {
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  return WTERMSIG(status) == SIGKILL ? -1 : -2;
}

/// Waits for the end.
int end_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return code_of(status);
}

/// The end of a process that is killed after a time, unless it ends before.
int killed_after(pid_t child, Seconds time) {
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() - start > time) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return code_of(status);
}

/// All files of the results but the store, whose entries are in the order in which they came.
std::map<std::string, std::string> contents(const fs::path& results) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(results))
    if (entry.path().extension() != ".sqlite")
      files[entry.path().filename().string()] = read_text(entry.path());
  return files;
}

/// Entries that the store of a study keeps.
compare::output::store::Entries kept(const fs::path& results) {
  return compare::output::store::Store(results / "points.sqlite").read("study");
}

/// Kills the study at random moments, up to five times, then lets it come to its end, and again
/// from the beginning, until it was killed so often and has gone on from its store at least once.
/// (Killed without end, it would never get there on a machine that has become slower since the
/// reference.) The files must be those of a study that nothing has disturbed, byte for byte, and
/// the store the same entries.
void kill_and_compare(int kills_wanted, void (*write)(const fs::path& folder), std::size_t files,
                      std::size_t least_entries) {
  const TemporaryFolder folder;
  write(folder.path());
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(end_of(start(folder.path(), "reference")), 0)
      << read_text(folder.path() / "reference.err");
  const Seconds whole = std::chrono::steady_clock::now() - begin;
  const auto expected = contents(folder.path() / "reference/varied");
  ASSERT_EQ(expected.size(), files);
  const auto entries = kept(folder.path() / "reference/varied");
  ASSERT_GE(entries.size(), least_entries);
  std::mt19937 random(20261122);  // NOLINT(cert-msc51-cpp): the same moments in every run
  std::uniform_real_distribution<double> moment(0, 0.9);
  int kills = 0;
  int continued = 0;
  while (kills < kills_wanted || (continued == 0 && kills < 10 * kills_wanted)) {
    fs::remove_all(folder.path() / "out");
    int code = -1;
    for (int i = 0; code != 0; ++i) {
      const pid_t child = start(folder.path(), "out");
      code = i < 5 ? killed_after(child, moment(random) * whole) : end_of(child);
      if (code == -1) ++kills;
      if (read_text(folder.path() / "out.err").find("are there already") != std::string::npos)
        ++continued;
      ASSERT_TRUE((code == -1 && i < 5) || code == 0)
          << code << read_text(folder.path() / "out.err");
    }
    EXPECT_THAT(contents(folder.path() / "out/varied"), testing::ContainerEq(expected));
    EXPECT_EQ(kept(folder.path() / "out/varied"), entries);
    EXPECT_EQ(
        read_text(folder.path() / "out.out"),
        std::string(read_text(folder.path() / "reference.out"))
            .replace(read_text(folder.path() / "reference.out").rfind("reference/"), 9, "out"));
  }
  EXPECT_GT(continued, 0);
}

// CSV, JSON, three plots; 24 points by two models.
TEST(KilledStudy, EndsWithTheSameFilesToTheLastByte) {
  kill_and_compare(5, write_files, 5, 2 * 24);
}

TEST(KilledStudySlow, EndsWithTheSameFilesToTheLastByte) {
  kill_and_compare(60, write_files, 5, 2 * 24);
}

// CSV and JSON.
TEST(KilledOptimisation, EndsWithTheSameFilesToTheLastByte) {
  kill_and_compare(3, write_optimisation, 2, 800);
}

TEST(KilledOptimisationSlow, EndsWithTheSameFilesToTheLastByte) {
  kill_and_compare(60, write_optimisation, 2, 800);
}

TEST(KilledStudy, TwoAtOnceInOneFolderAreRefused) {
  const TemporaryFolder folder;
  write_files(folder.path());
  const pid_t first = start(folder.path(), "out");
  const fs::path store = folder.path() / "out/varied/points.sqlite";
  while (!fs::exists(store) || fs::file_size(store) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(first, SIGSTOP);
  const pid_t second = fork();
  if (second == 0) {
    if (chdir(folder.path().c_str()) != 0) _exit(126);
    dup2(open("second.err", O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
    execl(CILIAVAL_PROGRAM, CILIAVAL_PROGRAM, "study", "varied.study.toml", "-o", "out", "--fresh",
          static_cast<char*>(nullptr));
    _exit(127);
  }
  EXPECT_EQ(end_of(second), 4);
  EXPECT_THAT(read_text(folder.path() / "second.err"),
              HasSubstr("another run writes to `out/varied/points.sqlite`"));
  kill(first, SIGCONT);
  EXPECT_EQ(end_of(first), 0) << read_text(folder.path() / "out.err");
}

TEST(KilledStudy, WhatItLeftUnfinishedGoesWithTheNextStart) {
  const TemporaryFolder folder;
  write_files(folder.path());
  ASSERT_EQ(end_of(start(folder.path(), "out")), 0) << read_text(folder.path() / "out.err");
  const fs::path results = folder.path() / "out/varied";
  const auto expected = contents(results);
  if (const pid_t child = fork(); child != 0) {
    ASSERT_EQ(end_of(child), -1);
  } else {
    compare::output::write_file(results / "study.json", [](const fs::path& temporary) {
      std::ofstream(temporary) << "half a file" << std::flush;
      raise(SIGKILL);
    });
    _exit(1);
  }
  std::ofstream(results / ".dB_x.4711.0.tmp.svg") << "half a figure";
  ASSERT_EQ(contents(results).size(), expected.size() + 2);
  std::ofstream(results / ".study.notes.tmp.csv") << "the user's";
  ASSERT_EQ(end_of(start(folder.path(), "out")), 0) << read_text(folder.path() / "out.err");
  auto after = contents(results);
  EXPECT_EQ(after.erase(".study.notes.tmp.csv"), 1);
  EXPECT_THAT(after, testing::ContainerEq(expected));
}

}  // namespace
}  // namespace ciliaval
