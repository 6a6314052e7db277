// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <string_view>

#include "tests/support/case_texts.h"
#include "tests/support/temporary_folder.h"

namespace ciliaval::compare {

/// A fault that is put into a case file without one.
struct PlantedFault {
  const char* name;           ///< of the test
  std::string_view part;      ///< of the good text
  std::string_view replaced;  ///< by this
  const char* place;          ///< "line:column" that the message names
  std::string_view message;
  std::string_view advice{};  ///< what the message says besides
};

inline void PrintTo(const PlantedFault& fault, std::ostream* out) {
  *out << fault.name;
}

inline std::string name_of(const testing::TestParamInfo<PlantedFault>& info) {
  return info.param.name;
}

/// That the good text with the fault is refused with one message, at its place.
inline void expect_refused(std::string_view good, const PlantedFault& fault) {
  const std::string text = replaced(good, fault.part, fault.replaced);
  ASSERT_FALSE(text.empty()) << "not in the good case: " << fault.part;
  const std::string faults = faults_of(text);
  EXPECT_EQ(lines(faults).size(), 1U) << faults;
  EXPECT_THAT(faults, testing::StartsWith("bad.toml:" + std::string(fault.place) + ": "));
  EXPECT_THAT(faults, testing::HasSubstr(fault.message));
  EXPECT_THAT(faults, testing::HasSubstr(fault.advice));
}

/// The message on a case file that is read beside the files of the folder, without the folder's
/// name.
inline std::string faults_beside(const test::TemporaryFolder& folder, std::string_view text) {
  try {
    input::read_case(text, (folder.path() / "case.toml").string(), models::known());
  } catch (const InputError& error) {
    std::string said = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (auto at = said.find(prefix); at != std::string::npos; at = said.find(prefix))
      said.erase(at, prefix.size());
    return said;
  }
  return "no fault";
}

}  // namespace ciliaval::compare
