#!/usr/bin/env bash
# Checks the format of our own code and runs clang-tidy on it (a minute for each file that includes deal.II).
# Usage: scripts/lint.sh [FILE.cc …]   (default: every .cc file of the tree). Needs clang-format, clang-tidy and a configured build/release.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ -f build/release/compile_commands.json ] || { echo "error: configure first: cmake --preset release" >&2; exit 1; }
if [ $# -eq 0 ]; then
  mapfile -t sources < <(git ls-files '*.cc' ':!tests/consumer')
else
  sources=("$@")
fi
git ls-files '*.h' '*.cc' | xargs clang-format --dry-run --Werror
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/release --quiet
