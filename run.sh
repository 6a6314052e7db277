#!/usr/bin/env bash
# Installs what is missing, builds CiliaVal, runs everything of the paper and makes a report of it. Arguments: case files to run instead.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. scripts/build.sh

if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
  cat <<'END'
usage: ./run.sh [CASE.toml …]

Without arguments: the cases, parameter studies and test benches of cases/paper/, the paper's claims, the
error budget and the convergence of fig3b, ParaView's pictures. Results in results/, all on one page in
results/report.html. With case files: these alone, and the page. The exit code is that of the first step that failed; the others
are run all the same.
END
  exit 0
fi

program=build/release/ciliaval
status=0
failed=()

# step WORDS…: runs `ciliaval WORDS…`; a failure costs no other step, but the exit code.
step() {
  local code=0 start=$SECONDS
  say "ciliaval $*"
  "$program" "$@" || code=$?
  [ $code -eq 0 ] || failed+=("ciliaval $* (exit code $code)")
  [ $status -ne 0 ] || status=$code
  printf '(%d s)\n' $((SECONDS - start)) >&2
}

install_packages
build release ciliaval
mkdir -p results
if [ $# -gt 0 ]; then
  step run "$@" -o results
else
  paper=cases/paper
  for file in "$paper"/*.toml; do
    case $file in
      *.study.toml | *.sense.toml) ;; # studies and benches are no cases
      *) set -- "$@" "$file" ;;
    esac
  done
  step run "$@" -o results
  for file in "$paper"/*.study.toml; do step study "$file" -o results; done
  for file in "$paper"/*.sense.toml; do step sense "$file" --json "results/$(basename "$file" .toml).json"; done
  step claims --json results/claims.json
  step budget "$paper/fig3b.toml" --json results/fig3b.budget.json
  step converge "$paper/fig3b.toml" --json results/fig3b.converge.json
fi
# ParaView's pictures of what was run. Without ParaView the page has none.
if pvpython=$(scripts/paraview.sh); then
  mkdir -p results/pictures
  for script in results/*/vtk/open.py; do
    [ -e "$script" ] || continue # nothing was run
    name=$(basename "${script%/vtk/open.py}")
    say "picture of $name"
    "$pvpython" "$script" "results/pictures/$name.png" >&2 ||
      { failed+=("the picture of $name"); [ $status -ne 0 ] || status=4; }
  done
else
  say "no ParaView: no pictures"
fi
step report results

[ ${#failed[@]} -eq 0 ] || { say "failed:"; printf '%s\n' "${failed[@]}" >&2; }
say "results: $PWD/results (one folder for each case and study)"
[ ! -e results/report.html ] || say "report: $PWD/results/report.html"
exit $status
