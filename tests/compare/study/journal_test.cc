// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "../run/synthetic.h"
#include "problem/error.h"

namespace ciliaval::compare::study {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// A journal of three records.
std::string journal_text(const fs::path& file) {
  Journal journal(file);
  for (const char* line : {"header", "one", "two", "three"}) journal.append(line);
  return read_text(file);
}

std::string refusal(const fs::path& file) {
  try {
    const Journal journal(file);
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(Journal, GivesBackWhatWasAppended) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  // Oracle: the CRC-32 of "one" and "header" by zlib.
  EXPECT_EQ(journal_text(file).substr(0, 29), "6e72a8c1 header\n7a6c86f1 one\n");
  const Journal again(file);
  EXPECT_EQ(again.header(), "header");
  EXPECT_THAT(again.records(), ElementsAre("one", "two", "three"));
  EXPECT_EQ(again.damaged(), 0u);
}

TEST(Journal, CutAnywhereItHasTheWholeLinesAndGoesOn) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  const std::string text = journal_text(file);
  for (std::size_t length = 0; length <= text.size(); ++length) {
    SCOPED_TRACE(length);
    write(file, text.substr(0, length));
    const auto lines = static_cast<std::size_t>(
        std::count(text.begin(), text.begin() + static_cast<long>(length), '\n'));
    {
      Journal journal(file);
      EXPECT_EQ(journal.header(), lines > 0 ? "header" : "");
      EXPECT_EQ(journal.records().size(), lines > 1 ? lines - 1 : 0);
      EXPECT_EQ(journal.damaged(), length > 0 && text[length - 1] != '\n' ? 1u : 0u);
      if (lines == 0) journal.append("header");
      journal.append("new");
    }
    const Journal again(file);
    EXPECT_EQ(again.header(), "header");
    EXPECT_EQ(again.records().back(), "new");
    EXPECT_EQ(again.damaged(), 0u);
  }
}

TEST(Journal, AFlippedBitCostsItsLineAlone) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  const std::string text = journal_text(file);
  const std::size_t header = text.find('\n');
  const std::string one = text.substr(header + 1, text.find('\n', header + 1) - header - 1);
  for (std::size_t byte = header + 1; byte < header + 1 + one.size(); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = text;
      damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << bit));
      write(file, damaged);
      const Journal journal(file);
      EXPECT_THAT(journal.records(), ElementsAre("two", "three")) << byte << ' ' << bit;
      EXPECT_GE(journal.damaged(), 1u);
    }
}

TEST(Journal, WhatIsNoneIsRefusedAndLeftAsItIs) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  for (const std::string bytes :
       {"hello\n", "\n", "6e72a8c2 header\n7a6c86f1 one\n", "hello\nand more"}) {
    write(file, bytes);
    EXPECT_THAT(refusal(file), HasSubstr("is no journal")) << bytes;
    EXPECT_EQ(read_text(file), bytes);
  }
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0666), 0);
  EXPECT_THAT(refusal(file), HasSubstr("not a regular file"));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_THAT(refusal(file), HasSubstr("cannot open"));
}

TEST(Journal, FreshForgetsEverything) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  write(file, "what has nothing to do with it");
  const Journal journal(file, true);
  EXPECT_EQ(journal.header(), "");
  EXPECT_EQ(journal.damaged(), 0u);
  EXPECT_EQ(fs::file_size(file), 0u);
}

TEST(Journal, IsOpenOnce) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  {
    const Journal journal(file);
    EXPECT_THAT(refusal(file), HasSubstr("another process is running this study"));
  }
  EXPECT_EQ(refusal(file), "");
}

TEST(Journal, TakesLinesFromSeveralThreads) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  constexpr int lines = 500;
  {
    Journal journal(file);
    journal.append("header");
    std::vector<std::thread> threads;
    for (const char name : {'a', 'b', 'c', 'd'})
      threads.emplace_back([&journal, name] {
        for (int i = 0; i < lines; ++i) journal.append(name + std::to_string(i));
      });
    for (std::thread& thread : threads) thread.join();
  }
  const Journal again(file);
  const std::set<std::string> records(again.records().begin(), again.records().end());
  EXPECT_EQ(records.size(), 4u * lines);
  EXPECT_EQ(again.damaged(), 0u);
}

// Where a file may grow no further, a line is written in part, as on a full disk.
TEST(Journal, ALineThatDoesNotFitIsAFileErrorAndLeavesNoTrace) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "journal";
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit unlimited {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  {
    Journal journal(file);
    journal.append("header");
    struct rlimit limited = unlimited;
    limited.rlim_cur = 30;
    setrlimit(RLIMIT_FSIZE, &limited);
    EXPECT_NO_THROW(journal.append("a"));
    EXPECT_THROW(journal.append("a line that does not fit"), FileError);
    EXPECT_EQ(read_text(file), "6e72a8c1 header\ne8b7be43 a\n");
    setrlimit(RLIMIT_FSIZE, &unlimited);
    journal.append("b");
  }
  std::signal(SIGXFSZ, before);
  const Journal again(file);
  EXPECT_THAT(again.records(), ElementsAre("a", "b"));
  EXPECT_EQ(again.damaged(), 0u);
}

}  // namespace
}  // namespace ciliaval::compare::study
