// SPDX-License-Identifier: LGPL-2.1-or-later
// The program, killed and started again.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "compare/output/store/store.h"
#include "tests/support/synthetic.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;
using Seconds = std::chrono::duration<double>;

/// A short cilium and small steps, solved on the coarse mesh in some seconds.
void write_restart_case(const fs::path& folder, const std::string& solid = "",
                        const std::string& forces = R"(["0.5 mN", "1 mN", "1.5 mN", "2 mN"])") {
  std::ofstream(folder / "case.toml") << test::case_text(
      {.name = "killed", .magnet_length = "3 mm", .force = forces, .height = "4.5 mm"},
      R"(mechanics = ["elastica", "solid"]
fields = ["line", "mesh"]
[models.solid]
refinement = 0
)" + solid);
}

struct RestartOutcome {
  bool killed = false;
  int code = -1;
  std::string err;
};

/// Runs `ciliaval run case.toml -o out …` and kills it with SIGKILL as soon as `kill_now()` says
/// so.
RestartOutcome run(const fs::path& folder, const std::vector<std::string>& arguments,
                   const std::function<bool()>& kill_now) {
  const pid_t child = fork();
  if (child == 0) {
    const auto redirect = [](const char* file, int to) {
      dup2(open(file, O_WRONLY | O_CREAT | O_TRUNC, 0666), to);
    };
    if (chdir(folder.c_str()) != 0) _exit(126);
    redirect("out.txt", STDOUT_FILENO);
    redirect("err.txt", STDERR_FILENO);
    std::vector<std::string> words{CILIAVAL_PROGRAM, "run", "case.toml"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv(CILIAVAL_PROGRAM, argv.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (kill_now()) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  RestartOutcome outcome;
  outcome.killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  outcome.err = read_text(folder / "err.txt");
  return outcome;
}

fs::path store_in(const fs::path& folder) {
  return folder / "out" / ".killed.sqlite";
}

bool never() {
  return false;
}

std::function<bool()> after(Seconds time) {
  return [time, start = std::chrono::steady_clock::now()] {
    return std::chrono::steady_clock::now() - start > time;
  };
}

const std::vector<std::string> to_out{"-o", "out"};

/// The results without what says when and how they were made.
std::vector<std::pair<std::string, std::string>> contents(const fs::path& results) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(results))
    if (const fs::path name = entry.path().filename();
        entry.is_regular_file() && name != "summary.json")
      files.emplace_back(entry.path().filename().string(), read_text(entry.path()));
  std::sort(files.begin(), files.end());
  auto summary = nlohmann::json::parse(read_text(results / "summary.json"));
  summary.erase("provenance");
  const std::function<void(nlohmann::json&)> untimed = [&](nlohmann::json& node) {
    if (node.is_object()) node.erase("seconds");
    if (node.is_structured())
      for (auto& child : node) untimed(child);
  };
  untimed(summary);
  files.emplace_back("summary.json", summary.dump(1));
  return files;
}

/// Kills the program at random moments, up to five times, then lets it come to its end (or a
/// machine that has become slower since the reference would never get there), and again from the
/// beginning, until it was killed so often and has gone on from a checkpoint at least once. The
/// results must be those of a run that nothing has disturbed, to the last digit: the text of all
/// files.
void kill_and_compare(int kills_wanted) {
  const TemporaryFolder folder;
  write_restart_case(folder.path());
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run(folder.path(), {"-o", "reference"}, never).code, 0);
  const Seconds whole = std::chrono::steady_clock::now() - start;
  const auto expected = contents(folder.path() / "reference" / "killed");
  std::mt19937 random(20261121);  // NOLINT(cert-msc51-cpp): the same moments in every run
  std::uniform_real_distribution<double> moment(0, 0.8);
  int kills = 0;
  int continued = 0;
  while (kills < kills_wanted || (continued == 0 && kills < 10 * kills_wanted)) {
    fs::remove_all(folder.path() / "out");
    RestartOutcome outcome;
    for (int i = 0; outcome.code != 0; ++i) {
      outcome = run(folder.path(), to_out, i < 5 ? after(moment(random) * whole) : never);
      kills += outcome.killed;
      continued += outcome.err.find("goes on at step") != std::string::npos;
      ASSERT_TRUE((outcome.killed && i < 5) || outcome.code == 0) << outcome.err;
    }
    EXPECT_EQ(contents(folder.path() / "out" / "killed"), expected) << "after " << kills;
    EXPECT_FALSE(fs::exists(store_in(folder.path())));
  }
  EXPECT_GT(continued, 0) << "no run went on from a checkpoint";
}

// Oracle: an undisturbed run.
TEST(Restart, AKilledRunEndsWithTheSameDigits) {
  kill_and_compare(2);
}
TEST(RestartSlow, ARunKilledAtTwentyRandomMomentsEndsWithTheSameDigits) {
  kill_and_compare(20);
}

/// Leaves the store of a run that was killed after its second step. SQLite writes the two columns
/// of an entry's name side by side.
void interrupt(const fs::path& folder) {
  const RestartOutcome outcome = run(folder, to_out, [&] {
    for (const char* log : {"", "-wal"})
      if (const fs::path file = store_in(folder).string() + log;
          fs::exists(file) && read_text(file).find("solid2") != std::string::npos) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the rest of the transaction
        return true;
      }
    return false;
  });
  ASSERT_TRUE(outcome.killed) << outcome.err;
}

