// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <stdexcept>

namespace ciliaval {

/// An error says what was asked, what happened and what to do. The program turns its kind into an
/// exit code at one place (compare/app/main.cc).
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

/// A checkpoint cannot be used or written. It ends the run, instead of being one model's failure:
/// what was saved stays as it is.
class CheckpointError : public FileError {
  using FileError::FileError;
};

/// One rank of several has failed alone, and the others wait for it: nothing but the end of the
/// program can follow. Exit code 3.
class RankFailure : public Error {
  using Error::Error;
};

}  // namespace ciliaval
