#!/usr/bin/env bash
# Installs what is missing, builds CiliaVal and runs its tests.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. scripts/build.sh

preset=release
labels=(-LE slow)
all=OFF
while [ $# -gt 0 ]; do
  case $1 in
    --all)
      labels=()
      all=ON
      ;;
    --preset) shift; preset=${1:?--preset needs a name: release, debug or sanitize} ;;
    *)
      echo "usage: ./test.sh [--all] [--preset release|debug|sanitize]   (--all: the long tests, label 'slow', the benchmarks and the check of types across files, too)"
      [ "$1" = --help ] || [ "$1" = -h ] || exit 2
      exit 0
      ;;
  esac
  shift
done

install_packages
scripts/check_includes.sh
python3 scripts/check_names.py
configure_options=(-D CILIAVAL_BENCHMARKS=$all)
[ "$preset" != release ] || configure_options+=(-D CILIAVAL_ODR=$all)
build "$preset"
scripts/paraview.sh >/dev/null || say "no ParaView: its tests are skipped"
say "testing"
tell_openblas_the_processor "$preset"
# One thread a test: ctest runs two of them side by side.
export DEAL_II_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
ctest --preset "$preset" -j "$(nproc)" "${labels[@]}"
