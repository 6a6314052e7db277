// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <pybind11/pybind11.h>

#include "problem/support/interruption.h"

namespace ciliaval::python::core {

/// A Python exception on its way through a solution. Not a std::exception: no model's failure,
/// which a run would record and go on from.
struct RaisedInPython {
  pybind11::error_already_set error;
};

/// A call from Python that may take long: Ctrl-C ends it (problem/support/interruption.h), and
/// Python does not end under it. Construct it before the GIL is released; the GIL must be held
/// again when it is destroyed. Throws PythonEnds if Python is about to end and this is another
/// thread than the one that ends it.
class Call {
 public:
  Call();
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  support::InterruptionWatch watch_;
};

/// Python ends: the thread is to end, in silence. Not a std::exception, see above.
struct PythonEnds {};

/// Makes calls that still run in other threads stop before Python ends, which would end MPI and the
/// threads' interpreter under them. Also says how Python sees the exceptions above.
void bind_calls(pybind11::module_& module);

}  // namespace ciliaval::python::core
