// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/bench.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>

#include "compare/sensing/distributions.h"
#include "problem/error.h"

namespace ciliaval::compare::sensing {
namespace {

constexpr double beyond_the_largest = 1.25;  ///< the range of loads looked for, over the largest
constexpr double least_noise = 1e-9;         ///< T: weights of a sensor without noise

/// The sizes of the errors of one simulation: those of the bench, or zero where they are left out.
struct Errors {
  double noise, background_noise, quantum, sensor_position, stage_azimuth;
  Vector3 ambient;
  bool models;  ///< whether another pair of models is read than inverts

  Errors(const Bench& bench, ErrorSource source) {
    const auto has = [&](ErrorSource s) { return source == s || source == ErrorSource::all; };
    const auto size = [&](ErrorSource s, double of_bench) { return has(s) ? of_bench : 0; };
    noise = size(ErrorSource::noise, bench.noise);
    background_noise = size(ErrorSource::ambient, bench.noise);
    quantum = size(ErrorSource::quantum, bench.quantum);
    sensor_position = size(ErrorSource::sensor_position, bench.sensor_position);
    stage_azimuth = size(ErrorSource::stage_azimuth, bench.stage_azimuth);
    ambient = size(ErrorSource::ambient, 1) * bench.ambient;
    models = has(ErrorSource::models) && bench.truth.name() != bench.models.name();
  }
  /// Whether anything goes wrong. An ambient field does no harm without the noise of its reading.
  bool any() const {
    return noise > 0 || quantum > 0 || sensor_position > 0 || stage_azimuth > 0 ||
           (background_noise > 0 && ambient.norm() > 0) || models;
  }
};

/// What an estimator made of a reading.
struct Found {
  std::size_t draw;
  Vector2 truth;
  Vector2 load;
};

/// The errors of an estimator; each draw has as many readings.
BenchErrors errors_of(const std::vector<Found>& all, const std::optional<FlowLaw>& flow) {
  BenchErrors e;
  std::map<std::size_t, double> squares_of_draw;  // of the azimuth's error
  for (const auto& [draw, truth, load] : all) {
    const double relative = load.norm() / truth.norm() - 1;
    const double speed = flow ? flow->velocity(load.norm()) - flow->velocity(truth.norm()) : 0;
    const double angle = std::abs(std::remainder(
        std::atan2(load.y(), load.x()) - std::atan2(truth.y(), truth.x()), 2 * std::numbers::pi));
    e.magnitude_rms += relative * relative;
    e.speed_rms += speed * speed;
    e.azimuth_rms += angle * angle;
    e.azimuth_largest = std::max(e.azimuth_largest, angle);
    e.below_ten_degrees += angle < std::numbers::pi / 18 ? 1 : 0;
    squares_of_draw[draw] += angle * angle;
  }
  e.readings = all.size();
  const auto n = static_cast<double>(std::max<std::size_t>(1, all.size()));
  for (double* rms : {&e.magnitude_rms, &e.speed_rms, &e.azimuth_rms}) *rms = std::sqrt(*rms / n);
  e.below_ten_degrees /= n;
  const auto draws = static_cast<double>(squares_of_draw.size());
  if (draws < 2 || e.azimuth_rms == 0) return e;
  // d√x = dx/(2√x) with dx of the mean square x.
  double variance = 0;
  for (const auto& [draw, sum] : squares_of_draw)
    variance += std::pow(sum / (n / draws) - e.azimuth_rms * e.azimuth_rms, 2);
  const double standard_error = std::sqrt(variance / (draws - 1) / draws);
  e.azimuth_rms_interval =
      student_t_quantile(draws - 1, 0.975) * standard_error / (2 * e.azimuth_rms);
  return e;
}

/// The bench with all that its readings are made and inverted with.
class Simulation {
 public:
  Simulation(const Bench& bench, const Progress& progress);
  BenchResult run(const Progress& progress) const;

 private:
  struct Reading {
    std::size_t magnitude;  ///< index in the load path
    std::size_t draw;
    Vector2 truth;
    Eigen::VectorXd change;  ///< ΔB from the readings, without offsets
  };
  void simulate(const Errors& errors, std::size_t draw, std::vector<Reading>& readings) const;

