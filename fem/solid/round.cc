// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/round.h"

#include <exception>
#include <string>
#include <utility>

#include "fem/parallel.h"
#include "fem/solid/archive.h"
#include "problem/error.h"

namespace ciliaval::fem {
namespace {

/// What became of a step on its rank, as the other ranks are told.
enum class Ending { solved, checkpoint_error, input_error, other_error };

struct Attempt {
  Ending ending = Ending::other_error;
  std::string message;  ///< of an error
  SolvedStep solved;

  bool converged() const {
    return ending == Ending::solved && solved.step.status == Status::converged;
  }
};

Attempt attempt(std::size_t number, const std::function<SolvedStep(std::size_t)>& solve) {
  const RankAlone alone;
  try {
    return {Ending::solved, {}, solve(number)};
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

std::vector<SolvedStep> solve_round(std::size_t count,
                                    const std::function<SolvedStep(std::size_t)>& solve) {
  const auto own = static_cast<std::size_t>(rank());
  Attempt mine;
  if (own < count) mine = attempt(own, solve);
  std::vector<SolvedStep> result;
  for (std::size_t number = 0; number < count; ++number) {
    const std::string bytes =
        from_rank(static_cast<int>(number), number == own ? packed(mine) : std::string());
    Attempt theirs;
    if (number != own) theirs = unpacked(bytes);
    Attempt& one = number == own ? mine : theirs;
    if (number == 0 && one.ending == Ending::checkpoint_error) throw CheckpointError(one.message);
    if (number == 0 && one.ending == Ending::input_error) throw InputError(one.message);
    if (number == 0 && one.ending == Ending::other_error) throw SolverError(one.message);
    if (count > 1 && !one.converged()) break;
    result.push_back(std::move(one.solved));
  }
  return result;
}

}  // namespace ciliaval::fem
