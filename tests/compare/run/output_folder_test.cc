// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "compare/results.h"
#include "problem/error.h"
#include "synthetic.h"

namespace ciliaval::compare {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;

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

void write_results_of(const fs::path& directory, const std::string& text) {
  OutputFolder folder(directory, "case");
  write_text(folder.path() / "summary.json", text);
  folder.commit();
}

TEST(OutputFolder, PutsTheNewResultsInThePlaceOfTheOld) {
  const TemporaryFolder out;
  const fs::path directory = out.path() / "deep" / "results";
  write_results_of(directory, "old");
  write_text(directory / "case" / "left_over.csv", "only in the old results");
  write_results_of(directory, "new");
  EXPECT_EQ(read_text(directory / "case" / "summary.json"), "new");
  EXPECT_FALSE(fs::exists(directory / "case" / "left_over.csv"));
  EXPECT_EQ(entries(directory), 1u);
}

TEST(OutputFolder, LeavesTheOldResultsIfAnErrorEndsTheRun) {
  const TemporaryFolder out;
  write_results_of(out.path(), "old");
  EXPECT_THROW(
      {
        const OutputFolder folder(out.path(), "case");
        write_text(folder.path() / "summary.json", "half of the n");
        throw std::runtime_error("a failure midway");
      },
      std::runtime_error);
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), "old");
  EXPECT_EQ(entries(out.path()), 1u);
}

TEST(OutputFolder, AKilledRunLeavesTheOldResultsAndTheNextOneCleansUp) {
  const TemporaryFolder out;
  write_results_of(out.path(), "old");
  const pid_t child = fork();
  if (child == 0) {
    const OutputFolder folder(out.path(), "case");
    write_text(folder.path() / "summary.json", "half of the n");
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), "old");
  EXPECT_EQ(entries(out.path()), 2u);  // and what the killed one has left
  write_results_of(out.path(), "new");
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), "new");
  EXPECT_EQ(entries(out.path()), 1u);
}

TEST(OutputFolder, DoesNotTouchWhatALivingProcessOrAnotherCaseWrites) {
  const TemporaryFolder out;
  const fs::path living = out.path() / (".case." + std::to_string(getppid()) + ".tmp");
  const fs::path other = out.path() / (".other." + std::to_string(dead_process()) + ".tmp");
  const fs::path file = out.path() / ".case.notes.tmp";
  for (const fs::path& folder : {living, other, file}) fs::create_directory(folder);
  write_results_of(out.path(), "new");
  EXPECT_TRUE(fs::exists(living));
  EXPECT_TRUE(fs::exists(other));
  EXPECT_TRUE(fs::exists(file));
}

TEST(OutputFolder, PutsOldResultsBackThatWereMovedAsideWhenTheProgramWasKilled) {
  const TemporaryFolder out;
  const fs::path aside = out.path() / (".case." + std::to_string(dead_process()) + ".old");
  fs::create_directory(aside);
  write_text(aside / "summary.json", "old");
  { const OutputFolder folder(out.path(), "case"); }
  EXPECT_EQ(read_text(out.path() / "case" / "summary.json"), "old");
  EXPECT_EQ(entries(out.path()), 1u);
}

TEST(OutputFolder, SaysWhichFolderCannotBeWrittenAndWhy) {
  const TemporaryFolder out;
  write_text(out.path() / "file", "a regular file");
  try {
    const OutputFolder folder(out.path() / "file" / "results", "case");
    FAIL() << "a folder below a regular file";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("file/results"));
    EXPECT_THAT(error.what(), testing::HasSubstr("Not a directory"));
  }
  EXPECT_THROW(OutputFolder("/proc/ciliaval", "case"), FileError);
  write_text(out.path() / "case", "a file where the folder should go");
  EXPECT_THROW(OutputFolder(out.path(), "case"), FileError);
  EXPECT_EQ(entries(out.path()), 2u);
}

}  // namespace
}  // namespace ciliaval::compare
