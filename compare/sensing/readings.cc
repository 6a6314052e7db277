// SPDX-License-Identifier: LGPL-2.1-or-later
// A file of readings, less all offsets.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "compare/input/csv.h"
#include "compare/input/external/background.h"
#include "compare/input/units.h"
#include "compare/sensing/logger/file.h"
#include "compare/sensing/sensing.h"
#include "problem/error.h"
#include "problem/support/words.h"

namespace ciliaval::compare::sensing {
namespace {

using input::Faults;
using input::external::Background;
using input::external::ReadingOptions;

constexpr std::string_view unloaded = "unloaded";

/// Which rows are of the unloaded cilium, besides those of the sample `unloaded`.
struct UnloadedPart {
  enum class Kind { named, model, rows, time };
  Kind kind = Kind::named;
  double first = 0;  ///< row from 1, or s
  double last = 0;
  double resolution = 0;  ///< of the time, s: a row at a boundary belongs to the part

  bool holds(const logger::Row& row) const {
    if (kind != Kind::rows && kind != Kind::time) return false;
    const double value = kind == Kind::rows ? static_cast<double>(row.number) : row.time;
    return value >= first - resolution && value <= last + resolution;
  }
};

/// "0 s..1 s", "0..1 s", "rows 1..20" or "model".
UnloadedPart unloaded_part(const ReadingOptions::Text& option) {
  UnloadedPart part;
  if (!option.given()) return part;
  const std::string_view text = support::trimmed(option.text);
  if (text == "model") {
    part.kind = UnloadedPart::Kind::model;
    return part;
  }
  const auto refuse = [&](std::string_view why) {
    return InputError(
        fmt::format("{}: {} {}: write \"0 s..1 s\" by the time, \"rows 1..20\" by the "
                    "rows below the header, or \"model\"",
                    option.where, input::in_quotes(text), why));
  };
  constexpr std::string_view rows = "rows ";
  const bool by_rows = text.starts_with(rows);
  const std::string_view range = by_rows ? text.substr(rows.size()) : text;
  const auto dots = range.find("..");
  if (dots == std::string_view::npos) throw refuse("is no range");
  const std::string_view first = support::trimmed(range.substr(0, dots));
  const std::string_view last = support::trimmed(range.substr(dots + 2));
  if (by_rows) {
    constexpr std::size_t bound = input::most_csv_rows + 1;
    const auto from = input::external::index_in(std::string(first), bound);
    const auto to = input::external::index_in(std::string(last), bound);
    if (!from || !to || *from < 1) throw refuse("is no range of rows from 1 on");
    part = {UnloadedPart::Kind::rows, static_cast<double>(*from), static_cast<double>(*to)};
  } else {
    // A number alone has the unit of the other end.
    const auto unit = last.find_first_not_of("0123456789.+-eE ");
    const bool bare = first.find_first_not_of("0123456789.+-eE ") == std::string_view::npos;
    try {
      part = {UnloadedPart::Kind::time,
              input::parse_quantity(bare && unit != std::string_view::npos
                                        ? fmt::format("{} {}", first, last.substr(unit))
                                        : std::string(first),
                                    quantity::time),
              input::parse_quantity(last, quantity::time)};
    } catch (const InputError& fault) {
      throw refuse(fmt::format("is no range of time ({})", fault.what()));
    }
  }
  if (part.last < part.first) throw refuse("ends before it begins");
  return part;
}

/// The rows of a sample, by sensor.
struct RowsOfSample {
  std::string name;
  std::vector<std::vector<const logger::Row*>> rows;
};

/// Rows by sample in the order of the file, and those of the unloaded cilium.
struct Sorted {
  std::vector<RowsOfSample> samples;
  RowsOfSample unloaded;
};

/// What the rows of one sample have in common.
std::string sample_name(const logger::File& file, const logger::Row& row) {
  if (file.has_sample) return row.sample;
  if (file.has_sensor) return fmt::format("{} s", row.time);
  return std::to_string(row.number);
}

Sorted sorted(const logger::File& file, const UnloadedPart& part,
              std::span<const std::string> sensors, Faults& faults) {
  Sorted result;
  result.unloaded.name = unloaded;
  result.unloaded.rows.resize(sensors.size());
  std::unordered_map<std::string, std::size_t> index;
  for (const logger::Row& row : file.rows) {
    if (part.holds(row) || (file.has_sample && row.sample == unloaded)) {
      result.unloaded.rows[row.sensor].push_back(&row);
      continue;
    }
    std::string name = sample_name(file, row);
    const auto [place, is_new] = index.try_emplace(std::move(name), result.samples.size());
    if (is_new) result.samples.push_back({place->first, {}});
    auto& rows = result.samples[place->second].rows;
    rows.resize(sensors.size());
    rows[row.sensor].push_back(&row);
  }
  const auto require_all = [&](const RowsOfSample& sample) {
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (sample.rows[s].empty() && faults.size() < input::most_csv_faults)
        faults.add(file.rows.back().place, fmt::format("there is no row of sample {}, sensor {}",
                                                       input::in_quotes(sample.name), sensors[s]));
  };
  for (const RowsOfSample& sample : result.samples) require_all(sample);
  if (std::ranges::any_of(result.unloaded.rows, [](const auto& rows) { return !rows.empty(); }))
    require_all(result.unloaded);
  return result;
}

/// Adds the faults of rows that are unloaded and of an option that says otherwise.
void check_unloaded(const logger::File& file, const Sorted& rows, const UnloadedPart& part,
                    const ReadingOptions::Text& option, Faults& faults) {
  using Kind = UnloadedPart::Kind;
  const logger::Row* named = nullptr;
  for (const auto& of_sensor : rows.unloaded.rows)
    for (const logger::Row* row : of_sensor)
      if (named == nullptr && file.has_sample && row->sample == unloaded) named = row;
  const bool any =
      std::ranges::any_of(rows.unloaded.rows, [](const auto& r) { return !r.empty(); });
  if (file.is_change && named != nullptr)
    faults.add(named->place, "the change dB of the unloaded cilium is zero: leave its rows out");
  else if (file.is_change && part.kind != Kind::named)
    faults.add({},
               fmt::format("the change dB needs no unloaded reading: leave {} out", option.where));
  else if (named != nullptr && part.kind != Kind::named)
    faults.add(named->place,
               fmt::format("there are rows of the sample `unloaded`: leave {} out", option.where));
  else if (!any && (part.kind == Kind::rows || part.kind == Kind::time))
    faults.add(
        {}, fmt::format("no row lies in \"{}\" of {}: the file has {}", option.text, option.where,
                        part.kind == Kind::rows
                            ? fmt::format("the rows 1..{}", file.row_count)
                            : fmt::format("the times {:g} s..{:g} s", file.rows.front().time,
                                          file.rows.back().time)));
  else if (!rows.samples.empty() && !any && !file.is_change && part.kind == Kind::named)
    faults.add({},
               "there is no reading of the unloaded cilium, without which the earth's field would "
               "be read as load: name its rows `unloaded` in a column 'sample', or say which they "
               "are: --unloaded \"0 s..1 s\" by the time or --unloaded \"rows 1..20\"; --unloaded "
               "model takes the model's own B instead");
  if (rows.samples.empty() && faults.empty())
    faults.add({}, "there is no reading but of the unloaded cilium");
}

/// The mean of a sample's rows, less the background.
struct MeanOfRows {
  Eigen::VectorXd B;  ///< of all sensors one after the other, T
  /// [sensor, mean of the background]: with which weights they were taken off.
  Eigen::MatrixXd background;
};

/// The squares of rows (3 × rows) about their mean, weighted by V⁻¹, over σ²: χ² of 3 (rows − 1)
/// degrees of freedom. Each row has the noise 1 of its own, and by W (rows × means) that of the
/// background: V = I + W D Wᵀ, D the variances of its means. V⁻¹ = I − W (D⁻¹ + WᵀW)⁻¹ Wᵀ
/// (Woodbury).
double squares_about_mean(const Eigen::Matrix3Xd& rows, const Eigen::MatrixXd& W,
                          const Eigen::VectorXd& inverse_D) {
  const Eigen::MatrixXd x = (rows.colwise() - rows.rowwise().mean()).transpose();
  // Rows of one azimuth have the background's error in common: it is gone with their mean.
  if (W.cols() == 0 || (W.rowwise() - W.row(0)).isZero()) return x.squaredNorm();
  const Eigen::LLT<Eigen::MatrixXd> inner(Eigen::MatrixXd(inverse_D.asDiagonal()) +
                                          W.transpose() * W);
  const auto weighted = [&](const Eigen::MatrixXd& y) -> Eigen::MatrixXd {
    return y - W * inner.solve(W.transpose() * y);
  };
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(x.rows());
  const Eigen::VectorXd of_ones = weighted(ones);
  return x.cwiseProduct(weighted(x)).sum() -
         (of_ones.transpose() * x).squaredNorm() / of_ones.sum();
}

/// The mean of each sensor's rows, each less the background at its azimuth. Adds their scatter.
MeanOfRows mean_of(const RowsOfSample& sample, const Background* background, Scatter& scatter,
                   Faults& faults) {
  const auto sensors = static_cast<Eigen::Index>(sample.rows.size());
  const auto means =
      static_cast<Eigen::Index>(background == nullptr ? 0 : background->mean_count());
  MeanOfRows result{Eigen::VectorXd::Zero(3 * sensors), Eigen::MatrixXd::Zero(sensors, means)};
  Eigen::VectorXd rows_of_mean(means);
  for (Eigen::Index k = 0; k < means; ++k)
    rows_of_mean[k] = static_cast<double>(background->rows(static_cast<std::size_t>(k)));
  for (Eigen::Index s = 0; s < sensors; ++s) {
    const auto sensor = static_cast<std::size_t>(s);
    const auto count = static_cast<Eigen::Index>(sample.rows[sensor].size());
    Eigen::Matrix3Xd read(3, count);
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count, means);
    for (Eigen::Index i = 0; i < count; ++i) {
      const logger::Row& row = *sample.rows[sensor][static_cast<std::size_t>(i)];
      read.col(i) = row.B;
      if (background == nullptr) continue;
      const auto parts = background->parts(row.azimuth, sensor);
      if (!parts) {
        faults.add(row.place,
                   "the background has a single azimuth, which is not this row's: measure it at "
                   "more");
        continue;
      }
      read.col(i) -= *background->at(row.azimuth, sensor);
      for (const Background::Part& part : *parts)
        weights(i, static_cast<Eigen::Index>(part.mean)) += part.weight;
    }
    result.B.segment<3>(3 * s) = read.rowwise().mean();
    if (means > 0) result.background.row(s) = weights.colwise().mean();
    if (count > 1) scatter.squares += squares_about_mean(read, weights, rows_of_mean);
    scatter.freedom += 3 * static_cast<std::size_t>(count - 1);
  }
  return result;
}

/// The covariance of the sensors' ΔB by the background's noise, over σ²: A D Aᵀ with A the weights
/// of its means in ΔB and D = diag(1/rows). Empty without a background.
Eigen::MatrixXd background_covariance(const Eigen::MatrixXd& A, const Background* background) {
  if (background == nullptr) return {};
  Eigen::VectorXd D(A.cols());
  for (Eigen::Index k = 0; k < A.cols(); ++k)
    D[k] = 1 / static_cast<double>(background->rows(static_cast<std::size_t>(k)));
  return A * D.asDiagonal() * A.transpose();
}

std::size_t fewest_rows(const RowsOfSample& sample) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const auto& rows : sample.rows) fewest = std::min(fewest, rows.size());
  return fewest;
}