TEST(Restart, SaysWhereItGoesOnAndFreshStartsAnew) {
  const TemporaryFolder folder;
  write_restart_case(folder.path());
  interrupt(folder.path());
  const RestartOutcome again = run(folder.path(), to_out, never);
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err, testing::ContainsRegex("case \"killed\": solid goes on at step [34]/4"));
  EXPECT_THAT(again.err, HasSubstr("--fresh"));
  fs::remove_all(folder.path() / "out");
  interrupt(folder.path());
  const RestartOutcome fresh = run(folder.path(), {"-o", "out", "--fresh", "--quiet"}, never);
  EXPECT_EQ(fresh.code, 0);
  EXPECT_EQ(fresh.err, "");
  EXPECT_FALSE(fs::exists(store_in(folder.path())));
}

// Damaged, or of a case that was changed since: exit code 4 before anything is written, and the
// checkpoint is still there. Keys that do not touch the solid may be changed.
TEST(Restart, ACheckpointThatCannotBeUsedIsRefused) {
  const TemporaryFolder folder;
  write_restart_case(folder.path());
  interrupt(folder.path());
  const fs::path file = store_in(folder.path());
  {
    const compare::output::store::Store merged(file);  // with what the kill has left beside it
  }
  const std::string good = read_text(file);
  const auto refused = [&](const std::string& why) {
    const std::string before = read_text(file);
    const RestartOutcome outcome = run(folder.path(), to_out, never);
    EXPECT_EQ(outcome.code, 4) << why;
    EXPECT_THAT(outcome.err, HasSubstr("out/.killed.sqlite"));
    EXPECT_THAT(outcome.err, HasSubstr(why));
    EXPECT_THAT(outcome.err, HasSubstr("--fresh"));
    EXPECT_FALSE(fs::exists(folder.path() / "out" / "killed"));
    EXPECT_EQ(read_text(file), before);
  };
  std::ofstream(file, std::ios::binary) << good.substr(0, good.size() / 2);
  refused("damaged");
  std::ofstream(file, std::ios::binary) << std::string(good).replace(good.size() / 2, 8, 8, '!');
  refused("damaged");
  std::ofstream(file, std::ios::binary) << good;
  write_restart_case(folder.path(), "newton_tolerance = 1e-8\n");
  refused("models.solid.newton_tolerance was");
  write_restart_case(folder.path(), "", R"(["0.5 mN", "1 mN", "1.25 mN", "2 mN"])");
  refused("load.force was");
  write_restart_case(folder.path(), "max_iterations = 30\n[models.line]\ntolerance = 1e-9\n");
  EXPECT_EQ(run(folder.path(), to_out, never).code, 0);
}

// Behind a link to anything, a store included, nothing is read or deleted.
TEST(Restart, ALinkInPlaceOfTheStoreIsRefusedByFreshToo) {
  const TemporaryFolder folder;
  write_restart_case(folder.path());
  fs::create_directory(folder.path() / "out");
  std::ofstream(folder.path() / "thesis") << "all of it";
  fs::create_symlink("../thesis", store_in(folder.path()));
  for (const std::vector<std::string>& arguments : {to_out, {"-o", "out", "--fresh"}}) {
    const RestartOutcome outcome = run(folder.path(), arguments, never);
    EXPECT_EQ(outcome.code, 4);
    EXPECT_THAT(outcome.err, HasSubstr("out/.killed.sqlite` cannot be used and was left as it is: "
                                       "it is a link"));
  }
  EXPECT_EQ(read_text(folder.path() / "thesis"), "all of it");
}

// One run at a time has the store.
TEST(Restart, ASecondRunOfTheSameCaseIsRefusedWhileTheFirstGoesOn) {
  const TemporaryFolder folder;
  write_restart_case(folder.path());
  RestartOutcome second;
  run(folder.path(), to_out, [&] {
    if (second.code >= 0) return true;
    if (!fs::exists(store_in(folder.path()))) return false;
    fs::create_directory(folder.path() / "second");
    fs::copy_file(folder.path() / "case.toml", folder.path() / "second" / "case.toml");
    second = run(folder.path() / "second", {"-o", "../out"}, never);
    return true;
  });
  EXPECT_EQ(second.code, 4);
  EXPECT_THAT(second.err, HasSubstr("another run writes to"));
}

// One iteration is not enough for the second step: the message has the step, the residuals, the
// last load that converged; stderr names the store, from which more iterations go on.
TEST(Restart, AFailedStepCanBeGoneOnFromWithMoreIterations) {
  const TemporaryFolder folder;
  const std::string forces = R"(["1e-6 mN", "4 mN"])";
  const std::string options = "initial_guess = \"none\"\nmax_cutbacks = 0\nmax_iterations = ";
  write_restart_case(folder.path(), options + "3\n", forces);
  const RestartOutcome failed = run(folder.path(), to_out, never);
  EXPECT_EQ(failed.code, 3);
  EXPECT_THAT(failed.err, HasSubstr("out/.killed.sqlite"));
  EXPECT_THAT(failed.err, HasSubstr("max_iterations"));
  const auto solid = [&] {
    const std::string text = read_text(folder.path() / "out" / "killed" / "summary.json");
    return nlohmann::json::parse(text)["steps"][1]["mechanics"]["solid"];
  };
  EXPECT_EQ(solid()["status"], "failed");
  const std::string message = solid()["message"];
  EXPECT_THAT(message, HasSubstr("step 2/2"));
  EXPECT_THAT(message, HasSubstr("relative residuals"));
  EXPECT_THAT(message, HasSubstr("the last load that converged is 1e-09 N"));
  write_restart_case(folder.path(), options + "25\n", forces);
  const RestartOutcome again = run(folder.path(), to_out, never);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("goes on at step 2/2"));
  EXPECT_EQ(solid()["status"], "converged");
  EXPECT_FALSE(fs::exists(store_in(folder.path())));
}

}  // namespace
}  // namespace ciliaval
