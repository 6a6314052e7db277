// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/store/store.h"

#include <fmt/core.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <system_error>
#include <utility>

#include "problem/error.h"

namespace ciliaval::compare::output::store {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr auto flush_interval = 1s;
constexpr std::string_view magic("SQLite format 3\0", 16);
/// "CiVa" and where SQLite's file format keeps it: the file is a store and not another database.
constexpr std::string_view application("CiVa");
constexpr std::size_t application_place = 68;
constexpr std::size_t page_size = 4096;
constexpr const char* schema = R"(
BEGIN;
PRAGMA application_id = 0x43695661;
CREATE TABLE fingerprints (owner TEXT, name TEXT, value TEXT);
CREATE TABLE entries (owner TEXT, name TEXT, bytes BLOB, checksum TEXT, PRIMARY KEY (owner, name));
COMMIT)";

[[noreturn]] void refuse(const fs::path& file, std::string_view reason) {
  throw CheckpointError(fmt::format(
      "`{}` cannot be used: {}; nothing was read from it. Start anew with --fresh, which deletes "
      "what it holds, or choose another folder with -o DIR",
      file.string(), reason));
}

[[noreturn]] void refuse_foreign(const fs::path& file, std::string_view reason) {
  throw CheckpointError(
      fmt::format("`{}` cannot be used and was left as it is: {}; move it away, or choose another "
                  "folder with -o DIR",
                  file.string(), reason));
}

/// Throws unless the file, and those that SQLite keeps beside it, are not there or regular: a link
/// or a device is somebody else's.
void require_regular(const fs::path& file) {
  for (const char* end : {"", "-wal", "-shm", "-journal"}) {
    fs::path path = file;
    path += end;
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
      refuse_foreign(path, fs::is_symlink(status)     ? "it is a link"
                           : fs::is_directory(status) ? "it is a folder"
                                                      : "it is not a regular file");
  }
}

/// Throws if the file is another program's. An empty one is not, nor a database of one page, which
/// has no table: a kill may leave them.
void require_ours(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in.is_open()) return;  // not there, or SQLite says why
  std::string start(page_size + 1, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(in.gcount()));
  if (start.empty()) return;
  if (start.starts_with(magic) &&
      (start.size() <= page_size || start.compare(application_place, 4, application) == 0))
    return;
  refuse_foreign(file, "it is no store of CiliaVal, or its start is damaged");
}

std::string checksum_of(std::string_view owner, std::string_view name, std::string_view bytes) {
  return fmt::format("{:08x}", support::checksum(fmt::format("{}\n{}\n{}", owner, name, bytes)));
}

/// An SQL statement with its parameters ?1, ?2, …; they must outlive it.
class Statement {
 public:
  Statement(sqlite3* database, const char* sql,
            std::initializer_list<std::string_view> texts = {}) {
    sqlite3_prepare_v2(database, sql, -1, &statement_, nullptr);
    for (const std::string_view text : texts)
      sqlite3_bind_text64(statement_, ++parameters_, text.data(), text.size(), SQLITE_STATIC,
                          SQLITE_UTF8);
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// The next parameter, of bytes.
  void bind(std::string_view bytes) {
    sqlite3_bind_blob64(statement_, ++parameters_, bytes.data(), bytes.size(), SQLITE_STATIC);
  }
  /// SQLITE_ROW, SQLITE_DONE or an error.
  int step() { return statement_ != nullptr ? sqlite3_step(statement_) : SQLITE_ERROR; }
  std::string column(int i) const {
    const void* bytes = sqlite3_column_blob(statement_, i);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, i));
    return bytes != nullptr ? std::string(static_cast<const char*>(bytes), size) : std::string();
  }

 private:
  sqlite3_stmt* statement_ = nullptr;
  int parameters_ = 0;
};

}  // namespace

Store::Store(fs::path file, std::vector<std::string_view> owners, bool fresh)
    : file_(std::move(file)), owners_(std::move(owners)) {
  while (!open(fresh)) database_.reset();
}

