#!/usr/bin/env bash
# Speed-up and memory of two ranks, docs/measurements.md: `ciliaval run` of the paper's fig3b, solid and `line` alone, on one rank with one
# thread and under mpirun on two; start of the program, coarser meshes and VTK included. 15 minutes on a quiet machine.
# Usage: tests/bench/ranks.sh [PROGRAM [ROW …]]   (default: build/release/ciliaval, all rows; a row is mesh:refinement:solver:loads)
# Loads: 2 mN with 1, else so many equal steps up to 4 mN.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-$source_dir/build/release/ciliaval}")
shift || true
rows=("$@")
[ $# -gt 0 ] || rows=(half:1:direct:4 half:2:direct:1 half:2:iterative:1 half:3:direct:1 half:3:iterative:1
  whole:1:direct:1 whole:1:iterative:1 whole:2:direct:1 whole:2:iterative:1 whole:3:direct:1 whole:3:iterative:1)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

# fig3b up to its models, with these loads.
write_case() {
  local mesh=$1 refinement=$2 solver=$3 loads=$4 force
  force=$(awk -v n="$loads" 'BEGIN { if (n == 1) { print "[\"2 mN\"]"; exit }
    for (i = 1; i <= n; ++i) printf "%s\"%.4g mN\"", i == 1 ? "[" : ", ", 4 * i / n; print "]" }')
  sed -e '/^\[models\]/,$d' -e "s/^name = \"fig3b\"/name = \"ranks\"/" -e "s/^force = .*/force = $force/" "$source_dir/cases/paper/fig3b.toml"
  printf '[models]\nmechanics = ["solid"]\nfields = ["line"]\n[models.solid]\nrefinement = %s\nsolver = "%s"\nsymmetry = %s\n' \
    "$refinement" "$solver" "$([ "$mesh" = half ] && echo true || echo false)"
}

# Wall seconds of a command, and the largest memory of one of its processes in GB; what it prints stands in `log`.
measured() {
  local start=$EPOCHREALTIME job peak=0 now
  "$@" >log 2>&1 &
  job=$!
  while kill -0 "$job" 2>/dev/null; do
    now=$(for p in "$job" $(pgrep -P "$job"); do cat "/proc/$p/status" 2>/dev/null || true; done | awk '/VmHWM/ && $2 > m { m = $2 } END { print m + 0 }')
    ((now <= peak)) || peak=$now
    sleep 0.1
  done
  wait "$job" || { cat log >&2; echo "error: $* failed" >&2; exit 1; }
  awk -v a="$start" -v b="$EPOCHREALTIME" -v m="$peak" 'BEGIN { printf "%.2f %.2f", b - a, m * 1024 / 1e9 }'
}

# The three numbers of each step's tip, in one column.
tips() { tr -d ' \n' < "$1/ranks/summary.json" | grep -o '"tip":\[[^]]*\]' | sed 's/.*\[//; s/\]//' | tr ',' '\n'; }

echo '| mesh | refinement | solver | loads | unknowns | one rank, s | two ranks, s | ratio | one rank, GB | two ranks, GB each | tips apart by, m |'
echo '|---|---|---|---|---|---|---|---|---|---|---|'
for row in "${rows[@]}"; do
  IFS=: read -r mesh refinement solver loads <<< "$row"
  write_case "$mesh" "$refinement" "$solver" "$loads" > case.toml
  rm -rf one two
  one=$(DEAL_II_NUM_THREADS=1 measured "$program" run case.toml -o one)
  two=$(measured mpirun -np 2 "$program" run case.toml -o two)
  read -r one one_memory <<< "$one"
  read -r two two_memory <<< "$two"
  unknowns=$(tr -d ' \n' < one/ranks/summary.json | grep -o '"unknowns":[0-9]*' | head -1 | cut -d: -f2)
  apart=$(paste <(tips one) <(tips two) | awk '{ d = $1 - $2; d = d < 0 ? -d : d; m = d > m ? d : m } END { printf "%.1e", m }')
  awk -v a="$one" -v b="$two" -v row="| $mesh | $refinement | $solver | $loads | $unknowns |" -v apart="$apart" -v memory="$one_memory | $two_memory" \
    'BEGIN { printf "%s %s | %s | %.2f | %s | %s |\n", row, a, b, a / b, memory, apart }'
done