SensorReadings readings_of(const logger::File& file, const Background* background,
                           std::span<const std::string> sensors, const ReadingOptions& options,
                           Faults& faults) {
  UnloadedPart part = unloaded_part(options.unloaded);
  if (part.kind == UnloadedPart::Kind::time) part.resolution = file.time_resolution;
  SensorReadings result;
  result.remark = file.remark;
  if (part.kind == UnloadedPart::Kind::time && !file.has_time) {
    faults.add({},
               fmt::format("{} is a range of time, but {}; --unloaded \"rows 1..20\" needs none",
                           options.unloaded.where, file.timeless));
    return result;
  }
  const Sorted rows = sorted(file, part, sensors, faults);
  if (faults.empty()) check_unloaded(file, rows, part, options.unloaded, faults);
  if (!faults.empty()) return result;
  result.measured_offset = file.is_change;
  std::optional<MeanOfRows> offset;
  if (!rows.unloaded.rows.front().empty()) {
    offset = mean_of(rows.unloaded, background, result.scatter, faults);
    const std::size_t count = fewest_rows(rows.unloaded);
    result.offset_variance = 1 / static_cast<double>(count);
    result.measured_offset = true;
    result.remark += fmt::format("; {} unloaded", count);
  }
  result.samples.reserve(rows.samples.size());
  for (const RowsOfSample& of_sample : rows.samples) {
    MeanOfRows mean = mean_of(of_sample, background, result.scatter, faults);
    if (offset) {
      mean.B -= offset->B;
      mean.background -= offset->background;
    }
    Sample sample{of_sample.name, std::move(mean.B), fewest_rows(of_sample)};
    sample.background = background_covariance(mean.background, background);
    if (file.has_time) sample.time = of_sample.rows.front().front()->time;
    result.samples.push_back(std::move(sample));
    if (faults.size() >= input::most_csv_faults) break;
  }
  return result;
}

