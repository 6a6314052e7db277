// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/sense_command.h"

#include <algorithm>

#include "compare/app/case_files.h"
#include "compare/output/provenance.h"
#include "compare/output/results.h"
#include "compare/sensing/bench.h"
#include "compare/sensing/sensing.h"
#include "compare/app/terminal.h"
#include "compare/input/units.h"
#include "fem/parallel.h"
#include "problem/error.h"

namespace ciliaval::compare {
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
double largest_load(const Case& problem, const SenseOptions& options) {
  if (options.largest)
    return parse_quantity(*options.largest, load_quantity(problem.load_path.front()));
  double largest = 0;
  for (const Load& load : problem.load_path) largest = std::max(largest, magnitude(load));
  if (!(largest > 0)) throw InputError("the case has no load but zero: say --largest");
  return 1.25 * largest;
}

ExitCode exit_code(const Sensing& sensing) {
  bool any = false;
  for (const auto& [name, sensed] : sensing.samples) {
    const SenseStatus status = status_of(sensed);
    if (status == SenseStatus::failed) return ExitCode::solver;
    any = any || status == SenseStatus::found || status == SenseStatus::nothing;
  }
  return any ? ExitCode::pass : ExitCode::undecided;
}

}  // namespace

ExitCode sense(const std::filesystem::path& file, const std::filesystem::path& readings,
               const SenseOptions& options) {
  if (is_bench_file(file)) {
    if (!readings.empty())
      throw InputError(file.string() + " is a test bench, which makes its own readings: leave " +
                       readings.string() + " out");
    return sense_bench(file, options);
  }
  if (readings.empty())
    throw InputError("there is no file of readings after " + file.string() +
                     "; a test bench to be simulated is called NAME.sense.toml");
  return sense_readings(file, readings, options);
}

ExitCode sense_bench(const std::filesystem::path& file, const SenseOptions& options) {
  require_one_rank();
  const Bench bench = read_bench(file);
  ProgressLine line;
  const BenchResult result = run_bench(bench, line.callback());
  print(bench_text(bench, result));
  if (options.json)
    replace_text(*options.json, bench_json(bench, result, provenance(options.command)));
  if (options.plot) plot::write_svg(*options.plot, bench_script(bench, result), {700, 760});
  return ExitCode::pass;
}

ExitCode sense_readings(const std::filesystem::path& file, const std::filesystem::path& readings,
                        const SenseOptions& options) {
  require_one_rank();
  const Case problem = read_cases({file}).front();
  if (problem.sensors.empty()) throw InputError(file.string() + ": the case has no sensor");
  Sensing sensing;
  sensing.case_name = problem.name;
  sensing.models = parse_pair(options.models);
  const double noise = parse_quantity(options.noise, quantity::flux_density);
  if (!(noise > 0))
    throw InputError("--noise: the noise of a reading must be finite and positive, not `" +
                     options.noise + '`');
  sensing.noise = Vector3::Constant(noise);
  sensing.unit = magnitude_unit(problem.load_path.front());
  sensing.largest = largest_load(problem, options);
  sensing.flow = flow_law(problem);
  // Before the models run, which may take a minute.
  const SensorReadings read =
      read_sensor_readings(readings, options.background, problem.sensors.size());
  ProgressLine line;
  const Shapes shapes =
      shapes_up_to(problem, sensing.models.mechanics, sensing.largest, line.callback());
  const Response response(problem, sensing.models.field, shapes, problem.sensors);
  sensing.interpolation_error = response.interpolation_error();
  sensing.largest_change = response.largest_change();
  const Inversion invert(response, read.noise_factor * sensing.noise);
  sensing.measured_offset = read.measured_offset;
  for (const Sample& sample : read.samples)
    sensing.samples.emplace_back(
        sample.name,
        invert(read.measured_offset ? sample.change
                                    : Eigen::VectorXd(sample.change - response.undeformed())));
  print(sensing_text(sensing));
  if (options.json) replace_text(*options.json, sensing_json(sensing, provenance(options.command)));
  if (options.csv) replace_text(*options.csv, sensing_csv(sensing));
  return exit_code(sensing);
}

}  // namespace ciliaval::compare