  const Bench& bench_;
  Shapes model_shapes_;
  Shapes truth_shapes_;  ///< empty if the truth is the model
  std::unique_ptr<Response> response_;
  std::unique_ptr<Response> truth_;  ///< of sensors where they should be; null if it is the model
  std::unique_ptr<Inversion> invert_;
  std::unique_ptr<LinearFit> fit_;
};

Simulation::Simulation(const Bench& bench, const Progress& progress) : bench_(bench) {
  double largest = 0;
  for (const Load& load : bench.problem.load_path) largest = std::max(largest, magnitude(load));
  model_shapes_ = shapes_within(bench.problem, bench.models.mechanics, beyond_the_largest * largest,
                                with_prefix(progress, bench.models.mechanics + ": "));
  if (model_shapes_.largest() < largest)
    throw SolverError(fmt::format("no shape under the bench's largest load, {:g} {}: {}", largest,
                                  magnitude_unit(bench.problem.load_path.front()),
                                  model_shapes_.limit));
  response_ = std::make_unique<Response>(bench.problem, bench.models.field, model_shapes_,
                                         bench.problem.sensors);
  if (bench.truth.name() != bench.models.name()) {
    truth_shapes_ = bench.truth.mechanics == bench.models.mechanics
                        ? model_shapes_
                        : shapes_up_to(bench.problem, bench.truth.mechanics, largest,
                                       with_prefix(progress, bench.truth.mechanics + ": "));
    truth_ = std::make_unique<Response>(bench.problem, bench.truth.field, truth_shapes_,
                                        bench.problem.sensors);
  }
  const Vector3 noise = Vector3::Constant(std::max({bench.noise, bench.quantum, least_noise}));
  invert_ = std::make_unique<Inversion>(*response_, noise);
  fit_ = std::make_unique<LinearFit>(*response_, noise);
}

void Simulation::simulate(const Errors& errors, std::size_t draw,
                          std::vector<Reading>& readings) const {
  // The same random numbers in every simulation, whatever the size of its errors.
  std::mt19937 random(bench_.seed + static_cast<unsigned int>(draw));
  std::normal_distribution<double> normal;
  std::normal_distribution<double> of_position;
  std::vector<Vector3> sensors = bench_.problem.sensors;
  for (Vector3& sensor : sensors)
    for (double& coordinate : sensor) coordinate += errors.sensor_position * of_position(random);
  const bool other = errors.models;
  std::optional<Response> built;
  if (errors.sensor_position > 0)
    built.emplace(bench_.problem, other ? bench_.truth.field : bench_.models.field,
                  other ? truth_shapes_ : model_shapes_, sensors);
  const Response& truth = built ? *built : other ? *truth_ : *response_;
  const double stage = errors.stage_azimuth * normal(random);
  const auto components = static_cast<Eigen::Index>(3 * sensors.size());
  const auto read = [&](Eigen::VectorXd B, double noise) {
    for (double& component : B) component += noise * normal(random);
    if (errors.quantum > 0) B = (B / errors.quantum).array().round() * errors.quantum;
    return B;
  };
  const auto ambient = [&](double azimuth) -> Eigen::VectorXd {
    const Vector3 seen = Eigen::AngleAxisd(azimuth, Vector3::UnitZ()) * errors.ambient;
    return seen.replicate(components / 3, 1);
  };
  Eigen::VectorXd offset;
  for (unsigned int a = 0; a < bench_.azimuths; ++a) {
    const double azimuth = 2 * std::numbers::pi * a / bench_.azimuths;
    const Eigen::VectorXd background = read(ambient(azimuth), errors.background_noise);
    if (a == 0) offset = read(ambient(0) + truth.undeformed(), errors.noise) - background;
    for (std::size_t m = 0; m < bench_.problem.load_path.size(); ++m) {
      const double magnitude = ciliaval::magnitude(bench_.problem.load_path[m]);
      const auto load = [&](double angle) {
        return Vector2(magnitude * std::cos(angle), magnitude * std::sin(angle));
      };
      const Eigen::VectorXd B =
          read(ambient(azimuth) + truth.undeformed() + truth.change(load(azimuth + stage)),
               errors.noise);
      readings.push_back({m, draw, load(azimuth), B - background - offset});
    }
  }
}

BenchResult Simulation::run(const Progress& progress) const {
  BenchResult result;
  result.linear_misfit = fit_->misfit();
  const std::optional<FlowLaw> flow = flow_law(bench_.problem);
  std::vector<std::vector<Found>> by_magnitude(bench_.problem.load_path.size());
  for (const ErrorSource source :
       {ErrorSource::none, ErrorSource::noise, ErrorSource::quantum, ErrorSource::sensor_position,
        ErrorSource::stage_azimuth, ErrorSource::ambient, ErrorSource::models, ErrorSource::all}) {
    const Errors errors(bench_, source);
    if (!errors.any() && source != ErrorSource::none && source != ErrorSource::all) continue;
    const bool once = source == ErrorSource::none || source == ErrorSource::models;
    std::vector<Reading> readings;
    for (std::size_t draw = 0; draw < (once ? 1 : bench_.draws); ++draw) {
      if (progress)
        progress(fmt::format("{}: sensor {} of {}", to_string(source), draw + 1, bench_.draws));
      simulate(errors, draw, readings);
    }
    std::vector<Found> inversion;
    std::vector<Found> linear;
    for (const Reading& reading : readings) {
      const SensedLoad sensed = (*invert_)(reading.change);
      if (!sensed.converged) throw SolverError("the least squares of the bench did not converge");
      inversion.push_back({reading.draw, reading.truth, sensed.load});
      linear.push_back({reading.draw, reading.truth, (*fit_)(reading.change)});
      if (source != ErrorSource::all) continue;
      by_magnitude[reading.magnitude].push_back(inversion.back());
      if (reading.draw == 0) result.first_draw.push_back({reading.truth, sensed.load});
    }
    result.rows.push_back({source, errors_of(inversion, flow), errors_of(linear, flow)});
  }
  for (const std::vector<Found>& found : by_magnitude)
    result.by_magnitude.push_back(errors_of(found, flow));
  return result;
}

}  // namespace

std::string_view to_string(ErrorSource source) {
  constexpr std::array<std::string_view, 8> names{
      "none",          "noise",         "digits", "sensor position",
      "stage azimuth", "ambient field", "models", "all"};
  return names.at(static_cast<std::size_t>(source));
}

BenchResult run_bench(const Bench& bench, const Progress& progress) {
  return Simulation(bench, progress).run(progress);
}

}  // namespace ciliaval::compare::sensing
