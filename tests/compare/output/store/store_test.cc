// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/store/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "problem/error.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::compare::output::store {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::SizeIs;

class StoreFile : public testing::Test {
 protected:
  /// The files in the folder.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
      all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }

  test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
  const fs::path file_ = folder_ / "case.sqlite";
};

std::string read_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}
void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

const support::Fingerprint of_the_case{{"program", "ciliaval 1"}, {"diameter", "0.003 m"}};

/// Every byte there is, and several of SQLite's pages.
std::string blob() {
  std::string bytes;
  for (int i = 0; i < 20'000; ++i) bytes += static_cast<char>(i % 251);
  return bytes;
}

void fill(const fs::path& file) {
  Store store(file);
  store.require_fingerprint("solid", of_the_case);
  store.write("solid", {{"1", "one"}, {"2", blob()}});
  store.write("beam", {{"1", ""}});
}

/// Message with which opening the file is refused; empty if it is not.
std::string refusal(const fs::path& file, bool fresh = false) {
  try {
    Store(file, {}, fresh).require_fingerprint("solid", of_the_case);
  } catch (const CheckpointError& error) {
    return error.what();
  }
  return {};
}

TEST_F(StoreFile, GivesBackWhatWasWritten) {
  fill(file_);
  EXPECT_THAT(names(), ElementsAre("case.sqlite"));
  Store store(file_);
  EXPECT_THAT(store.read("solid"), ElementsAre(Pair("1", "one"), Pair("2", blob())));
  EXPECT_THAT(store.read("beam"), ElementsAre(Pair("1", "")));
  EXPECT_THAT(store.read("elastica"), IsEmpty());
  store.write("solid", {{"1", "other"}});
  EXPECT_THAT(store.read("solid"), ElementsAre(Pair("1", "other"), Pair("2", blob())));
}

TEST_F(StoreFile, WithoutEntriesOrRemovedLeavesNothingBehind) {
  Store(file_).require_fingerprint("solid", of_the_case);
  EXPECT_THAT(names(), IsEmpty());
  fill(file_);
  Store(file_).remove();
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(StoreFile, OfAnotherFingerprintIsRefusedByNameOfWhatDiffers) {
  fill(file_);
  Store store(file_);
  EXPECT_NO_THROW(store.require_fingerprint("solid", of_the_case));
  EXPECT_NO_THROW(store.require_fingerprint("elastica", {{"program", "ciliaval 2"}}));
  try {
    store.require_fingerprint("solid", {{"program", "ciliaval 1"}, {"diameter", "0.004 m"}});
    FAIL();
  } catch (const CheckpointError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(file_.string()), HasSubstr("--fresh"),
                                    HasSubstr("diameter was 0.003 m, now it is 0.004 m")));
  }
}

// Nothing is lost where nothing was finished: the case may be changed.
TEST_F(StoreFile, AFingerprintWithoutEntriesMayChange) {
  fill(file_);
  Store store(file_);
  store.require_fingerprint("elastica", {{"program", "ciliaval 1"}});
  EXPECT_NO_THROW(store.require_fingerprint("elastica", {{"program", "ciliaval 2"}}));
}

TEST(Difference, NamesThreeAndCountsTheOthers) {
  const support::Fingerprint kept{{"a", "1"}, {"b", "2"}, {"c", "3"}, {"d", "4"}, {"e", "5"}};
  EXPECT_EQ(difference(kept, kept), "");
  EXPECT_EQ(difference(kept, {{"a", "1"}, {"b", "2"}, {"c", "3"}, {"d", "4"}, {"f", "5"}}),
            "f was not given, now it is 5; e was 5, now it is not given");
  EXPECT_THAT(difference(kept, {{"a", "9"}, {"b", "9"}, {"c", "9"}, {"d", "9"}, {"e", "9"}}),
              HasSubstr("; c was 3, now it is 9; and 2 more"));
}

