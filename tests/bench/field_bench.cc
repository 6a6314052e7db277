// SPDX-License-Identifier: LGPL-2.1-or-later
// Fields of the bent paper's cilium: time for each field point, and for a whole design.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/special_functions/ellint_3.hpp>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "analytic/sources/elliptic.h"
#include "tests/bench/paper_cilium.h"

namespace ciliaval::analytic {
namespace {

using Slices = rod::VolumeOptions::Slices;

Cilium magnetic_cilium() {
  Cilium cilium = paper_cilium();
  cilium.segments.back().magnetization = 75e3;
  return cilium;
}

/// The paper's load at its largest: 4 mN at 16 mm, 30 degrees.
Load paper_load(double force = 4e-3) {
  return ContactLoad{force, 16e-3, std::numbers::pi / 6};
}

const Deformation& bent() {
  static const Deformation deformation =
      *elastica::Elastica().solve(magnetic_cilium(), {paper_load()}).steps.front().deformation;
  return deformation;
}

/// `n` points of a sensor's plane, within 2 mm of the paper's sensor.
std::vector<Vector3> sensor_points(std::size_t n) {
  std::vector<Vector3> points{{-0.1e-3, 0.2e-3, -1.55e-3}};
  for (std::size_t i = 1; i < n; ++i) {
    const double r = 2e-3 * std::sqrt(static_cast<double>(i) / static_cast<double>(n));
    const double phi = 2.399963 * static_cast<double>(i);  // sunflower
    points.push_back(points.front() + r * Vector3(std::cos(phi), std::sin(phi), 0));
  }
  return points;
}

void count_points(benchmark::State& run, std::size_t points) {
  run.counters["time/point"] = benchmark::Counter(
      static_cast<double>(points),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Moduli and characteristics that no branch predictor and no loop invariant can know.
std::vector<double> moduli() {
  std::vector<double> values;
  for (int i = 0; i < 64; ++i) values.push_back(0.05 + 0.9 * std::fmod(0.618034 * i, 1.0));
  return values;
}

void bulirsch(benchmark::State& run) {
  const std::vector<double> kc = moduli();
  std::size_t i = 0;
  for (auto _ : run) {
    const double gamma = kc[(7 * i) % 64];
    benchmark::DoNotOptimize(sources::bulirsch_cel(kc[i % 64], gamma * gamma, 1, gamma));
    ++i;
  }
}

void boost_third_kind(benchmark::State& run) {
  const std::vector<double> k = moduli();
  std::size_t i = 0;
  for (auto _ : run) {
    benchmark::DoNotOptimize(boost::math::ellint_3(k[i % 64], k[(7 * i) % 64]));
    ++i;
  }
}

/// On one core.
void field_at_points(benchmark::State& run, const FieldModel& model) {
  const tbb::global_control one_core(tbb::global_control::max_allowed_parallelism, 1);
  const Cilium cilium = magnetic_cilium();
  const Deformation& deformation = bent();
  const auto n = static_cast<std::size_t>(run.range(0));
  const std::vector<Vector3> points = sensor_points(n);
  for (auto _ : run) benchmark::DoNotOptimize(model.field(cilium, deformation, points).B.data());
  count_points(run, n);
}

/// On run.range(1) cores.
void field_on_grid(benchmark::State& run, const FieldModel& model) {
  const auto n = static_cast<int>(run.range(0));
  const tbb::global_control cores(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(run.range(1)));
  const Cilium cilium = magnetic_cilium();
  Eigen::AlignedBox3d box;
  for (int i = 0; i <= 20; ++i) box.extend(bent().centreline.at(1e-3 * i).position);
  const Vector3 low = box.min() - Vector3::Constant(2 * cilium.diameter);
  const Vector3 step = (box.max() + Vector3::Constant(2 * cilium.diameter) - low) / (n - 1);
  std::vector<Vector3> points;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) points.emplace_back(low + step.cwiseProduct(Vector3(i, j, k)));
  for (auto _ : run) benchmark::DoNotOptimize(model.field(cilium, bent(), points).B.data());
  count_points(run, points.size());
}

void elastica_solve(benchmark::State& run) {
  const Cilium cilium = magnetic_cilium();
  const LoadPath path{paper_load()};
  const elastica::Elastica model;
  for (auto _ : run) benchmark::DoNotOptimize(model.solve(cilium, path).steps.data());
}

void corrected_elastica_solve(benchmark::State& run, bool error_estimate) {
  const Cilium cilium = magnetic_cilium();
  const LoadPath path{paper_load()};
  elastica::ElasticaOptions options;
  options.joints = joints::Correction::corrected;
  options.error_estimate = error_estimate;
  const elastica::Elastica model(options);
  for (auto _ : run) benchmark::DoNotOptimize(model.solve(cilium, path).steps.data());
}

/// A new design each time: the force grows from 1 to 4 mN in steps of a percent.
class Designs {
 public:
  Load next() {
    force_ = force_ < 3.96e-3 ? force_ * 1.01 : 1e-3;
    return paper_load(force_);
  }

 private:
  double force_ = 1e-3;
};

void design_by_the_models(benchmark::State& run) {
  const std::vector<Vector3> points = sensor_points(1);
  const Cilium cilium = magnetic_cilium();
  const elastica::Elastica mechanics;
  const rod::VolumeField volume;
  Designs designs;
  for (auto _ : run) {
    const MechanicsResult result = mechanics.solve(cilium, {designs.next()});
    benchmark::DoNotOptimize(
        volume.field(cilium, *result.steps.front().deformation, points).B.data());
  }
}

}  // namespace
}  // namespace ciliaval::analytic

int main(int argc, char** argv) {
  using namespace ciliaval::analytic;
  benchmark::RegisterBenchmark("elliptic/cel", bulirsch);
  benchmark::RegisterBenchmark("elliptic/boost_third_kind", boost_third_kind);
  const rod::LineField line;
  const rod::VolumeField wedge;
  const rod::VolumeField stacked({rod::VolumeOptions::Slices::stacked});
  for (const auto& [name, model] : std::vector<std::pair<std::string, const ciliaval::FieldModel*>>{
           {"line", &line}, {"wedge", &wedge}, {"stacked", &stacked}})
    benchmark::RegisterBenchmark(
        ("field/" + name).c_str(),
        [model = model](benchmark::State& run) { field_at_points(run, *model); })
        ->ArgName("points")
        ->Arg(1)
        ->Arg(1000);
  // The paper's sums; n is in the name, the arguments are the field points.
  std::vector<std::unique_ptr<ciliaval::FieldModel>> sums;
  const auto register_sum = [&](const std::string& name, auto model, int points) {
    sums.push_back(std::make_unique<decltype(model)>(model));
    benchmark::RegisterBenchmark(
        name.c_str(),
        [sum = sums.back().get()](benchmark::State& run) { field_at_points(run, *sum); })
        ->ArgName("points")
        ->Arg(points);
  };
  for (const unsigned int n : {25U, 50U, 100U, 200U, 400U, 800U, 1600U})
    register_sum("uniform/line/n:" + std::to_string(n),
                 rod::LineField({.method = rod::Method::uniform, .elements = n}), 10000);
  for (const unsigned int n : {20U, 40U, 80U})
    register_sum("uniform/stacked/n:" + std::to_string(n),
                 rod::VolumeField({.slices = rod::VolumeOptions::Slices::stacked,
                                   .method = rod::Method::uniform,
                                   .elements = n}),
                 10);
  benchmark::RegisterBenchmark("grid/wedge",
                               [&](benchmark::State& run) { field_on_grid(run, wedge); })
      ->ArgNames({"points", "cores"})
      ->Args({128, 1})
      ->Args({128, 2})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RegisterBenchmark("elastica", elastica_solve);
  benchmark::RegisterBenchmark("elastica/joints", corrected_elastica_solve, false);
  benchmark::RegisterBenchmark("elastica/joints_with_error", corrected_elastica_solve, true);
  benchmark::RegisterBenchmark("design/by_the_models", design_by_the_models);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
