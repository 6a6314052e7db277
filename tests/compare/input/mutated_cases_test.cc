// SPDX-License-Identifier: LGPL-2.1-or-later
// Whatever is done to a case file, it is read or refused; a mutation generator with a fixed seed
// stands for the person who edits it. (The C++ standard fixes the sequence of std::mt19937.)
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <string_view>

#include "compare/input/case.h"
#include "compare/input/units.h"
#include "compare/models/registry.h"
#include "problem/error.h"
#include "tests/support/case_texts.h"

namespace ciliaval::compare {
namespace {

class Mutator {
 public:
  explicit Mutator(unsigned int seed) : random_(seed) {}

  std::string operator()(std::string_view text) {
    std::string result(text);
    const std::size_t count = 1 + below(3);
    for (std::size_t i = 0; i < count; ++i) mutate(result);
    return result;
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }

  void mutate(std::string& text) {
    static constexpr std::array<std::string_view, 32> parts{
        "nan", "-inf",   "1e308", "1e-308", "\"\"",     "\"-1 mm\"", "\"0 N\"", "\"1e308 m\"",
        "[",   "]",      "[[",    "{",      "}",        "=",         ".",       "\"",
        "'",   "\"\"\"", "#",     ",",      "\n",       "[]",        "true",    "2000-01-01",
        "-",   "1 deg",  "m-1",   "@ 3",    "\xC2\xB5", "\xFF",      "\\u0000", "[models.line]\n"};
    if (text.empty()) return;
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(12);
    switch (below(7)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(at, length));
        break;
      case 2:
        text[at] = static_cast<char>(below(256));
        break;
      case 3:
        text.insert(at, parts[below(parts.size())]);
        break;
      case 4:
        text.replace(at, length, parts[below(parts.size())]);
        break;
      case 5:
        change_digit(text, at);
        break;
      default:
        swap_lines(text, at);
        break;
    }
  }

  /// Puts another digit for the next one.
  void change_digit(std::string& text, std::size_t at) {
    const std::size_t digit = text.find_first_of("0123456789", at);
    if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(10));
  }

  /// Moves the rest of the line at this position to somewhere else.
  void swap_lines(std::string& text, std::size_t at) {
    const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
    const std::string line = text.substr(at, end - at + 1);
    text.erase(at, line.size());
    text.insert(text.empty() ? 0 : below(text.size()), line);
  }

  std::mt19937 random_;
};

TEST(MutatedCases, AreReadOrRefusedWithAPlace) {
  Mutator mutate(20240601);
  int read = 0;
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string text = mutate(good_case);
    try {
      const std::string written =
          input::to_toml(input::read_case(text, "mutated.toml", models::known()), models::known());
      ASSERT_EQ(input::to_toml(input::read_case(written, "written.toml", models::known()),
                               models::known()),
                written)
          << text;
      ++read;
    } catch (const InputError& error) {
      ASSERT_THAT(error.what(), testing::MatchesRegex("mutated.toml:[0-9]+:[0-9]+: .+")) << text;
      ++refused;
    }  // any other exception ends the test
  }
  // Both happen often: comments, blanks and digits can change, keys and quotes cannot.
  EXPECT_GT(read, 1000);
  EXPECT_GT(refused, 10000);
}

TEST(RandomQuantities, AreFiniteOrRefused) {
  constexpr std::array<std::string_view, 40> parts{
      "1",     "3",  "0", "7.5", "-",     "+",    ".",   "e",   "e3",  " ",
      "m",     "mm", "N", "k",   "Pa",    "s",    "kg",  "deg", "rad", "/",
      "*",     "**", "^", "^-2", "-1",    "2",    "(",   ")",   "@",   "since",
      "lg(re", "°",  "µ", "²",   "lb(re", "degC", "nan", "inf", "%",   "per"};
  std::mt19937 random(7);
  int read = 0;
  for (int i = 0; i < 100000; ++i) {
    std::string text(parts[random() % 4]);
    for (std::size_t n = 1 + random() % 6; n > 0; --n) text += parts[random() % parts.size()];
    try {
      ASSERT_TRUE(std::isfinite(input::parse_quantity(text, quantity::length))) << text;
      ++read;
    } catch (const InputError&) {
    }  // any other exception ends the test
  }
  EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace ciliaval::compare