// A process killed at any moment between two writes, or in one: what was written is there, nothing
// else, and the next process goes on.
TEST_F(StoreFile, OfAKilledProcessHasAllThatWasWritten) {
  for (int round = 1; round <= 5; ++round) {
    SCOPED_TRACE(round);
    std::array<int, 2> pipe_ends{};
    ASSERT_EQ(pipe(pipe_ends.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
      Store store(file_);
      auto next = static_cast<unsigned char>(store.read("points").size());
      for (; next < 250; ++next) {
        store.write("points", {{std::to_string(next), blob()}});
        if (::write(pipe_ends[1], &next, 1) != 1) _exit(1);
      }
      _exit(0);
    }
    close(pipe_ends[1]);
    unsigned char last = 0;
    for (int i = 0; i < 7 * round; ++i) ASSERT_EQ(::read(pipe_ends[0], &last, 1), 1);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    while (::read(pipe_ends[0], &last, 1) == 1) {
    }
    close(pipe_ends[0]);
    const Store store(file_);
    const Entries points = store.read("points");
    EXPECT_GE(points.size(), last + 1U);  // the one on its way may be there as well
    EXPECT_LE(points.size(), last + 2U);
    for (const auto& [name, bytes] : points) EXPECT_EQ(bytes, blob()) << name;
  }
}

// A power cut may leave a log cut anywhere. Whole transactions remain.
TEST_F(StoreFile, WithALogCutShortHasWholeTransactions) {
  std::array<int, 2> pipe_ends{};
  ASSERT_EQ(pipe(pipe_ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    Store store(file_);
    store.write("solid", {{"1", "one"}, {"state", "of 1"}});
    store.write("solid", {{"2", "two"}, {"state", "of 2"}});
    _exit(::write(pipe_ends[1], "x", 1) == 1 ? 0 : 1);
  }
  close(pipe_ends[1]);
  waitpid(child, nullptr, 0);
  close(pipe_ends[0]);
  const fs::path log = folder_ / "case.sqlite-wal";
  const std::string database = read_bytes(file_);
  const std::string bytes = read_bytes(log);
  ASSERT_GT(bytes.size(), 4096U);
  std::set<std::size_t> sizes;
  for (std::size_t length = bytes.size();; length -= std::min<std::size_t>(length, 700)) {
    write_bytes(file_, database);
    write_bytes(log, bytes.substr(0, length));
    const Entries entries = Store(file_).read("solid");
    sizes.insert(entries.size());
    if (entries.contains("2")) {
      EXPECT_EQ(entries.at("state"), "of 2");
    } else if (entries.contains("1")) {
      EXPECT_EQ(entries.at("state"), "of 1");
    }
    if (length == 0) break;
  }
  EXPECT_THAT(sizes, ElementsAre(0U, 2U, 3U));
}

TEST_F(StoreFile, CutShortAtAnyLengthIsRefusedAndFreshStartsAnew) {
  fill(file_);
  const std::string whole = read_bytes(file_);
  std::vector<std::size_t> lengths{20, 99, 100, 511, 512, 1000, 4095, 4096};
  for (std::size_t length = 4097; length < whole.size(); length += 1993) lengths.push_back(length);
  for (const std::size_t length : lengths) {
    write_bytes(file_, whole.substr(0, length));
    EXPECT_THAT(refusal(file_),
                AllOf(HasSubstr(file_.string()), HasSubstr("damaged"), HasSubstr("--fresh")))
        << length;
    EXPECT_EQ(refusal(file_, true), "") << length;
  }
}

// Two bits of each byte of the head of the file, and one of every 31st byte of the rest. The few
// that no content depends on do no harm.
TEST_F(StoreFile, AFlippedBitIsRefusedOrDoesNoHarm) {
  fill(file_);
  const std::string whole = read_bytes(file_);
  std::size_t refused = 0;
  std::size_t flipped_bits = 0;
  const auto flip = [&](std::size_t place, int bit) {
    std::string flipped = whole;
    flipped[place] = static_cast<char>(flipped[place] ^ (1 << bit));
    write_bytes(file_, flipped);
    ++flipped_bits;
    try {
      Store store(file_);
      store.require_fingerprint("solid", of_the_case);
      EXPECT_TRUE(store.read("solid") == (Entries{{"1", "one"}, {"2", blob()}}))
          << "byte " << place << " bit " << bit;
      EXPECT_THAT(store.read("beam"), SizeIs(1)) << "byte " << place << " bit " << bit;
    } catch (const CheckpointError& error) {
      ++refused;
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
      EXPECT_THAT(error.what(), HasSubstr("-o DIR"));
    }
    for (const char* end : {"-wal", "-journal"}) fs::remove(file_.string() + end);
  };
  for (std::size_t place = 0; place < 100; ++place)
    for (const int bit : {0, 6}) flip(place, bit);
  for (std::size_t place = 100; place < whole.size(); place += 31)
    flip(place, static_cast<int>(place % 8));
  EXPECT_GT(refused, flipped_bits / 3);
}

TEST_F(StoreFile, ADamagedContentIsNamed) {
  fill(file_);
  std::string bytes = read_bytes(file_);
  bytes[bytes.find("one")] = 'O';
  write_bytes(file_, bytes);
  EXPECT_THAT(refusal(file_),
              AllOf(HasSubstr("checksum"), HasSubstr("1 of solid"), HasSubstr("--fresh")));
  EXPECT_TRUE(read_bytes(file_) == bytes);
  EXPECT_EQ(refusal(file_, true), "");
}

// Not by --fresh either.
TEST_F(StoreFile, WhatIsNotAStoreIsRefusedAndLeftAsItIs) {
  const fs::path foreign = folder_ / "foreign.sqlite";
  sqlite3* database = nullptr;
  sqlite3_open(foreign.c_str(), &database);
  sqlite3_exec(database, "CREATE TABLE entries (x); INSERT INTO entries VALUES (1)", nullptr,
               nullptr, nullptr);
  sqlite3_close(database);
  for (const std::string& bytes :
       {std::string("hello\n"), std::string("\0", 1), blob(), read_bytes(foreign)}) {
    write_bytes(file_, bytes);
    for (const bool fresh : {false, true}) {
      EXPECT_THAT(refusal(file_, fresh), AllOf(HasSubstr(file_.string()), HasSubstr("no store"),
                                               HasSubstr("move it away")));
      EXPECT_TRUE(read_bytes(file_) == bytes);
    }
  }
}

// Nor is a study's store under a run's name, which holds what no run of a case can.
TEST_F(StoreFile, OfAnotherOwnerIsRefusedAndLeftAsItIs) {
  fill(file_);
  const std::string bytes = read_bytes(file_);
  for (const bool fresh : {false, true}) {
    try {
      Store(file_, {"solid", "elastica"}, fresh);
      FAIL();
    } catch (const CheckpointError& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr(file_.string()), HasSubstr("`beam`"), HasSubstr("move it away")));
    }
    EXPECT_TRUE(read_bytes(file_) == bytes);
  }
  EXPECT_THAT(Store(file_, {"solid", "beam"}).read("beam"), ElementsAre(Pair("1", "")));
}

