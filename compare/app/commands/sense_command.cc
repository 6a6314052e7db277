// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "compare/app/case_files.h"
#include "compare/app/python.h"
#include "compare/app/terminal.h"
#include "compare/input/units.h"
#include "compare/output/output_file.h"
#include "compare/output/provenance.h"
#include "compare/output/sweep.h"
#include "compare/sensing/bench.h"
#include "compare/sensing/profile.h"
#include "compare/sensing/sensing.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::app::commands {
namespace {

constexpr const char* sense_help = R"(
READINGS.csv has a header with units and a row for each reading:

  sample, Bx [uT], By [uT], Bz [uT]
  unloaded, 12.1, -33.0, 2231.5          the straight cilium; several rows: their mean
  first, 71.4, -1.2, 2230.9
  second, 100.2, 14.8, 2226.0

or dBx, dBy, dBz, what the load has changed. Files of loggers are read too: separators , ; and
tab, decimal commas, headers such as X, B_x, Bx [mG] or Bx_uT, several sensors side by side:

  ciliaval sense mine.toml log.csv --unit mG --unloaded "0 s..2 s" --map "bx=Ch 1,by=Ch 2,bz=Ch 3"

Without READINGS, CASE is a simulated test bench, NAME.sense.toml: errors of speed and direction,
and which error of the sensor makes them.

Of a case with the load `sweep`: the levels of the surface, in the order of the rows.
The load found is the least-squares solution with the chosen pair of models, its interval that of
the noise. `nothing`: noise alone makes such a load; `misfit`: no load explains the reading; `beyond
range`: see --largest (docs/guide/sensing.md).)";

struct SenseOptions {
  std::filesystem::path file;
  std::filesystem::path readings;
  OptionalFile background;
  input::external::ReadingOptions reading{
      {"", "--map"}, {"", "--unit"}, {"", "--scale"}, {"", "--unloaded"}};
  std::string models = "elastica/volume";
  std::string noise = "1 uT";          ///< standard deviation of each component of a reading
  std::optional<std::string> largest;  ///< load; else 1.25 times the case's largest
  Outputs outputs;
  std::vector<std::string> given;  ///< names of the options on the command line
};

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
  for (const auto& [sample, sensed] : sensing.samples) {
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

/// Simulates the test bench `options.file`.
ExitCode simulate_bench(const SenseOptions& options, const std::string& words) {
  const sensing::Bench bench = sensing::read_bench(options.file);
  options.outputs.check(input_files(options.file, bench.problem));
  ProgressLine line;
  const sensing::BenchResult result = sensing::run_bench(bench, line.callback());
  print(sensing::bench_text(bench, result));
  options.outputs.write(
      [&] { return sensing::bench_json(bench, result, output::provenance(words)); });
  return ExitCode::pass;
}

double noise_of(const SenseOptions& options) {
  const double noise = input::parse_quantity(options.noise, quantity::flux_density);
  constexpr double least_noise = 1e-15;  // T, less than any magnetometer's
  if (!(noise >= least_noise && noise <= 1))
    throw InputError("--noise: the noise of a reading lies between 1 fT and 1 T, not `" +
                     options.noise + '`');
  return noise;
}

/// The readings of a file, after a check of the outputs.
sensing::SensorReadings readings_of(const SenseOptions& options, const input::Case& problem) {
  std::vector<std::filesystem::path> inputs = input_files(options.file, problem);
  inputs.push_back(options.readings);
  if (options.background) inputs.push_back(*options.background);
  options.outputs.check(inputs);
  // What the command line says goes before the case.
  input::external::ReadingOptions reading = problem.readings;
  for (const input::external::ReadingKey& key : input::external::reading_keys())
    if ((options.reading.*key.option).given()) reading.*key.option = options.reading.*key.option;
  sensing::SensorReadings read = sensing::read_sensor_readings(
      options.readings, options.background, input::sensor_names(problem), reading);
  read.remark = fmt::format("{}: {}.", options.readings.filename().string(), read.remark);
  return read;
}

/// The surface's levels from the readings of a sweep. Returns `undecided` if there is none.
ExitCode sense_surface(const input::Case& problem, const SenseOptions& options,
                       const std::string& words) {
  const sensing::SensorReadings read = readings_of(options, problem);
  if (!read.measured_offset)
    throw InputError(options.readings.string() +
                     ": the levels of a surface need dBx, dBy, dBz, or unloaded rows");
  double largest = 0;
  for (const Load& load : problem.load_path) largest = std::max(largest, 4 * magnitude(load));
  if (options.largest) largest = input::parse_quantity(*options.largest, quantity::length);
  if (!(largest > 0 && largest < problem.cilium.length()))
    throw InputError(
        "--largest: the largest interference lies between 0 and the length of the "
        "cilium");
  const models::ModelPair pair = sensing::parse_pair(options.models);
  ProgressLine line;
  const sensing::LevelCurve curve(problem, pair, largest, line.callback());
  sensing::SensedProfile profile = sensing::sense_profile(curve, read, noise_of(options));
  profile.case_name = problem.name;
  profile.models = pair;
  line.clear();
  print(support::printable(read.remark) + '\n');
  if (!curve.limit().empty())
    print(fmt::format("Interferences are looked for up to {:.4g} mm, not {:.4g} mm: {}\n",
                      1e3 * curve.largest(), 1e3 * largest, curve.limit()));
  print(sensing::profile_text(profile));
  options.outputs.write([&] { return sensing::profile_json(profile, output::provenance(words)); },
                        [&] { return sensing::profile_csv(profile); });
  return profile.levels.empty() ? ExitCode::undecided : ExitCode::pass;
}

/// The load and its direction, with confidence intervals, from each reading of the case's sensors.
/// Returns `solver` if the least squares fails at a reading, `undecided` if no reading gives a
/// load.
ExitCode sense_readings(const SenseOptions& options, const std::string& words) {
  const input::Case problem = read_cases({options.file}).front();
  if (problem.sensors.empty()) throw InputError(options.file.string() + ": the case has no sensor");
  if (output::is_sweep(problem)) return sense_surface(problem, options, words);
  sensing::require_load_to_sense(problem);
  sensing::Sensing sensing;
  sensing.case_name = problem.name;
  sensing.models = sensing::parse_pair(options.models);
  sensing.noise = Vector3::Constant(noise_of(options));
  sensing.unit = magnitude_unit(problem.load_path.front());
  const double asked = largest_load(problem, options);
  sensing.flow = sensing::flow_law(problem);
  // Before the models run, which may take a minute.
  const sensing::SensorReadings read = readings_of(options, problem);
  ProgressLine line;
  const sensing::Shapes shapes =
      sensing::shapes_within(problem, sensing.models.mechanics, asked, line.callback());
  sensing.largest = shapes.largest();
  const sensing::Response response(problem, sensing.models.field, shapes, problem.sensors);
  sensing.interpolation_error = response.interpolation_error();
  sensing.largest_change = response.largest_change();
  sensing.measured_offset = read.measured_offset;
  sensing.remarks.push_back(support::printable(read.remark));
  if (auto range = sensing::range_remark(shapes, asked, sensing.unit))
    sensing.remarks.push_back(std::move(*range));
  if (auto doubt = sensing::scatter_remark(read.scatter, sensing.noise.x()))
    sensing.remarks.push_back(std::move(*doubt));
  const sensing::Inversion invert(response, sensing.noise);
  for (const sensing::Sample& sample : read.samples)
    sensing.samples.emplace_back(
        sample,
        invert(read.measured_offset ? sample.change
                                    : Eigen::VectorXd(sample.change - response.undeformed()),
               read.error(sample)));
  print(sensing::sensing_text(sensing));
  options.outputs.write([&] { return sensing::sensing_json(sensing, output::provenance(words)); },
                        [&] { return sensing::sensing_csv(sensing); });
  return exit_code(sensing);
}

ExitCode execute_sense(const SenseOptions& options, const std::string& words) {
  require_one_rank("sense");
  if (is_bench_file(options.file)) {
    if (!options.readings.empty())
      throw InputError(options.file.string() +
                       " is a test bench, which makes its own readings: leave " +
                       options.readings.string() + " out");
    refuse_options(options,
                   {"--background", "--models", "--noise", "--largest", "--csv", "--map", "--unit",
                    "--scale", "--unloaded"},
                   "a test bench states its models and errors in its file and has no table");
    return simulate_bench(options, words);
  }
  if (options.readings.empty())
    throw InputError("there is no file of readings after " + options.file.string() +
                     "; a test bench to be simulated is called NAME.sense.toml");
  return sense_readings(options, words);
}

void add_text(CLI::App* sense, const char* name, input::external::ReadingOptions::Text& option,
              const char* type, const char* what) {
  sense->add_option(name, option.text, what)->type_name(type);
}

}  // namespace

