// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/surroundings/surface.h"

#include <algorithm>
#include <boost/math/interpolators/makima.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "problem/error.h"

namespace ciliaval::surroundings {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double curvature_step = 1e-5;  ///< over the distance of two points
constexpr double most_waves = 100'000;

void require(bool holds, const std::string& message) {
  if (!holds) throw InputError("the surface: " + message);
}

bool is_positive(double value) {
  return std::isfinite(value) && value > 0;
}

bool is_not_negative(double value) {
  return std::isfinite(value) && value >= 0;
}

ProfilePoint point(const FlatProfile& /*flat*/, double /*x*/) {
  return {};
}

ProfilePoint point(const SineProfile& sine, double x) {
  const double k = two_pi / sine.wavelength;
  const double height = sine.amplitude * std::sin(k * x);
  return {height, sine.amplitude * k * std::cos(k * x), -k * k * height};
}

/// Point of an arc of radius r that touches the level p = 0 at x = 0 and rises.
ProfilePoint on_arc(double radius, double x) {
  const double cosine = std::sqrt(1 - x * x / (radius * radius));
  return {radius * (1 - cosine), x / (radius * cosine), 1 / (radius * std::pow(cosine, 3))};
}

/// Distance from a corner at which its arc touches the level side, m.
double edge_length(const TrapezoidProfile& t) {
  return t.radius * std::tan(std::atan2(t.height, t.flank) / 2);
}

ProfilePoint point(const TrapezoidProfile& t, double x) {
  const double period = t.bottom + t.top + 2 * t.flank;
  // By symmetry x lies in the half period from the middle of a valley to that of a plateau.
  const double from_valley = std::remainder(x, period);
  const double sign = from_valley < 0 ? -1 : 1;
  const double distance = std::abs(from_valley);
  // And by antisymmetry about the middle of the flank in the valley's half of it.
  const double middle = (t.bottom + t.flank) / 2;
  const bool upper = distance > middle;
  const double corner = (upper ? t.top : t.bottom) / 2;
  const double to_corner = (upper ? period / 2 - distance : distance) - corner;
  const double edge = edge_length(t);
  const double slope = t.height / t.flank;
  ProfilePoint low;
  if (to_corner > -edge) {
    const double flank_end = edge / std::sqrt(1 + slope * slope);  // where the arc touches it
    low = to_corner < flank_end ? on_arc(t.radius, to_corner + edge)
                                : ProfilePoint{slope * to_corner, slope};
  }
  return {upper ? t.height - low.height : low.height, sign * low.slope,
          upper ? -low.curvature : low.curvature};
}

ProfilePoint point(const SampledProfile& samples, double x) {
  return samples.at(x);
}

ProfilePoint point(const RandomProfile& random, double x) {
  return random.at(x);
}

void check(const FlatProfile& /*flat*/) {}

void check(const SineProfile& sine) {
  require(is_not_negative(sine.amplitude), "its amplitude must be finite and not negative");
  require(is_positive(sine.wavelength), "its wavelength must be finite and positive");
}

void check(const TrapezoidProfile& t) {
  require(is_not_negative(t.height), "its height must be finite and not negative");
  require(is_positive(t.top) && is_positive(t.bottom),
          "its top and its bottom must be finite and positive");
  require(is_positive(t.flank),
          "its flank must be finite and positive: an upright step cannot be followed");
  require(is_positive(t.radius),
          "the radius of its edges must be finite and positive: a sharp one has no normal that a "
          "tip could follow");
  const double edge = edge_length(t);
  require(edge <= std::min(t.top, t.bottom) / 2 && 2 * edge <= std::hypot(t.flank, t.height),
          "the arcs of its edges take more room than its top, bottom and flanks have: choose a "
          "smaller radius");
}

void check(const SampledProfile& /*samples*/) {}  // its constructor checks

void check(const RandomProfile& /*random*/) {}  // likewise

void check(const RandomProfile::Parameters& p) {
  require(is_not_negative(p.rms), "its rms must be finite and not negative");
  require(p.hurst >= 0 && p.hurst <= 1, "its hurst exponent must lie between 0 and 1");
  require(is_positive(p.shortest) && std::isfinite(p.longest) && p.longest >= p.shortest,
          "its wavelengths must be finite and positive, the longest one not below the shortest");
  require(p.longest / p.shortest <= most_waves,
          "its longest wavelength is more than 100,000 times the shortest");
}

double finest(const FlatProfile& /*flat*/) {
  return std::numeric_limits<double>::infinity();
}

double finest(const SineProfile& sine) {
  return sine.wavelength;
}

double finest(const TrapezoidProfile& t) {
  return t.radius;
}

double finest(const SampledProfile& samples) {
  return samples.closest();
}

double finest(const RandomProfile& random) {
  return random.parameters().shortest;
}

}  // namespace

// ------------------------------------------------------------------------------------ sampled

