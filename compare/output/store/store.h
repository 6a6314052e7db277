// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "problem/support/fingerprint.h"

struct sqlite3;

namespace ciliaval::compare::output::store {

/// Bytes under names.
using Entries = std::map<std::string, std::string>;

/// Finished steps of a case or points of a study in one SQLite file, which one process has at a
/// time (docs/guide/results.md). Entries belong to an owner: a model, or the study.
///
/// write() is a transaction: what it has returned from is not lost if the process is killed. At a
/// power cut at most the work of a second is lost: a flush for each entry would take as long as a
/// point of the analytic models.
///
/// All functions throw CheckpointError, with the file and what to do. The file is then as it was.
class Store {
 public:
  /// Opens the file, or makes it, and verifies all of it; `fresh` empties it first. Refused are a
  /// file that another process has, a damaged one, and what is not ours, which is never emptied:
  /// anything that is not a store, and a store with entries of other owners than these. Without
  /// owners any is ours.
  explicit Store(std::filesystem::path file, std::vector<std::string_view> owners = {},
                 bool fresh = false);
  /// Deletes the file if it has no entries.
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  const std::filesystem::path& file() const { return file_; }

  /// Sets the owner's fingerprint; refuses to change that of entries.
  void require_fingerprint(std::string_view owner, const support::Fingerprint& fingerprint);

  /// All entries of an owner.
  Entries read(std::string_view owner) const;
  /// Adds or replaces entries of an owner, all or none; by any thread.
  void write(std::string_view owner, const Entries& entries);
  /// Deletes the file. Nothing but the destructor may follow.
  void remove();

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  bool open(bool fresh);
  void require_owners() const;
  void verify() const;
  void put(std::string_view owner, std::string_view name, std::string_view bytes);
  void execute(const char* sql) const;
  [[noreturn]] void fail() const;

  using Clock = std::chrono::steady_clock;
  std::filesystem::path file_;
  std::vector<std::string_view> owners_;
  std::unique_ptr<sqlite3, Close> database_;
  Clock::time_point flushed_ = Clock::now();
  std::mutex mutex_;
};

/// The first three differences of two fingerprints, in words; empty if there is none.
std::string difference(const support::Fingerprint& kept, const support::Fingerprint& asked);

}  // namespace ciliaval::compare::output::store