void add_sense(CommandLine& line) {
  const auto options = std::make_shared<SenseOptions>();
  CLI::App* sense = line.add(
      "sense",
      "From what the sensors read to the load: force or flow speed and direction of each reading,\n"
      "with intervals of 95 %.",
      options, execute_sense);
  sense->footer(sense_help);
  add_file(sense, "CASE", options->file,
           "Case file (TOML): cilium, kind of load, sensors; or a test bench,\n"
           "NAME.sense.toml, which is simulated");
  add_file(sense, "READINGS", options->readings, "Readings (CSV with units)")->required(false);
  sense
      ->add_option("--background", options->background,
                   "The ambient field at each azimuth of the stage (CSV: azimuth, Bx, By, Bz),\n"
                   "taken off the readings, which then have a column `azimuth`")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  add_text(sense, "--map", options->reading.map, "\"bx=NAME, by=NAME, bz=NAME\"",
           "The columns of the readings, where their headers are not Bx, By, Bz or X, Y, Z");
  add_text(sense, "--unit", options->reading.unit, "UNIT",
           "Of columns without one: T, mT, uT, nT, G, mG, or LSB with --scale");
  add_text(sense, "--scale", options->reading.scale, "QUANTITY",
           "The flux density of an LSB, \"0.15 uT\" or \"6842 LSB/G\"; or three for x, y, z");
  add_text(sense, "--unloaded", options->reading.unloaded, "RANGE",
           "The readings of the straight cilium: \"0 s..1 s\", \"rows 1..20\", or `model` for\n"
           "the model's own B; left out: rows of the sample `unloaded`");
  sense->add_option("--models", options->models, "The pair of models to invert, such as solid/mesh")
      ->type_name("MECHANICS/FIELD")
      ->capture_default_str();
  sense->add_option("--noise", options->noise, "Standard deviation of a component of a reading")
      ->type_name("QUANTITY")
      ->capture_default_str();
  sense
      ->add_option("--largest", options->largest,
                   "The largest load to look for; left out: 1.25 times the case's largest")
      ->type_name("QUANTITY");
  options->outputs.declare(
      sense, "the loads", true,
      "Figure of the loads found: over time with their bands, or over the true loads of\n"
      "a bench, or of the levels of a surface; SVG, PDF or PNG");
  sense->parse_complete_callback([options, sense] {
    for (const CLI::Option* option : sense->get_options())
      if (option->count() > 0) options->given.push_back(option->get_name());
  });
}

}  // namespace ciliaval::compare::app::commands
