// SPDX-License-Identifier: LGPL-2.1-or-later
// Rods whose joints are corrected against the solid, on random cilia of the table's box: errors of
// tip, tip angle and ΔB, before and after, and the model uncertainty that the corrected rods state.
//   build/release/tests/coverage/corrected_rods [number of designs [first seed]] > designs.csv
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analytic/body/mesh_field.h"
#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "fem/beam/beam.h"
#include "fem/solid/solid.h"
#include "tests/coverage/random_case.h"

namespace ciliaval::test {
namespace {

/// Relative differences of a rod from the solid.
struct Errors {
  double tip = 0;                ///< over the solid's deflection
  double angle = 0;              ///< over the solid's
  double field = 0;              ///< of |ΔB| at the sensor
  std::optional<double> stated;  ///< uncertainty of the tip, likewise
  std::string remark;
};

class Comparison {
 public:
  explicit Comparison(RandomCase drawn) : drawn_(std::move(drawn)) {
    fem::solid::SolidOptions options;
    options.kernel_width = drawn_.kernel_width;
    options.solver = fem::solid::solvers::SolverKind::direct;
    solid_ = fem::solid::Solid(options).solve(drawn_.cilium, {drawn_.load});
    if (solved()) {
      const Deformation& bent = *step().deformation;
      dB_ = change(analytic::body::MeshField(), solid_.undeformed, bent);
    }
  }

  bool solved() const { return step().status == Status::converged; }
  const MechanicsStep& step() const { return solid_.steps.front(); }
  double deflection() const { return place(solid_).norm(); }

  std::optional<Errors> of(const MechanicsModel& rod) const {
    const MechanicsResult result = rod.solve(drawn_.cilium, {drawn_.load});
    const MechanicsStep& own = result.steps.front();
    if (own.status != Status::converged) return std::nullopt;
    Errors errors;
    errors.tip = (place(result) - place(solid_)).norm() / deflection();
    const double angle = tip(solid_).theta();
    errors.angle = std::abs(tip(result).theta() - angle) / angle;
    const Vector3 dB = change(analytic::rod::VolumeField(), result.undeformed, *own.deformation);
    errors.field = (dB - dB_).norm() / dB_.norm();
    if (own.tip_uncertainty) errors.stated = *own.tip_uncertainty / deflection();
    errors.remark = own.message;
    return errors;
  }

 private:
  CentrelinePoint tip(const MechanicsResult& result) const {
    return result.steps.front().deformation->centreline.at(drawn_.cilium.length());
  }
  /// Displacement of the tip.
  Vector3 place(const MechanicsResult& result) const {
    return tip(result).position - drawn_.cilium.length() * Vector3::UnitZ();
  }
  Vector3 change(const FieldModel& field, const Deformation& straight,
                 const Deformation& bent) const {
    return field.field(drawn_.cilium, bent, drawn_.sensors).B.front() -
           field.field(drawn_.cilium, straight, drawn_.sensors).B.front();
  }

  RandomCase drawn_;
  MechanicsResult solid_;
  Vector3 dB_ = Vector3::Zero();
};

struct Rod {
  std::string name{};
  std::vector<double> tip{}, angle{}, field{}, stated{};
  int inside = 0;             ///< the stated uncertainty
  int inside_with_solid = 0;  ///< that and the solid's
  void add(const Errors& e, double of_the_solid) {
    tip.push_back(e.tip);
    angle.push_back(e.angle);
    field.push_back(e.field);
    stated.push_back(e.stated.value_or(0));
    if (e.tip <= stated.back()) ++inside;
    if (e.tip <= stated.back() + of_the_solid) ++inside_with_solid;
  }
};

void print_quantiles(const std::string& name, std::vector<double> values) {
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double q) {
    return values[static_cast<std::size_t>(
        std::lround(q * static_cast<double>(values.size() - 1)))];
  };
  fmt::print(stderr, "{:<34} {:>4} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.3g}\n", name, values.size(),
             quantile(0.05), quantile(0.5), quantile(0.95), values.back());
}

void compare(std::uint32_t designs, std::uint32_t first_seed) {
  using fem::beam::Beam;
  const Beam plain;
  const Beam corrected({.joints = joints::Correction::corrected});
  const analytic::elastica::Elastica elastica({.joints = joints::Correction::corrected});
  const std::vector<std::pair<std::string, const MechanicsModel*>> models{
      {"beam", &plain}, {"corrected beam", &corrected}, {"corrected elastica", &elastica}};
  std::vector<Rod> rods;
  for (const auto& model : models) rods.push_back({.name = model.first});
  fmt::print(
      "seed,load,segments,L1/d,L/d,E2/E1,nu1,angle_deg,solid_tip,model,tip,angle,dB,stated,"
      "remark\n");
  for (std::uint32_t seed = first_seed; seed < first_seed + designs; ++seed) {
    const RandomCase drawn = random_design(seed);
    const Comparison comparison(drawn);
    const auto& segments = drawn.cilium.segments;
    fmt::print(stderr, "seed {} {} {:.1f} s {}\n", seed, type(drawn.load),
               comparison.step().seconds, comparison.step().message);
    if (!comparison.solved()) continue;
    const double of_the_solid =
        comparison.step().tip_uncertainty.value_or(0) / comparison.deflection();
    for (std::size_t m = 0; m < models.size(); ++m) {
      std::optional<Errors> errors;
      std::string refusal;
      try {
        errors = comparison.of(*models[m].second);
      } catch (const std::exception& error) {
        refusal = error.what();
      }
      fmt::print(
          "{},{},{},{:.2f},{:.2f},{:.2f},{:.4f},{:.1f},{:.2e},{},", seed, type(drawn.load),
          segments.size(), segments.front().length / drawn.cilium.diameter,
          drawn.cilium.length() / drawn.cilium.diameter,
          segments[1].young_modulus / segments[0].young_modulus, segments.front().poisson_ratio,
          comparison.step().deformation->centreline.at(drawn.cilium.length()).theta() * 57.29577951,
          comparison.step().tip_uncertainty.value_or(NAN) / comparison.deflection(),
          models[m].first);
      if (errors) {
        fmt::print("{:.3e},{:.3e},{:.3e},{:.3e},\"{}\"\n", errors->tip, errors->angle,
                   errors->field, errors->stated.value_or(0), errors->remark);
        rods[m].add(*errors, of_the_solid);
      } else {
        fmt::print(",,,,\"{}\"\n", refusal);
      }
      std::fflush(stdout);
    }
  }
  fmt::print(stderr, "\n{:<34} {:>4} {:>9} {:>9} {:>9} {:>9}\n", "relative to the solid", "n",
             "5 %", "median", "95 %", "largest");
  for (const Rod& rod : rods) {
    print_quantiles(rod.name + ": tip", rod.tip);
    print_quantiles(rod.name + ": angle", rod.angle);
    print_quantiles(rod.name + ": dB", rod.field);
    print_quantiles(rod.name + ": stated of the tip", rod.stated);
    fmt::print(stderr, "{}: {} of {} tips inside what it states, {} with the solid's uncertainty\n",
               rod.name, rod.inside, rod.tip.size(), rod.inside_with_solid);
  }
}

}  // namespace
}  // namespace ciliaval::test

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  const auto number = [&](std::size_t i, std::uint32_t fallback) {
    return arguments.size() > i ? static_cast<std::uint32_t>(std::stoul(arguments[i])) : fallback;
  };
  try {
    ciliaval::test::compare(number(1, 100), number(2, 0));
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "corrected_rods: {}\n", error.what());
    return 2;
  }
}
