// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace ciliaval::support {

/// The user asks for the end (Ctrl-C). Not a std::exception: no model's failure, which a run would
/// record and go on from.
struct Interrupted {};

/// Throws Interrupted if SIGINT has come while an InterruptionWatch lives. It reads one atomic
/// flag: for the inside of every loop that may take longer than some tenths of a second.
void check_interruption();

/// Does what SIGINT does while an InterruptionWatch lives: check_interruption() throws in every
/// thread.
void ask_interruption();

/// While one lives, SIGINT makes check_interruption() throw in every thread, after the handler that
/// was there before was called. Several may live at once, in several threads. Without one, SIGINT
/// does what it did before: it ends the program at once. An ignored SIGINT stays so.
class InterruptionWatch {
 public:
  InterruptionWatch();
  ~InterruptionWatch();
  InterruptionWatch(const InterruptionWatch&) = delete;
  InterruptionWatch& operator=(const InterruptionWatch&) = delete;
};

}  // namespace ciliaval::support
