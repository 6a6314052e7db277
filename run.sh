#!/usr/bin/env bash
# Installs what is missing, builds CiliaVal and runs every case of the paper. Arguments: case files to run instead.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. scripts/build.sh

if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
  echo "usage: ./run.sh [CASE.toml …]   (default: every case in cases/paper/)"
  exit 0
fi
if [ $# -eq 0 ]; then
  for file in cases/paper/*.toml; do
    [[ $file == *.study.toml || $file == *.sense.toml ]] || set -- "$@" "$file" # studies and benches are no cases
  done
fi

install_packages
build release
say "running $*"
status=0
build/release/ciliaval run "$@" -o results || status=$?
[ $status -eq 4 ] || [ $status -eq 2 ] ||
  say "results: $PWD/results (one folder for each case: summary.json, errors.csv, centrelines, vtk/)"
exit $status
