// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compare/study/case_number.h"
#include "tests/support/case_texts.h"

namespace ciliaval::compare {

/// That every number of two cases is the same, bit for bit: what is written states each key and
/// option (Fingerprint.ChangesWithEveryKeyOfACaseFile), and numbers in all of their digits.
inline void expect_same(const input::Case& a, const input::Case& b) {
  EXPECT_EQ(input::to_toml(a, models::known()), input::to_toml(b, models::known()));
  ASSERT_EQ(a.load_path.size(), b.load_path.size());
  for (std::size_t i = 0; i < a.load_path.size(); ++i) {
    EXPECT_EQ(type(a.load_path[i]), type(b.load_path[i]));
    EXPECT_TRUE(std::ranges::equal(a.load_path[i].values(), b.load_path[i].values()));
    EXPECT_EQ(a.load_path[i].environment(), b.load_path[i].environment());
  }
}

/// That what is written of a case is read back as the same case, which is returned.
inline input::Case expect_read_back(const input::Case& c) {
  const std::string written = input::to_toml(c, models::known());
  SCOPED_TRACE(written);
  const input::Case again = read(written);
  expect_same(again, c);
  return again;
}
inline input::Case expect_read_back(std::string_view text) {
  EXPECT_FALSE(text.empty());
  return expect_read_back(read(text));
}

/// The case with the numbers of these paths, as a study varies them.
inline input::Case varied(const input::Case& c, const std::map<std::string, double>& wanted) {
  std::vector<study::Setting> settings;
  for (const study::CaseNumber& number : study::case_numbers(c))
    if (const auto found = wanted.find(number.path); found != wanted.end())
      settings.push_back({number, found->second});
  EXPECT_EQ(settings.size(), wanted.size());
  return study::with_settings(c, settings);
}

}  // namespace ciliaval::compare
