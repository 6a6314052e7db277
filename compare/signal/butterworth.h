// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>
#include <vector>

namespace ciliaval::compare::signal {

inline constexpr unsigned int highest_order = 20;

/// H(z) = (b0 + b1 z⁻¹ + b2 z⁻²)/(1 + a1 z⁻¹ + a2 z⁻²).
struct SecondOrderSection {
  double b0 = 0;
  double b1 = 0;
  double b2 = 0;
  double a1 = 0;
  double a2 = 0;
};

/// The digital Butterworth high-pass filter of order n as a cascade of second-order sections. The
/// bilinear transform s = (z − 1)/(z + 1), with the cut-off prewarped to c = tan(π f_c/f_s),
/// carries the analogue filter over (Oppenheim & Schafer, Discrete-Time Signal Processing, 3rd ed.,
/// 2010, section 7.2.2). With θ_m = π m/(2n), m = 1, 3, … n − 1 or m = 0, 2, … n − 1, a pair of
/// poles gives
///
///   D = 1 + 2 c cos θ_m + c²,  a1 = −2 (1 − c²)/D,  a2 = (1 − 2 c cos θ_m + c²)/D,
///
/// the single pole of m = 0 a1 = −(1 − c)/(1 + c). The magnitude is
///
///   |H(f)| = 1/√(1 + (tan(π f_c/f_s)/tan(π f/f_s))^(2n)).
///
/// Order, pairing and gain of the sections are those of SciPy's butter(n, f_c, 'highpass', fs =
/// f_s, output = 'sos').
///
/// Throws InputError unless 1 ≤ n ≤ highest_order and 1e-6 f_s ≤ f_c < f_s/2; f_c and f_s in Hz.
std::vector<SecondOrderSection> butterworth_highpass(unsigned int order, double cutoff,
                                                     double sampling_rate);

/// The series after the cascade, in the transposed direct form II (op. cit., section 6.4):
///
///   y_k = b0 x_k + u_k,  u_{k+1} = b1 x_k − a1 y_k + v_k,  v_{k+1} = b2 x_k − a2 y_k.
///
/// The filter starts as if its input had always been `before`:
///
/// - The first sample is right for a record with an offset, such as the field of the magnet at
///   rest: a high-pass filter then starts at 0. It is SciPy's sosfilt with sosfilt_zi times x₀.
/// - 0 is a filter at rest, SciPy's sosfilt without a state, and MATLAB's filter: the offset is
///   then a step at the first sample, and its transient lasts some 1/f_c.
///
/// Throws InputError if a value is not finite.
std::vector<double> filter(std::span<const SecondOrderSection> sections,
                           std::span<const double> series, double before);

/// The series filtered forwards, then backwards: |H|² and no shift of phase. Before that each end
/// is continued by its odd reflection, 2 x₀ − x_k, and each pass starts as if its first input had
/// always been there. That is SciPy's sosfiltfilt, with its default length of the reflection,
///
///   3 (2 N + 1 − min(sections with b2 = 0, sections with a2 = 0)) for N sections,
///
/// 3 (n + 1) samples for the high-pass filter of order n. It is far shorter than 1/f_c at a low
/// cut-off: the ends then depend on the continuation.
///
/// Throws InputError if the series is not longer than the reflection, or a value is not finite.
std::vector<double> filter_both_ways(std::span<const SecondOrderSection> sections,
                                     std::span<const double> series);

}  // namespace ciliaval::compare::signal