TEST_F(StoreFile, WithoutPermissionSaysTheSystemsReason) {
  fill(file_);
  for (const mode_t mode : {0, 0444}) {
    ASSERT_EQ(chmod(file_.c_str(), mode), 0);
    chmod(folder_.c_str(), 0777);
    const pid_t child = fork();
    if (child == 0) {
      // The superuser may do all.
      if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(9);
      const std::string said = refusal(file_);
      const bool is_right = said.find("Permission denied") != std::string::npos &&
                            said.find("make room") == std::string::npos;
      if (!is_right) std::fprintf(stderr, "%s\n", said.c_str());
      _exit(is_right ? 7 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7) << mode;
  }
}

TEST_F(StoreFile, ThroughALinkOrADeviceIsRefusedAndLeftAsItIs) {
  const fs::path elsewhere = folder_ / "elsewhere";
  fill(elsewhere);
  const std::string bytes = read_bytes(elsewhere);
  const auto refused = [&](const fs::path& named, const std::string& reason) {
    for (const bool fresh : {false, true})
      EXPECT_THAT(refusal(file_, fresh), AllOf(HasSubstr(named.string()), HasSubstr(reason)));
    EXPECT_TRUE(read_bytes(elsewhere) == bytes);
    fs::remove(named);
  };
  fs::create_symlink(elsewhere, file_);
  refused(file_, "it is a link");
  fs::create_symlink(elsewhere, file_.string() + "-wal");
  refused(file_.string() + "-wal", "it is a link");
  ASSERT_EQ(mkfifo(file_.c_str(), 0666), 0);
  refused(file_, "not a regular file");
  fs::create_directory(file_);
  refused(file_, "it is a folder");
}

TEST_F(StoreFile, IsOpenOnce) {
  auto store = std::make_unique<Store>(file_);
  store->require_fingerprint("solid", of_the_case);
  store->write("solid", {{"1", "one"}});
  for (const bool fresh : {false, true}) {
    const pid_t child = fork();
    if (child == 0) _exit(refusal(file_, fresh).find("another run") != std::string::npos ? 7 : 1);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 7) << fresh;
  }
  EXPECT_THAT(store->read("solid"), ElementsAre(Pair("1", "one")));
  store.reset();
  EXPECT_EQ(refusal(file_), "");
}

TEST_F(StoreFile, TakesEntriesFromSeveralThreads) {
  constexpr int lines = 200;
  {
    Store store(file_);
    std::vector<std::thread> threads;
    for (const char name : {'a', 'b', 'c', 'd'})
      threads.emplace_back([&store, name] {
        for (int i = 0; i < lines; ++i) store.write("study", {{name + std::to_string(i), "x"}});
      });
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_THAT(Store(file_).read("study"), SizeIs(4 * lines));
}

// Where a file may grow no further, as on a full disk.
TEST_F(StoreFile, AnEntryThatDoesNotFitIsAnErrorAndLeavesNoTrace) {
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit unlimited {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  {
    Store store(file_);
    store.write("solid", {{"1", "one"}});
    struct rlimit limited = unlimited;
    limited.rlim_cur = 60'000;
    setrlimit(RLIMIT_FSIZE, &limited);
    try {
      store.write("solid", {{"2", "two"}, {"3", blob() + blob() + blob()}});
      FAIL();
    } catch (const CheckpointError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(file_.string()), HasSubstr("make room")));
    }
    setrlimit(RLIMIT_FSIZE, &unlimited);
    store.write("solid", {{"4", "four"}});
  }
  std::signal(SIGXFSZ, before);
  EXPECT_THAT(Store(file_).read("solid"), ElementsAre(Pair("1", "one"), Pair("4", "four")));
}

TEST_F(StoreFile, InAFolderThatIsNotThereIsAnError) {
  EXPECT_THAT(refusal(folder_ / "none" / "case.sqlite"), HasSubstr("another folder with -o DIR"));
}

}  // namespace
}  // namespace ciliaval::compare::output::store
