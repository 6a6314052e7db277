// SPDX-License-Identifier: LGPL-2.1-or-later
// Preloaded into one rank of several: from the n-th allocation of more than 100 kB on,
// CILIAVAL_FAIL_AT in the environment, operator new finds no memory.
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

long first_failure() {
  const char* text = std::getenv("CILIAVAL_FAIL_AT");
  return text != nullptr ? std::atol(text) : 0;
}

bool fails(std::size_t size) {
  static std::atomic<long> left = first_failure();
  return size > 100'000 && --left <= 0;
}

}  // namespace

void* operator new(std::size_t size) {
  void* memory = fails(size) ? nullptr : std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
