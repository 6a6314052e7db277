// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/support/interruption.h"

#include <atomic>
#include <csignal>
#include <mutex>

namespace ciliaval::support {
namespace {

std::atomic<bool> interruption_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may use it");
std::mutex watches_guard;
int watches = 0;
struct sigaction before_watches {};

void note_interruption(int number, siginfo_t* information, void* context) {
  interruption_asked = true;
  if ((before_watches.sa_flags & SA_SIGINFO) != 0)
    before_watches.sa_sigaction(number, information, context);
  else if (before_watches.sa_handler != SIG_DFL && before_watches.sa_handler != SIG_IGN)
    before_watches.sa_handler(number);
}

}  // namespace

void check_interruption() {
  if (interruption_asked.load(std::memory_order_relaxed)) throw Interrupted();
}

void ask_interruption() {
  const std::lock_guard lock(watches_guard);
  if (watches > 0) interruption_asked = true;
}

InterruptionWatch::InterruptionWatch() {
  const std::lock_guard lock(watches_guard);
  if (watches++ > 0) return;
  interruption_asked = false;
  sigaction(SIGINT, nullptr, &before_watches);
  if ((before_watches.sa_flags & SA_SIGINFO) == 0 && before_watches.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_sigaction = note_interruption;
  action.sa_flags = SA_SIGINFO | (before_watches.sa_flags & (SA_RESTART | SA_ONSTACK));
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
}

InterruptionWatch::~InterruptionWatch() {
  const std::lock_guard lock(watches_guard);
  if (--watches > 0) return;
  sigaction(SIGINT, &before_watches, nullptr);
  interruption_asked = false;
}

}  // namespace ciliaval::support
