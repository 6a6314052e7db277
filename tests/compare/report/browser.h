// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace ciliaval::test {

/// What a page did while it was opened and laid out.
struct PageRecord {
  std::vector<std::string> messages;  ///< errors and warnings of console, parser and policies
  std::vector<std::string> requests;  ///< addresses asked for, but for the page itself and data:
};

/// A headless Chromium with one page, driven by the DevTools protocol over a pipe: JSON texts, each
/// with a NUL at its end (chromium --remote-debugging-pipe).
class Browser {
 public:
  /// Throws std::runtime_error if it does not start.
  Browser();
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  static bool is_installed();

  /// Opens a file on a screen of this width, as a phone does if it is narrow, and waits until it is
  /// loaded and laid out.
  PageRecord open(const std::filesystem::path& file, int width);
  /// The value of a JavaScript expression in the page.
  nlohmann::json evaluate(const std::string& expression);
  /// Presses and releases a key: "Tab", "Enter", "ArrowRight".
  void press(const std::string& key, int code);

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json receive();
  void note(const nlohmann::json& event);

  std::filesystem::path profile_;
  pid_t process_ = -1;
  int to_ = -1;
  int from_ = -1;
  int last_id_ = 0;
  std::string received_;
  std::string session_;
  std::string page_;
  bool loaded_ = false;
  PageRecord record_;
};

}  // namespace ciliaval::test
