// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/solo_step.h"

#include <exception>
#include <string>
#include <utility>

#include "fem/parallel.h"
#include "fem/solid/archive.h"
#include "problem/error.h"

namespace ciliaval::fem {
namespace {

/// What became of the step on rank 0, as the others are told.
enum class Ending { solved, checkpoint_error, input_error, other_error };

struct Attempt {
  Ending ending = Ending::other_error;
  std::string message;  ///< of an error
  SolvedStep solved;
};

Attempt attempt(const std::function<SolvedStep()>& solve) {
  const RankAlone alone;
  try {
    return {Ending::solved, {}, solve()};
  } catch (const CheckpointError& error) {
    return {Ending::checkpoint_error, error.what(), {}};
  } catch (const InputError& error) {
    return {Ending::input_error, error.what(), {}};
  } catch (const std::exception& error) {
    return {Ending::other_error, error.what(), {}};
  }
}

std::string packed(const Attempt& attempt) {
  const int ending = static_cast<int>(attempt.ending);
  return serialized(ending, attempt.message, attempt.solved.step, attempt.solved.levels);
}

Attempt unpacked(const std::string& bytes) {
  Attempt result;
  int ending = 0;
  deserialize(bytes, ending, result.message, result.solved.step, result.solved.levels);
  result.ending = static_cast<Ending>(ending);
  return result;
}

}  // namespace

SolvedStep solve_on_first_rank(const std::function<SolvedStep()>& solve) {
  const bool first = rank() == 0;
  Attempt result;
  if (first) result = attempt(solve);
  const std::string bytes = from_rank(0, first ? packed(result) : std::string());
  if (!first) result = unpacked(bytes);
  if (result.ending == Ending::checkpoint_error) throw CheckpointError(result.message);
  if (result.ending == Ending::input_error) throw InputError(result.message);
  if (result.ending == Ending::other_error) throw SolverError(result.message);
  return std::move(result.solved);
}

}  // namespace ciliaval::fem
