#!/usr/bin/env bash
# Messages of one linear solution of the solid in parts, from the mesh to the solution, table of docs/evidence/solid.md: of the rank that sends most to
# others the point-to-point messages and their bytes, and the collective operations in which it exchanges with all others, counted by Open MPI (its
# component `monitoring`). Takes two minutes.
# Usage: tests/bench/messages.sh [PROGRAM [MESH:RANKS …]]   (default: build/release/tests/bench/bench_solve, meshes 2 and 4 on 2, 4 and 8 ranks)
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-$source_dir/build/release/tests/bench/bench_solve}")
shift || true
rows=("$@")
[ $# -gt 0 ] || rows=(2:2 2:4 2:8 4:2 4:4 4:8)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none \
  OMPI_MCA_mpi_yield_when_idle=1

echo '| unknowns | ranks | iterations | messages | MB | bytes a message | collective operations |'
echo '|---|---|---|---|---|---|---|'
for row in "${rows[@]}"; do
  IFS=: read -r mesh ranks <<< "$row"
  said=$(mpirun -n "$ranks" --mca pml ^cm --mca pml_monitoring_enable 2 --mca pml_monitoring_enable_output 3 --mca pml_monitoring_filename "$folder/sent" \
    "$program" --benchmark_color=false --benchmark_filter="iterative/mesh:$mesh/" | tail -1)
  unknowns=$(sed 's/.*unknowns=\([^ ]*\).*/\1/' <<< "$said")
  iterations=$(sed 's/.*iterations=\([0-9]*\).*/\1/' <<< "$said")
  for file in "$folder"/sent.*.prof; do
    awk -F'\t' '$1 == "E" { bytes += $4; messages += $5 } $1 == "A2A" { all += $4 } END { printf "%d %d %d\n", bytes, messages, all }' "$file"
  done | sort -n | tail -1 | awk -v row="| $unknowns | $ranks | $iterations |" '{ printf "%s %d | %.1f | %d | %d |\n", row, $2, $1 / 1e6, $1 / $2, $3 }'
  rm -f "$folder"/sent.*
done
