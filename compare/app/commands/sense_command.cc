// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/sense_command.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "compare/app/case_files.h"
#include "compare/app/terminal.h"
#include "compare/input/units.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/sensing/bench.h"
#include "compare/sensing/sensing.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare::app::commands {
namespace {

void require_one_rank() {
  if (fem::rank_count() > 1)
    throw InputError("`ciliaval sense` runs on one rank: start it without mpirun");
}

const Quantity& load_quantity(const Load& load) {
  const std::string_view unit = magnitude_unit(load);
  if (unit == "N") return quantity::force;
  return unit == "m" ? quantity::length : quantity::force_per_length;
}

/// The largest load to be found.
double largest_load(const input::Case& problem, const SenseOptions& options) {
  if (options.largest)
    return input::parse_quantity(*options.largest, load_quantity(problem.load_path.front()));
  double largest = 0;
  for (const Load& load : problem.load_path) largest = std::max(largest, magnitude(load));
  if (!(largest > 0)) throw InputError("the case has no load but zero: say --largest");
  return 1.25 * largest;
}

ExitCode exit_code(const sensing::Sensing& sensing) {
  bool any = false;
  for (const auto& [name, sensed] : sensing.samples) {
    const sensing::SenseStatus status = sensing::status_of(sensed);
    if (status == sensing::SenseStatus::failed) return ExitCode::solver;
    any = any || status == sensing::SenseStatus::found || status == sensing::SenseStatus::nothing;
  }
  return any ? ExitCode::pass : ExitCode::undecided;
}

/// Throws InputError if an option was given that has no effect here.
void refuse_options(const SenseOptions& options, std::initializer_list<std::string_view> unfit,
                    const char* why) {
  for (const std::string& name : options.given)
    if (std::find(unfit.begin(), unfit.end(), name) != unfit.end())
      throw InputError(name + ": " + why + ": leave it out");
}

}  // namespace

ExitCode sense(const std::filesystem::path& file, const std::filesystem::path& readings,
               const SenseOptions& options) {
  if (is_bench_file(file)) {
    if (!readings.empty())
      throw InputError(file.string() + " is a test bench, which makes its own readings: leave " +
                       readings.string() + " out");
    refuse_options(options, {"--background", "--models", "--noise", "--largest", "--csv"},
                   "a test bench states its models and errors in its file and has no table");
    return sense_bench(file, options);
  }
  if (readings.empty())
    throw InputError("there is no file of readings after " + file.string() +
                     "; a test bench to be simulated is called NAME.sense.toml");
  refuse_options(options, {"--plot"}, "a plot shows a test bench, not readings");
  return sense_readings(file, readings, options);
}

ExitCode sense_bench(const std::filesystem::path& file, const SenseOptions& options) {
  require_one_rank();
  const sensing::Bench bench = sensing::read_bench(file);
  output::check_outputs({options.json, options.plot}, input_files(file, bench.problem));
  ProgressLine line;
  const sensing::BenchResult result = sensing::run_bench(bench, line.callback());
  print(sensing::bench_text(bench, result));
  if (options.json)
    output::write_file(*options.json,
                       sensing::bench_json(bench, result, output::provenance(options.command)));
  if (options.plot)
    plot::write_svg(*options.plot, sensing::bench_script(bench, result), {700, 760});
  return ExitCode::pass;
}

ExitCode sense_readings(const std::filesystem::path& file, const std::filesystem::path& readings,
                        const SenseOptions& options) {
  require_one_rank();
  const input::Case problem = read_cases({file}).front();
  if (problem.sensors.empty()) throw InputError(file.string() + ": the case has no sensor");
  sensing::Sensing sensing;
  sensing.case_name = problem.name;
  sensing.models = sensing::parse_pair(options.models);
  const double noise = input::parse_quantity(options.noise, quantity::flux_density);
  constexpr double least_noise = 1e-15;  // T, less than any magnetometer's
  if (!(noise >= least_noise && noise <= 1))
    throw InputError("--noise: the noise of a reading lies between 1 fT and 1 T, not `" +
                     options.noise + '`');
  sensing.noise = Vector3::Constant(noise);
  sensing.unit = magnitude_unit(problem.load_path.front());
  sensing.largest = largest_load(problem, options);
  sensing.flow = sensing::flow_law(problem);
  std::vector<std::filesystem::path> inputs = input_files(file, problem);
  inputs.push_back(readings);
  if (options.background) inputs.push_back(*options.background);
  output::check_outputs({options.json, options.csv}, inputs);
  // Before the models run, which may take a minute.
  const sensing::SensorReadings read =
      sensing::read_sensor_readings(readings, options.background, problem.sensors.size());
  ProgressLine line;
  const sensing::Shapes shapes =
      sensing::shapes_up_to(problem, sensing.models.mechanics, sensing.largest, line.callback());
  const sensing::Response response(problem, sensing.models.field, shapes, problem.sensors);
  sensing.interpolation_error = response.interpolation_error();
  sensing.largest_change = response.largest_change();
  const sensing::Inversion invert(response, read.noise_factor * sensing.noise);
  sensing.measured_offset = read.measured_offset;
  for (const sensing::Sample& sample : read.samples)
    sensing.samples.emplace_back(
        sample.name,
        invert(read.measured_offset ? sample.change
                                    : Eigen::VectorXd(sample.change - response.undeformed())));
  print(sensing::sensing_text(sensing));
  if (options.json)
    output::write_file(*options.json,
                       sensing::sensing_json(sensing, output::provenance(options.command)));
  if (options.csv) output::write_file(*options.csv, sensing::sensing_csv(sensing));
  return exit_code(sensing);
}

}  // namespace ciliaval::compare::app::commands
