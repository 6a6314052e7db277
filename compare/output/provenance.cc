// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/provenance.h"

#include <deal.II/base/config.h>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <toml++/toml.h>
#include <vtkVersionMacros.h>

#include <Eigen/Core>
#include <boost/version.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "ciliaval_version.h"

namespace ciliaval::compare::output {

Provenance provenance(const std::string& command) {
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return {
      CILIAVAL_VERSION,
      CILIAVAL_GIT,
      {{"deal.II", DEAL_II_PACKAGE_VERSION},
       {"Eigen",
        fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
       {"Boost", fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000,
                             BOOST_VERSION % 100)},
       {"VTK", VTK_VERSION},
       {"fmt",
        fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
       {"toml++", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
       {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                     NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)}},
      command,
      fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))};
}

std::string version_line() {
  return fmt::format("ciliaval {} (git {})", CILIAVAL_VERSION, CILIAVAL_GIT);
}

nlohmann::ordered_json to_json(const Provenance& provenance) {
  return {{"version", provenance.version},
          {"git", provenance.git},
          {"libraries", provenance.libraries},
          {"command", provenance.command},
          {"date", provenance.date}};
}

}  // namespace ciliaval::compare::output
