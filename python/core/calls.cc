// SPDX-License-Identifier: LGPL-2.1-or-later
#include "python/core/calls.h"

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace ciliaval::python::core {
namespace py = pybind11;
namespace {

std::mutex guard;
std::condition_variable call_ended;
int running = 0;
bool python_ends = false;
std::thread::id ending_thread;

bool is_ended_here() {
  const std::lock_guard lock(guard);
  return python_ends && std::this_thread::get_id() != ending_thread;
}

/// Stops the calls in other threads, which only daemon threads have at this time, and waits for
/// them. They ask for the GIL on their way back.
void end_calls() {
  using namespace std::chrono_literals;
  const py::gil_scoped_release released;
  std::unique_lock lock(guard);
  python_ends = true;
  ending_thread = std::this_thread::get_id();
  while (running > 0) {
    support::ask_interruption();
    call_ended.wait_for(lock, 50ms);
  }
}

/// A forked process has the forking thread alone.
void begin_anew_in_forked_processes() {
  pthread_atfork([] { guard.lock(); }, [] { guard.unlock(); },
                 [] {
                   running = 0;
                   python_ends = false;
                   guard.unlock();
                 });
}

}  // namespace

Call::Call() {
  // One that came while Python's numbers were read, which a long array takes a second of.
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  const std::lock_guard lock(guard);
  if (python_ends && std::this_thread::get_id() != ending_thread) throw PythonEnds();
  ++running;
}

Call::~Call() {
  const std::lock_guard lock(guard);
  if (running > 0) --running;
  call_ended.notify_all();
}

void bind_calls(py::module_& /*module*/) {
  py::register_exception_translator([](std::exception_ptr pointer) {  // NOLINT: pybind11's type
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (RaisedInPython& raised) {
      raised.error.restore();
    } catch (const PythonEnds&) {
      PyErr_SetNone(PyExc_SystemExit);  // threading says nothing about it
    } catch (const support::Interrupted&) {
      if (is_ended_here())
        PyErr_SetNone(PyExc_SystemExit);
      else if (PyErr_CheckSignals() == 0)  // in the main thread it raises KeyboardInterrupt
        PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
  });
  begin_anew_in_forked_processes();
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_calls));
}

}  // namespace ciliaval::python::core
