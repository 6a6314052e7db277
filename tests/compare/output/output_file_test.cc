// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <future>

#include "compare/output/csv_writer.h"
#include "compare/output/text_table.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval {
namespace {

namespace fs = std::filesystem;
using compare::output::check_outputs;
using compare::output::CsvWriter;
using compare::output::text_table;
using compare::output::write_file;
using test::read_text;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(OutputFile, ReplacesAFileAndTouchesNoOther) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.json";
  std::ofstream(file) << "old";
  std::ofstream(folder.path() / "a.json.tmp") << "the user's";
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  write_file(file, "new");
  EXPECT_EQ(read_text(file), "new");
  EXPECT_EQ(read_text(folder.path() / "a.json.tmp"), "the user's");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

TEST(OutputFile, WritesBehindALink) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "data");
  fs::create_symlink("data/real.json", folder.path() / "link.json");  // leads nowhere yet
  for (const char* text : {"first", "second"}) {
    write_file(folder.path() / "link.json", text);
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.json"));
    EXPECT_EQ(read_text(folder.path() / "data/real.json"), text);
  }
}

TEST(OutputFile, WritesStraightIntoAFifoAndADevice) {
  const TemporaryFolder folder;
  const fs::path fifo = folder.path() / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  auto reader = std::async(std::launch::async, [&] { return read_text(fifo); });
  write_file(fifo, "through the FIFO");
  EXPECT_EQ(reader.get(), "through the FIFO");
  EXPECT_TRUE(fs::is_fifo(fifo));
  write_file("/dev/null", "nothing");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_file("/dev/full", "text"), FileError);
}

TEST(OutputFile, IsRefusedIfItIsAnInputUnderAnyName) {
  const TemporaryFolder folder;
  const fs::path input = folder.path() / "readings.csv";
  std::ofstream(input) << "data";
  fs::create_hard_link(input, folder.path() / "hard.csv");
  fs::create_symlink("readings.csv", folder.path() / "soft.csv");
  fs::create_directory_symlink(".", folder.path() / "here");
  for (const char* name : {"readings.csv", "hard.csv", "soft.csv", "here/readings.csv"})
    EXPECT_THROW(check_outputs({folder.path() / name}, {input}), InputError) << name;
  EXPECT_THROW(check_outputs({folder.path() / "x", folder.path() / "here/x"}, {input}), InputError);
  check_outputs({folder.path() / "x", folder.path() / "y", std::nullopt}, {input});
  check_outputs({"/dev/null", "/dev/null"}, {input});
}

TEST(OutputFile, IsRefusedBeforeTheWorkIfItCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_THROW(check_outputs({folder.path() / "none" / "x.json"}, {}), FileError);
  EXPECT_THROW(check_outputs({folder.path()}, {}), FileError);
  EXPECT_THROW(check_outputs({"/proc/x.json"}, {}), FileError);
}

// Oracle: RFC 4180; OWASP, "CSV injection". A comment goes below the names of the columns.
TEST(CsvWriter, QuotesEscapesAndDefusesTexts) {
  CsvWriter csv;
  csv.column("a", "m\nforged");
  csv.column("b");
  csv.vector_columns("B_", "T");
  csv.end_row();
  csv.row("a", 1, -0.0, 0.1, std::optional<double>(), true);
  csv.row("say \"x, y\"", "two\nlines", "=1+1", "@SUM(A1)", "-1.5", "\x1b[2J", "\xff");
  EXPECT_EQ(csv.text(),
            "a,b,B_x,B_y,B_z\n# units: a m\\x0Aforged, B_x T, B_y T, B_z T\na,1,0,0.1,,true\n"
            "\"say \"\"x, y\"\"\",\"two\nlines\",'=1+1,'@SUM(A1),-1.5,\\x1B[2J,\\xFF\n");
}

TEST(TextTable, AlignsByCharactersNotBytes) {
  EXPECT_EQ(text_table({{"name", "value", "note"}, {"é", "1.25", "x"}, {"long name", "3"}}, "<><"),
            "  name       value  note\n  é           1.25  x\n  long name      3\n");
}

}  // namespace
}  // namespace ciliaval
