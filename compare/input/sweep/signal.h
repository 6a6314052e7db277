// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "problem/description/field.h"

namespace ciliaval::compare::input {
class Section;
}

namespace ciliaval::compare::input::sweep {

/// A logger that records a sensor, and the filter that its record goes through: the package
/// `ciliaval.sensing` makes signal.csv of it.
struct SignalOptions {
  enum class Phase { causal, zero };

  double sampling_rate = 0;     ///< f_s, Hz
  double noise = 0;             ///< standard deviation of each component's noise, T; 0: none
  std::uint32_t seed = 1;       ///< of the noise
  unsigned int order = 4;       ///< of the Butterworth high-pass filter; 4: the paper's
  double cutoff = 0;            ///< of the filter, Hz; 0: no filter
  Phase phase = Phase::causal;  ///< as a filter in the logger, or of the whole record afterwards

  /// Samples that the record has more of: the filter needs them, or a record is no record.
  std::size_t least_samples() const {
    return cutoff > 0 && phase == Phase::zero ? 3 * (order + 1) : 1;
  }
};

/// Reads the table [signal]; none if there is none.
std::optional<SignalOptions> read_signal(Section& root);

/// The table as TOML.
std::string to_toml(const SignalOptions& options);

}  // namespace ciliaval::compare::input::sweep

namespace ciliaval::description {
template <>
const Fields<compare::input::sweep::SignalOptions>& fields<compare::input::sweep::SignalOptions>();
}
