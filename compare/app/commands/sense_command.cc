// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/app/commands/commands.h"
#include "compare/app/python.h"

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
the noise, of what the models leave out and of uncertain inputs. `nothing`: noise alone makes such a load; `misfit`: no load explains the reading; `beyond
range`: see --largest (docs/guide/sensing.md).)";

struct SenseOptions {
  std::filesystem::path file;
  std::filesystem::path readings;
  OptionalFile background;
  Outputs outputs;
  CLI::App* command = nullptr;
};

ExitCode execute_sense(const SenseOptions& options, const std::string& words) {
  require_one_rank("sense");
  std::vector<std::string> files{options.file.string()};
  if (!options.readings.empty()) files.push_back(options.readings.string());
  become_python_command("ciliaval.sensing", *options.command, words, files);
}

constexpr const char* calibrate_help = R"(
The case's load steps are the known loads, one for each reading (or sample, whose rows are
averaged), in their order. NUMBERS: any number of the case by the end of its path, and of a sensor
position, rotation, orientation, gain:

  ciliaval calibrate mine.toml known.csv --fit base.young_modulus,sensor.position
                     --unloaded "0 s..2 s" -o calibrated.toml

Each number has its interval of 95 % by the noise; what the readings cannot tell apart is named
(docs/guide/sensing.md).)";

struct CalibrateOptions {
  std::filesystem::path file;
  std::filesystem::path readings;
  Outputs outputs;
  CLI::App* command = nullptr;
};

ExitCode execute_calibrate(const CalibrateOptions& options, const std::string& words) {
  require_one_rank("calibrate");
  become_python_command("ciliaval.sensing", *options.command, words,
                        {options.file.string(), options.readings.string()});
}

/// An option that is a text to this program.
void add_text(CLI::App* command, const char* name, const char* type, const char* what) {
  command
      ->add_option_function<std::string>(
          name, [](const std::string&) {}, what)
      ->type_name(type);
}

/// Declares the options by which a file of readings is read.
void add_reading_options(CLI::App* command) {
  add_text(command, "--map", "\"bx=NAME, by=NAME, bz=NAME\"",
           "The columns of the readings, where their headers are not Bx, By, Bz or X, Y, Z");
  add_text(command, "--unit", "UNIT",
           "Of columns without one: T, mT, uT, nT, G, mG, or LSB with --scale");
  add_text(command, "--scale", "QUANTITY",
           "The flux density of an LSB, \"0.15 uT\" or \"6842 LSB/G\"; or three for x, y, z");
  add_text(command, "--unloaded", "RANGE",
           "The readings of the straight cilium: \"0 s..1 s\", \"rows 1..20\", or `model` for\n"
           "the model's own B; left out: rows of the sample `unloaded`");
  add_text(command, "--temperature", "QUANTITY",
           "By how much the reading of the same field grows with the column `temperature`,\n"
           "against the unloaded rows: \"-0.1 %/K\"");
  add_text(command, "--average", "TIME",
           "Take the mean of all readings within so long, such as \"10 ms\"");
  command->add_flag_callback(
      "--skip", [] {}, "Leave rows without B out, and count them");
  add_text(command, "--models", "MECHANICS/FIELD",
           "The pair of models, such as solid/mesh; of several, with commas between, the first\n"
           "one's loads and how far those of the others spread [elastica/volume]");
  add_text(command, "--joints", "WHICH",
           "Of the rod: `corrected` where the corrections reach, or `case`, as the case states\n"
           "them [corrected]");
  add_text(command, "--noise", "QUANTITY", "Standard deviation of a component of a reading [1 uT]");
}

}  // namespace

void add_sense(CommandLine& line) {
  const auto options = std::make_shared<SenseOptions>();
  CLI::App* sense = line.add(
      "sense",
      "From what the sensors read to the load: force or flow speed and direction of each reading,\n"
      "with intervals of 95 %.",
      options, execute_sense);
  options->command = sense;
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
  add_reading_options(sense);
  add_text(sense, "--largest", "QUANTITY",
           "The largest load to look for; left out: 1.25 times the case's largest");
  options->outputs.declare(
      sense, "the loads", true,
      "Figure of the loads found: over time with their bands, or over the true loads of\n"
      "a bench, or of the levels of a surface; SVG, PDF or PNG");
}

void add_calibrate(CommandLine& line) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* calibrate = line.add(
      "calibrate",
      "From readings at known loads to numbers of the case: moduli, magnetisation, the sensor's\n"
      "place, turn and gain, with intervals and what cannot be told apart.",
      options, execute_calibrate);
  options->command = calibrate;
  calibrate->footer(calibrate_help);
  add_file(calibrate, "CASE", options->file, "Case file (TOML) with the known loads and sensors");
  add_file(calibrate, "READINGS", options->readings, "Readings (CSV with units)");
  add_text(calibrate, "--fit", "NUMBERS", "What to find, with commas between");
  calibrate->get_option("--fit")->required();
  add_reading_options(calibrate);
  add_text(calibrate, "-o,--output", "FILE", "Write the calibrated case (TOML)");
  options->outputs.declare(calibrate, "the numbers");
}

}  // namespace ciliaval::compare::app::commands