/// Throws InputError with the faults of a file.
void require_none(const Faults& faults, const std::filesystem::path& file) {
  if (!faults.empty()) throw InputError(faults.report(file.string()));
}

/// Adds a fault unless each row tells its sensor and its sample, where the case has several.
void check_sensors(const logger::File& file, std::size_t sensors, Faults& faults) {
  const bool wide = file.rows.size() == sensors * file.row_count;
  if (sensors == 1 || wide) return;
  if (!file.has_sensor || !(file.has_sample || file.has_time))
    faults.add({}, fmt::format("the case has {} sensors: the file needs the columns 'sample' and "
                               "'sensor', and a row for each; or columns for each, such as "
                               "s0_Bx, s0_By, s0_Bz, s1_Bx",
                               sensors));
}

}  // namespace

SensorReadings read_sensor_readings(const std::filesystem::path& file,
                                    const std::optional<std::filesystem::path>& background,
                                    std::span<const std::string> sensors,
                                    const ReadingOptions& options) {
  std::optional<Background> ambient;
  if (background) {
    Faults faults;
    const std::string text = input::read_csv_file(*background);
    ambient.emplace(text, sensors, faults);
    require_none(faults, *background);
  }
  Faults faults;
  const logger::File read = logger::read_file(input::read_csv_file(file), sensors, options, faults);
  if (faults.empty()) check_sensors(read, sensors.size(), faults);
  if (faults.empty() && ambient && !read.has_azimuth)
    faults.add({}, "the background depends on the azimuth: the readings need a column 'azimuth'");
  if (faults.empty() && ambient && read.is_change)
    faults.add({}, "the change dB has no background any more: leave the background out");
  require_none(faults, file);
  SensorReadings result =
      readings_of(read, ambient ? &*ambient : nullptr, sensors, options, faults);
  require_none(faults, file);
  return result;
}

}  // namespace ciliaval::compare::sensing
