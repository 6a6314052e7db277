// SPDX-License-Identifier: LGPL-2.1-or-later
#include "meshes/gmsh/gmsh_process.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <gmsh.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>

#include "problem/error.h"

namespace ciliaval::meshes::gmsh {
namespace {

constexpr unsigned int time_limit = 600;         // s
constexpr rlim_t memory_limit = 4'000'000'000U;  // bytes beyond what this program has

/// The first letter of an answer.
enum Answer : char { result = 'r', input_error = 'i', file_error = 'f', gmsh_error = 'g' };

/// A damaged count would make Gmsh fill the memory. The address sanitizer maps more than any limit.
void limit_memory() {
#ifndef __SANITIZE_ADDRESS__
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit memory{static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) * pages + memory_limit,
                      RLIM_INFINITY};
  setrlimit(RLIMIT_AS, &memory);
#endif
}

std::string answer(const std::function<std::string()>& work) {
  const auto tagged = [](Answer kind, const std::string& text) {
    return fmt::format("{}{}", static_cast<char>(kind), text);
  };
  try {
    ::gmsh::initialize(0, nullptr, false);
    ::gmsh::option::setNumber("General.Terminal", 0);
    return tagged(result, work());
  } catch (const InputError& error) {
    return tagged(input_error, error.what());
  } catch (const FileError& error) {
    return tagged(file_error, error.what());
  } catch (const std::string& text) {  // Gmsh's own
    return tagged(gmsh_error, text);
  } catch (const std::exception& error) {  // bad_alloc, length_error
    return tagged(gmsh_error, fmt::format("{}: the file is damaged, or the mesh takes over {:g} GB",
                                          error.what(), 1e-9 * double(memory_limit)));
  }
}

/// The child's life: silent, without a home folder, without the parent's handlers of crashes.
[[noreturn]] void serve(const std::function<std::string()>& work, int pipe) {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, stream);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) std::signal(number, SIG_DFL);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  limit_memory();
  setenv("HOME", "/dev/null", 1);
  alarm(time_limit);
  const std::string text = answer(work);
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = write(pipe, text.data() + sent, text.size() - sent);
    if (n < 0 && errno != EINTR) break;
    sent += n < 0 ? 0 : static_cast<std::size_t>(n);
  }
  _exit(0);
}

std::string read_to_end(int pipe) {
  std::string text;
  std::array<char, 65536> part{};
  for (;;) {
    const ssize_t n = read(pipe, part.data(), part.size());
    if (n == 0 || (n < 0 && errno != EINTR)) return text;
    if (n > 0) text.append(part.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

std::string in_gmsh_process(const std::filesystem::path& file, const std::string& what,
                            const std::function<std::string()>& work) {
  const auto fail = [&](const std::string& why) {
    return FileError(fmt::format("{}: Gmsh cannot {}: {}", file.string(), what, why));
  };
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw fail(std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) serve(work, ends[1]);
  const int error = errno;
  close(ends[1]);
  const std::string text = child < 0 ? "" : read_to_end(ends[0]);
  close(ends[0]);
  if (child < 0) throw fail(std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
    throw fail(fmt::format("it did not end within {} s", time_limit));
  if (WIFSIGNALED(status))
    throw fail(fmt::format("it crashed ({}): the file is damaged; write or copy it again",
                           strsignal(WTERMSIG(status))));
  if (text.empty()) throw fail("its process ended without an answer");
  std::string rest = text.substr(1);
  if (text[0] == input_error) throw InputError(rest);
  if (text[0] == file_error) throw FileError(rest);
  if (text[0] == gmsh_error) throw fail(rest);
  return rest;
}

}  // namespace ciliaval::meshes::gmsh
