// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/output_folder.h"
#include "compare/output/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;

/// This host as it stands in the name of a temporary folder.
std::string this_host() {
  std::array<char, 256> text{};
  gethostname(text.data(), text.size() - 1);
  std::string name = text.data();
  std::ranges::replace(name, '.', '_');
  return name;
}

/// Name of a process's temporary folder of the case.
fs::path temporary_of(const fs::path& directory, const std::string& name, const std::string& host,
                      pid_t pid, const std::string& extension = ".tmp") {
  return directory / ("." + name + "." + host + "." + std::to_string(pid) + extension);
}

/// The id of a process that has ended.
pid_t dead_process() {
  const pid_t pid = fork();
  if (pid == 0) _exit(0);
  waitpid(pid, nullptr, 0);
  return pid;
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// Text by which the tests below tell results apart.
std::string summary(const std::string& title) {
  return R"({"schema": 1, "title": ")" + title + "\"}";
}

void write_results_of(const fs::path& directory, const std::string& title) {
  output::OutputFolder folder(directory, "case");
  output::write_file(folder.path() / "summary.json", summary(title));
  folder.commit();
}

TEST(OutputFolder, PutsTheNewResultsInThePlaceOfTheOld) {
  const TemporaryFolder out;
  const fs::path directory = out.path() / "deep" / "results";
  {
    output::OutputFolder folder(directory, "case");
    output::write_file(folder.path() / "beam_0007.csv", "only in the old results");
    folder.commit();
  }
  write_results_of(directory, "new");
  EXPECT_EQ(read_text(directory / "case" / "summary.json"), summary("new"));
  EXPECT_FALSE(fs::exists(directory / "case" / "beam_0007.csv"));
  EXPECT_EQ(entries(directory), 1u);
}

TEST(OutputFolder, LeavesTheOldResultsIfAnErrorEndsTheRun) {
  const TemporaryFolder out;
  write_results_of(out.path(), "old");
  EXPECT_THROW(
      {
        const output::OutputFolder folder(out.path(), "case");
        output::write_file(folder.path() / "summary.json", "half of the n");
        throw std::runtime_error("a failure midway");
      },
      std::runtime_error);
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), summary("old"));
  EXPECT_EQ(entries(out.path()), 1u);
}

TEST(OutputFolder, AKilledRunLeavesTheOldResultsAndTheNextOneCleansUp) {
  const TemporaryFolder out;
  write_results_of(out.path(), "old");
  const pid_t child = fork();
  if (child == 0) {
    const output::OutputFolder folder(out.path(), "case");
    output::write_file(folder.path() / "summary.json", "half of the n");
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), summary("old"));
  EXPECT_EQ(entries(out.path()), 2u);  // and what the killed one has left
  write_results_of(out.path(), "new");
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), summary("new"));
  EXPECT_EQ(entries(out.path()), 1u);
}

TEST(OutputFolder, DoesNotTouchWhatALivingProcessOrAnotherCaseWrites) {
  const TemporaryFolder out;
  const fs::path living = temporary_of(out.path(), "case", this_host(), getppid());
  const fs::path other = temporary_of(out.path(), "other", this_host(), dead_process());
  const fs::path file = out.path() / ".case.notes.tmp";
  for (const fs::path& folder : {living, other, file}) fs::create_directory(folder);
  write_results_of(out.path(), "new");
  EXPECT_TRUE(fs::exists(living));
  EXPECT_TRUE(fs::exists(other));
  EXPECT_TRUE(fs::exists(file));
}

// On a folder that several computers share, a process of another one cannot be asked whether it
// lives, and its number may be that of none here.
TEST(OutputFolder, DoesNotTouchWhatAnotherHostWrites) {
  const TemporaryFolder out;
  const pid_t pid = dead_process();
  std::vector<fs::path> kept;
  for (const std::string& host : {std::string("otherhost"), "x" + this_host(), this_host() + "x",
                                  "node7." + this_host(), this_host() + "." + this_host()})
    for (const char* extension : {".tmp", ".old"})
      kept.push_back(temporary_of(out.path(), "case", host, pid, extension));
  kept.push_back(out.path() / (".case." + std::to_string(pid) + ".tmp"));  // of an unknown host
  for (const fs::path& folder : kept) fs::create_directory(folder);
  const fs::path own = temporary_of(out.path(), "case", this_host(), pid);
  fs::create_directory(own);
  write_results_of(out.path(), "new");
  for (const fs::path& folder : kept) EXPECT_TRUE(fs::exists(folder)) << folder;
  EXPECT_FALSE(fs::exists(own));
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), summary("new"));
}

TEST(OutputFolder, PutsOldResultsBackThatWereMovedAsideWhenTheProgramWasKilled) {
  const TemporaryFolder out;
  const fs::path aside = temporary_of(out.path(), "case", this_host(), dead_process(), ".old");
  write_results_of(out.path(), "old");
  fs::rename(out.path() / "case", aside);
  { const output::OutputFolder folder(out.path(), "case"); }
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), summary("old"));
  EXPECT_EQ(entries(out.path()), 1u);
}