Store::~Store() {
  try {
    if (database_ && Statement(database_.get(), "SELECT 1 FROM entries").step() == SQLITE_DONE)
      remove();
  } catch (const CheckpointError&) {  // NOLINT(bugprone-empty-catch): an empty store harms nobody
  }
}

void Store::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

void Store::fail() const {
  const int code = sqlite3_errcode(database_.get());
  const std::string reason = sqlite3_errmsg(database_.get());
  if (code == SQLITE_BUSY)
    throw CheckpointError(
        fmt::format("another run writes to `{}`. Wait until it has ended, or choose another folder "
                    "with -o DIR",
                    file_.string()));
  if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB || code == SQLITE_ERROR)
    refuse(file_, "it is damaged: " + reason);
  // SQLite opens what may only be read, and fails at the lock.
  const bool may_write = access(file_.c_str(), R_OK | W_OK) == 0 || errno == ENOENT;
  const int of_system = may_write ? sqlite3_system_errno(database_.get()) : errno;
  const bool may_be_full = code == SQLITE_FULL || of_system == ENOSPC || of_system == EDQUOT ||
                           of_system == EFBIG || (code == SQLITE_IOERR && of_system == 0);
  throw CheckpointError(
      fmt::format("cannot write to `{}`: {}; {}choose another folder with -o DIR", file_.string(),
                  of_system != 0 ? std::generic_category().message(of_system) : reason,
                  may_be_full ? "make room on the disk if it is full, or " : ""));
}

