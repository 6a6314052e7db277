// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/fingerprint.h"

#include <cstddef>
#include <cstdio>
#include <string>

namespace ciliaval::fem::solid {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string describe(const Load& load) {
  std::string text(load.type().name);
  for (std::size_t i = 0; i < load.values().size(); ++i) {
    const QuantityKey& key = load.type().parameters[i].key;
    text += ", " + std::string(key.name) + " " + number(load.values()[i]) + " " +
            std::string(key.quantity.unit);
  }
  return text;
}

}  // namespace

support::Fingerprint fingerprint(const Cilium& cilium, const LoadPath& path,
                                 const SolidOptions& options) {
  support::Fingerprint all{{"diameter", number(cilium.diameter) + " m"},
                           {"number of segments", std::to_string(cilium.segments.size())}};
  for (const auto& [name, length, young_modulus, poisson_ratio, magnetization] : cilium.segments) {
    const std::string of = " of segment `" + name + "`";
    all.emplace_back("length" + of, number(length) + " m");
    all.emplace_back("young_modulus" + of, number(young_modulus) + " Pa");
    all.emplace_back("poisson_ratio" + of, number(poisson_ratio));
    all.emplace_back("magnetization" + of, number(magnetization) + " A/m");
  }
  all.emplace_back("number of load steps", std::to_string(path.size()));
  for (std::size_t i = 0; i < path.size(); ++i)
    all.emplace_back("load of step " + std::to_string(i + 1), describe(path[i]));
  // By structured bindings: an option that is added and forgotten here does not compile.
  const auto& [material, mooney_ratio, yeoh_ratios, refinement, initial_guess, symmetry, mesh,
               mesh_unit, kernel_width, tolerance, max_iterations, max_cutbacks, solver] = options;
  static_cast<void>(max_iterations);
  static_cast<void>(max_cutbacks);
  const auto option = [&all](const std::string& name, const std::string& value) {
    all.emplace_back("models.solid." + name, value);
  };
  option("material", std::to_string(static_cast<int>(material)));
  option("mooney_ratio", number(mooney_ratio));
  option("yeoh_ratios", number(yeoh_ratios[0]) + ", " + number(yeoh_ratios[1]));
  option("mesh", mesh.empty() ? "none" : support::describe_content(mesh));
  option("mesh_unit", number(mesh_unit) + " m");
  option("refinement", std::to_string(refinement));
  option("initial_guess", initial_guess == InitialGuess::beam ? "beam" : "none");
  option("symmetry", symmetry ? "true" : "false");
  option("kernel_width", number(kernel_width) + " m");
  option("tolerance", number(tolerance));
  option("solver", std::to_string(static_cast<int>(solver)));
  return all;
}

}  // namespace ciliaval::fem::solid