// Killed between the two renames: the new results are complete.
TEST(OutputFolder, PutsNewResultsInPlaceWhereTheOldOnesWereMovedAside) {
  const TemporaryFolder out;
  const pid_t pid = dead_process();
  write_results_of(out.path(), "old");
  fs::rename(out.path() / "case", temporary_of(out.path(), "case", this_host(), pid, ".old"));
  write_results_of(out.path() / "elsewhere", "new");
  fs::rename(out.path() / "elsewhere" / "case", temporary_of(out.path(), "case", this_host(), pid));
  fs::remove(out.path() / "elsewhere");
  { const output::OutputFolder folder(out.path(), "case"); }
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), summary("new"));
  EXPECT_EQ(entries(out.path()), 1u);
}

TEST(OutputFolder, SaysWhichFolderCannotBeWrittenAndWhy) {
  const TemporaryFolder out;
  output::write_file(out.path() / "file", "a regular file");
  try {
    const output::OutputFolder folder(out.path() / "file" / "results", "case");
    FAIL() << "a folder below a regular file";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("file/results"));
    EXPECT_THAT(error.what(), testing::HasSubstr("Not a directory"));
  }
  EXPECT_THROW(output::OutputFolder("/proc/ciliaval", "case"), FileError);
  output::write_file(out.path() / "case", "a file where the folder should go");
  EXPECT_THROW(output::OutputFolder(out.path(), "case"), FileError);
  EXPECT_EQ(entries(out.path()), 2u);
}

/// Files of a run.
void write_run(const fs::path& directory) {
  output::OutputFolder folder(directory, "case");
  fs::create_directories(folder.path() / "vtk");
  for (const char* name : {"summary.json", "elastica_0000.csv", "vtk/open.py"})
    output::write_file(folder.path() / name, "result");
  folder.commit();
}

std::string refusal(const fs::path& directory) {
  try {
    const output::OutputFolder folder(directory, "case");
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(OutputFolder, ReplacesAFormerResultOfTheCaseAndAnEmptyFolder) {
  const TemporaryFolder out;
  fs::create_directory(out.path() / "case");
  EXPECT_EQ(refusal(out.path()), "accepted");
  write_run(out.path());
  EXPECT_EQ(refusal(out.path()), "accepted");
  output::write_file(out.path() / "case" / "report.html", "by `ciliaval report`");
  fs::remove(out.path() / "case" / "elastica_0000.csv");
  EXPECT_EQ(refusal(out.path()), "accepted");
}

TEST(OutputFolder, RefusesToReplaceWhatItDidNotWrite) {
  for (const char* name : {"notes.txt", "view.pvsm", "measured_0001.csv", "vtk/picture.png",
                           "vtk/body_mine.pvd", ".hidden", "summary.json.bak", "vtk/old/open.py"}) {
    const TemporaryFolder out;
    write_run(out.path());
    fs::create_directories((out.path() / "case" / name).parent_path());
    output::write_file(out.path() / "case" / name, "precious");
    const std::string first = name == std::string("vtk/old/open.py") ? "vtk/old" : name;
    EXPECT_THAT(refusal(out.path()), testing::HasSubstr("`" + first + "`"));
    EXPECT_THAT(refusal(out.path()), testing::HasSubstr("-o DIR"));
    EXPECT_EQ(read_text(out.path() / "case" / name), "precious");
    EXPECT_EQ(entries(out.path()), 1u);
  }
}

TEST(OutputFolder, RefusesAFolderWithoutItsList) {
  const TemporaryFolder out;
  write_run(out.path());
  fs::remove(out.path() / "case" / ".ciliaval");
  output::write_file(out.path() / "case" / "report.html", "kept alone, it is the user's too");
  EXPECT_THAT(refusal(out.path()), testing::HasSubstr("`elastica_0000.csv`"));
  EXPECT_TRUE(fs::exists(out.path() / "case" / "summary.json"));
}

TEST(OutputFolder, RefusesALinkBeforeAnythingRuns) {
  const TemporaryFolder out;
  fs::create_directory(out.path() / "elsewhere");
  fs::create_directory_symlink("elsewhere", out.path() / "case");
  EXPECT_THAT(refusal(out.path()), testing::HasSubstr("link to `elsewhere`"));
  fs::remove(out.path() / "elsewhere");  // now it leads nowhere
  EXPECT_THAT(refusal(out.path()), testing::HasSubstr("link to `elsewhere`"));
  EXPECT_EQ(entries(out.path()), 1u);
}

TEST(OutputFolder, KeepsTheNewResultsIfTheyCannotBePutInPlace) {
  const TemporaryFolder out;
  write_results_of(out.path(), "old");
  std::string message;
  {
    output::OutputFolder folder(out.path(), "case");
    output::write_file(folder.path() / "summary.json", summary("new"));
    output::write_file(out.path() / "case" / "notes.txt", "written while the models ran");
    try {
      folder.commit();
    } catch (const FileError& error) {
      message = error.what();
    }
  }
  EXPECT_THAT(message, testing::HasSubstr("notes.txt"));
  const fs::path kept = out.path() / ("case." + std::to_string(getpid()) + ".new");
  EXPECT_THAT(message, testing::HasSubstr(kept.string()));
  EXPECT_EQ(read_text(kept / "summary.json"), summary("new"));
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), summary("old"));
  EXPECT_TRUE(fs::exists(out.path() / "case" / "notes.txt"));
}

}  // namespace
}  // namespace ciliaval::compare
