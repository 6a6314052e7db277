#!/usr/bin/env bash
# Checks the format of our own code and runs clang-tidy on it (a minute for each file that includes deal.II).
# Usage: scripts/lint.sh [FILE.cc …]   (default: every .cc file of the tree). Needs clang-format and clang-tidy.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# clang cannot read GCC's precompiled headers; without them, and alone, each file must include what it uses.
cmake --preset release -B build/lint -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON -D CMAKE_UNITY_BUILD=OFF >/dev/null
cmake --build build/lint --target ciliaval_version >/dev/null
if [ $# -eq 0 ]; then
  mapfile -t sources < <(git ls-files '*.cc' ':!tests/consumer')
else
  sources=("$@")
fi
git ls-files '*.h' '*.cc' | xargs clang-format --dry-run --Werror
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/lint --quiet