void Store::execute(const char* sql) const {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

bool Store::open(bool fresh) {
  require_regular(file_);
  require_ours(file_);
  sqlite3* database = nullptr;
  const int opened = sqlite3_open_v2(file_.c_str(), &database,
                                     SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  database_.reset(database);
  if (opened != SQLITE_OK) fail();
  // In this mode SQLite keeps the lock until the file is closed.
  execute("PRAGMA locking_mode = EXCLUSIVE");
  require_owners();
  if (fresh) {
    sqlite3_db_config(database, SQLITE_DBCONFIG_RESET_DATABASE, 1, nullptr);
    execute("VACUUM");
    sqlite3_db_config(database, SQLITE_DBCONFIG_RESET_DATABASE, 0, nullptr);
  } else {
    execute("BEGIN EXCLUSIVE; COMMIT");
  }
  // The run that had the lock may have deleted the file before it let go.
  int moved = 0;
  sqlite3_file_control(database, nullptr, SQLITE_FCNTL_HAS_MOVED, &moved);
  if (moved != 0) return false;
  verify();
  if (Statement(database, "SELECT 1 FROM sqlite_schema").step() == SQLITE_DONE) execute(schema);
  execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL");
  return true;
}

void Store::require_owners() const {
  if (owners_.empty()) return;
  // verify() says more of a file without tables, or a damaged one.
  Statement all(database_.get(), "SELECT DISTINCT owner FROM entries");
  while (all.step() == SQLITE_ROW)
    if (std::ranges::find(owners_, all.column(0)) == owners_.end())
      refuse_foreign(file_, fmt::format("it holds results of something else, `{}`", all.column(0)));
}

void Store::verify() const {
  Statement structure(database_.get(), "PRAGMA integrity_check(1)");
  if (structure.step() != SQLITE_ROW) fail();
  if (structure.column(0) != "ok") refuse(file_, "it is damaged: " + structure.column(0));
  if (Statement(database_.get(), "SELECT 1 FROM sqlite_schema").step() == SQLITE_DONE) return;
  // SQLite has no checksum of contents.
  Statement all(database_.get(), "SELECT owner, name, bytes, checksum FROM entries");
  int result = all.step();
  for (; result == SQLITE_ROW; result = all.step())
    if (checksum_of(all.column(0), all.column(1), all.column(2)) != all.column(3))
      refuse(file_, fmt::format("it is damaged: the checksum of {} of {} is wrong", all.column(1),
                                all.column(0)));
  if (result != SQLITE_DONE) fail();
}

void Store::require_fingerprint(std::string_view owner, const support::Fingerprint& fingerprint) {
  support::Fingerprint kept;
  Statement statement(database_.get(),
                      "SELECT name, value FROM fingerprints WHERE owner = ?1 ORDER BY rowid",
                      {owner});
  while (statement.step() == SQLITE_ROW)
    kept.emplace_back(statement.column(0), statement.column(1));
  if (kept == fingerprint) return;
  if (Statement(database_.get(), "SELECT 1 FROM entries WHERE owner = ?1", {owner}).step() ==
      SQLITE_ROW)
    refuse(file_, "it holds results of something else: " + difference(kept, fingerprint));
  execute("BEGIN");
  Statement(database_.get(), "DELETE FROM fingerprints WHERE owner = ?1", {owner}).step();
  for (const auto& [name, value] : fingerprint)
    if (Statement(database_.get(), "INSERT INTO fingerprints VALUES (?1, ?2, ?3)",
                  {owner, name, value})
            .step() != SQLITE_DONE)
      fail();
  execute("COMMIT");
}

Entries Store::read(std::string_view owner) const {
  Entries entries;
  Statement statement(database_.get(), "SELECT name, bytes FROM entries WHERE owner = ?1", {owner});
  int result = statement.step();
  for (; result == SQLITE_ROW; result = statement.step())
    entries.emplace(statement.column(0), statement.column(1));
  if (result != SQLITE_DONE) fail();
  return entries;
}

void Store::put(std::string_view owner, std::string_view name, std::string_view bytes) {
  const std::string sum = checksum_of(owner, name, bytes);
  Statement statement(database_.get(), "INSERT OR REPLACE INTO entries VALUES (?1, ?2, ?4, ?3)",
                      {owner, name, sum});
  statement.bind(bytes);
  if (statement.step() != SQLITE_DONE) fail();
}

void Store::write(std::string_view owner, const Entries& entries) {
  const std::lock_guard guard(mutex_);
  execute("BEGIN");
  try {
    for (const auto& [name, bytes] : entries) put(owner, name, bytes);
    execute("COMMIT");
  } catch (const CheckpointError&) {
    if (sqlite3_get_autocommit(database_.get()) == 0)
      sqlite3_exec(database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
    throw;
  }
  if (Clock::now() - flushed_ < flush_interval) return;
  execute("PRAGMA wal_checkpoint");
  flushed_ = Clock::now();
}

void Store::remove() {
  // Without its log first: that of the next run of this name must not be deleted with this one.
  execute("PRAGMA journal_mode = DELETE");
  std::error_code error;
  if (!fs::remove(file_, error) && error)
    throw CheckpointError(fmt::format("cannot delete `{}`: {}", file_.string(), error.message()));
  database_.reset();
}

std::string difference(const support::Fingerprint& kept, const support::Fingerprint& asked) {
  const std::map<std::string, std::string> before(kept.begin(), kept.end());
  const std::map<std::string, std::string> now(asked.begin(), asked.end());
  std::string text;
  int found = 0;
  const auto say = [&](const std::string& name) {
    const auto value = [&name](const auto& all) {
      const auto place = all.find(name);
      if (place == all.end()) return std::string("not given");
      constexpr std::size_t longest = 200;  // a study's parameter has many values
      return place->second.size() <= longest ? place->second
                                             : place->second.substr(0, longest) + " ...";
    };
    if (before.contains(name) == now.contains(name) && before.at(name) == now.at(name)) return;
    if (++found > 3) return;
    text += fmt::format("{}{} was {}, now it is {}", text.empty() ? "" : "; ", name, value(before),
                        value(now));
  };
  for (const auto& [name, value] : asked) say(name);
  for (const auto& [name, value] : kept)
    if (!now.contains(name)) say(name);
  return found > 3 ? text + fmt::format("; and {} more", found - 3) : text;
}

}  // namespace ciliaval::compare::output::store