struct SampledProfile::Cubic {
  double first;
  double last;
  double closest;
  boost::math::interpolators::makima<std::vector<double>> height;
};

SampledProfile::SampledProfile(std::vector<double> x, std::vector<double> height) {
  require(x.size() == height.size() && x.size() >= fewest_points,
          "a profile needs four points or more");
  const auto finite = [](double value) { return std::isfinite(value); };
  require(std::ranges::all_of(x, finite) && std::ranges::all_of(height, finite),
          "a point of its profile is not finite");
  require(std::ranges::adjacent_find(x, std::greater_equal<>()) == x.end(),
          "the x of its profile must increase from point to point");
  double closest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < x.size(); ++i) closest = std::min(closest, x[i] - x[i - 1]);
  const double first = x.front();
  const double last = x.back();
  cubic_ =
      std::make_shared<const Cubic>(Cubic{first, last, closest, {std::move(x), std::move(height)}});
}

double SampledProfile::first() const {
  return cubic_->first;
}

double SampledProfile::last() const {
  return cubic_->last;
}

double SampledProfile::closest() const {
  return cubic_->closest;
}

ProfilePoint SampledProfile::at(double x) const {
  if (!(x >= first() && x <= last()))
    throw InputError("the surface: the sweep leaves its profile, which goes from x = " +
                     std::to_string(1e3 * first()) + " to " + std::to_string(1e3 * last()) +
                     " mm; the point at " + std::to_string(1e3 * x) +
                     " mm is needed: a shorter travel, or a longer profile");
  // The cubic's second derivative is linear between the points.
  const double h = curvature_step * closest();
  const double a = std::max(x - h, first());
  const double b = std::min(x + h, last());
  const double slope = cubic_->height.prime(x);
  return {cubic_->height(x), slope, (cubic_->height.prime(b) - cubic_->height.prime(a)) / (b - a)};
}

// ------------------------------------------------------------------------------------- random

RandomProfile::RandomProfile(const Parameters& parameters) : parameters_(parameters) {
  check(parameters);
  const auto count =
      static_cast<std::size_t>(parameters.longest / parameters.shortest * (1 + 1e-12));
  std::mt19937 generator(parameters.seed);
  double power = 0;
  for (std::size_t j = 1; j <= count; ++j) {
    const double number = static_cast<double>(j);
    const double amplitude = std::pow(number, -(1 + 2 * parameters.hurst) / 2);
    power += amplitude * amplitude / 2;
    // The standard library's distributions give other bits on other machines.
    const double unit = (static_cast<double>(generator()) + 0.5) / 4294967296.0;
    waves_.push_back({amplitude, two_pi * number / parameters.longest, two_pi * unit});
  }
  for (Wave& wave : waves_) wave.amplitude *= parameters.rms / std::sqrt(power);
}

ProfilePoint RandomProfile::at(double x) const {
  ProfilePoint sum;
  for (const auto& [amplitude, number, phase] : waves_) {
    const double height = amplitude * std::cos(number * x + phase);
    sum.height += height;
    sum.slope -= number * amplitude * std::sin(number * x + phase);
    sum.curvature -= number * number * height;
  }
  return sum;
}

// ------------------------------------------------------------------------------------ surface

ProfilePoint Surface::at(double x) const {
  ProfilePoint result = std::visit([&](const auto& kind) { return point(kind, x); }, profile);
  const double slope = std::tan(tilt);
  result.height += slope * x;
  result.slope += slope;
  return result;
}

ProfilePoint Surface::extended(double x) const {
  const auto* samples = std::get_if<SampledProfile>(&profile);
  if (samples == nullptr) return at(x);
  const double inside = std::clamp(x, samples->first(), samples->last());
  ProfilePoint result = at(inside);
  result.height += result.slope * (x - inside);
  if (x != inside) result.curvature = 0;
  return result;
}

double Surface::finest_length() const {
  return std::visit([](const auto& kind) { return finest(kind); }, profile);
}

void require_valid(const Surface& surface) {
  require(is_not_negative(surface.friction),
          "its friction coefficient must be finite and not negative");
  require(std::abs(surface.tilt) < std::numbers::pi / 4, "its tilt must be less than 45 degrees");
  std::visit([](const auto& kind) { check(kind); }, surface.profile);
}

std::shared_ptr<const Surface> surface_of(const StatedSurface& stated) {
  using Kind = StatedSurface::Kind;
  Surface surface{FlatProfile{}, stated.friction, stated.tilt};
  if (stated.kind == Kind::sine) surface.profile = stated.sine;
  if (stated.kind == Kind::trapezoid) surface.profile = stated.trapezoid;
  if (stated.kind == Kind::random) surface.profile = RandomProfile(stated.random);
  if (stated.kind == Kind::file) surface.profile = stated.sampled.value();
  require_valid(surface);
  return std::make_shared<const Surface>(std::move(surface));
}

}  // namespace ciliaval::surroundings
