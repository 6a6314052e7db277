// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "problem/types.h"

namespace ciliaval::compare::signal {

/// A logger that records a sensor, and the filter that its record goes through.
struct SignalOptions {
  enum class Phase { causal, zero };

  double sampling_rate = 0;     ///< f_s, Hz
  double noise = 0;             ///< standard deviation of each component's noise, T; 0: none
  std::uint32_t seed = 1;       ///< of the noise
  unsigned int order = 4;       ///< of the Butterworth high-pass filter; 4: the paper's
  double cutoff = 0;            ///< of the filter, Hz; 0: no filter
  Phase phase = Phase::causal;  ///< as a filter in the logger, or of the whole record afterwards
};

/// A sensor's record at equal intervals: one entry for each sample.
struct Signal {
  std::vector<double> time;       ///< s
  std::vector<Vector3> raw;       ///< T, with the noise
  std::vector<Vector3> filtered;  ///< T; raw if there is no filter
};

/// The record of a sensor that sees the field B (T) at increasing times (s), evenly spaced or not:
///
/// 1. Samples at t_k = t₀ + k/f_s, up to the last time. B between two times lies on the straight
///    line: a sweep's field jumps, and a polynomial of higher degree overshoots at a jump. As in a
///    logger without an anti-aliasing filter, what happens between two samples is not seen.
/// 2. Gaussian noise, independent from sample to sample and from component to component. Each
///    sensor has its own: its index in the case goes into the seed. The noise does not depend on
///    the field, so that a longer record begins with the same noise.
/// 3. The high-pass filter, causal from the first sample's steady state (filter()) or with no shift
///    of phase (filter_both_ways()).
///
/// Throws InputError if the times do not increase, a number is not finite or out of its range, or
/// the record has fewer samples than two, or than the filter needs, or more than 10 million.
Signal record(std::span<const double> times, std::span<const Vector3> B,
              const SignalOptions& options, std::uint32_t sensor = 0);

}  // namespace ciliaval::compare::signal
