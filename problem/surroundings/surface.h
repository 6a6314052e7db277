// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace ciliaval::surroundings {

/// Height p of a profile at a point, and its derivatives by the distance x along it.
struct ProfilePoint {
  double height = 0;     ///< p, m, positive towards the cilium
  double slope = 0;      ///< p′
  double curvature = 0;  ///< p″, 1/m; one-sided where it jumps
};

/// p = 0.
struct FlatProfile {};

/// p = a sin(2πx/λ).
struct SineProfile {
  double amplitude = 0;   ///< a, m
  double wavelength = 0;  ///< λ, m
};

/// Plateaus p = h of length `top` and valleys p = 0 of length `bottom`, by turns, with straight
/// flanks between them and edges that are arcs of a circle, tangent to both sides. x = 0 is the
/// middle of a valley.
struct TrapezoidProfile {
  double height = 0;  ///< h, m
  double top = 0;     ///< of the plateau, edges included up to the corner, m
  double bottom = 0;  ///< of the valley, likewise, m
  double flank = 0;   ///< length of a flank along x, m
  double radius = 0;  ///< of the edges, m
};

/// Heights at points x₀ < x₁ < …, by Akima's modified cubic between them (C¹, hardly any
/// overshoot).
class SampledProfile {
 public:
  static constexpr std::size_t fewest_points = 4;

  /// Throws InputError if there are fewer than four points, one is not finite, or the x do not
  /// increase.
  SampledProfile(std::vector<double> x, std::vector<double> height);

  double first() const;
  double last() const;
  double closest() const;  ///< distance of two points
  ProfilePoint at(double x) const;

 private:
  struct Cubic;
  std::shared_ptr<const Cubic> cubic_;
};

/// A self-affine profile, the sum of cosines with random phases
///
///     p = Σ a_j cos(2π j x/λ_longest + φ_j),  a_j² ∝ j^−(1+2H),  Σ a_j²/2 = rms²,
///
/// for all whole j with λ_longest/j ≥ λ_shortest: the power spectral density of a profile of Hurst
/// exponent H (Jacobs, Junge and Pastewka, Surf. Topogr.: Metrol. Prop. 5, 013001, 2017). Its
/// period is λ_longest.
class RandomProfile {
 public:
  struct Parameters {
    double rms = 0;       ///< m
    double hurst = 0;     ///< H, 0 to 1
    double longest = 0;   ///< λ_longest, m
    double shortest = 0;  ///< λ_shortest, m
    std::uint32_t seed = 1;
  };
  /// Throws InputError as require_valid(Surface).
  explicit RandomProfile(const Parameters& parameters);

  const Parameters& parameters() const { return parameters_; }
  ProfilePoint at(double x) const;

 private:
  struct Wave {
    double amplitude;  ///< m
    double number;     ///< 2πj/λ, 1/m
    double phase;
  };
  Parameters parameters_;
  std::vector<Wave> waves_;
};

using Profile =
    std::variant<FlatProfile, SineProfile, TrapezoidProfile, SampledProfile, RandomProfile>;

/// A rigid surface above the cilium, which passes over its tip: z = H − p(x − s) at the travel s,
/// x along the travel.
struct Surface {
  Profile profile;
  double friction = 0;  ///< Coulomb's μ
  double tilt = 0;      ///< rad; adds x tan(tilt) to p

  /// Height and slope with the tilt. Throws InputError beyond the ends of a sampled profile.
  ProfilePoint at(double x) const;
  /// The same, beyond the ends of a sampled profile along its last slope, for a solver's trials.
  ProfilePoint extended(double x) const;
  /// Length of the smallest feature, m: a wavelength, an edge's radius, the distance of two points;
  /// infinite of a flat one.
  double finest_length() const;
};

/// Throws InputError if a parameter is not finite or out of its range, or if the edges of a
/// trapezoid have no room.
void require_valid(const Surface& surface);

/// The numbers of a surface as a person states them; those of its kind count.
struct StatedSurface {
  enum class Kind { flat, sine, trapezoid, random, file };
  Kind kind = Kind::flat;
  SineProfile sine{};
  TrapezoidProfile trapezoid{};
  RandomProfile::Parameters random{};
  std::filesystem::path file{};             ///< of a profile that is one
  std::optional<SampledProfile> sampled{};  ///< what is in it
  double friction = 0;                      ///< Coulomb's μ
  double tilt = 0;                          ///< rad
};
/// Throws InputError as require_valid().
std::shared_ptr<const Surface> surface_of(const StatedSurface& stated);

}  // namespace ciliaval::surroundings
