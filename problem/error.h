// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <stdexcept>

namespace ciliaval {

/// An error says what was asked, what happened and what to do. The program turns its kind into an
/// exit code at one place (compare/main.cc).
class Error : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The input cannot be used: exit code 2.
class InputError : public Error {
  using Error::Error;
};

/// A solver did not converge or met a state it cannot go on from: exit code 3.
class SolverError : public Error {
  using Error::Error;
};

/// A file could not be read or written: exit code 4.
class FileError : public Error {
  using Error::Error;
};

}  // namespace ciliaval
