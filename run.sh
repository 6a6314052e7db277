#!/usr/bin/env bash
# Installs what is missing, builds CiliaVal, runs everything of the paper and makes a report of it. Arguments: case files to run instead.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. scripts/build.sh

if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
  cat <<'END'
usage: ./run.sh [CASE.toml …]

Without arguments: the cases, parameter studies and test benches of cases/paper/, the measured cases of
cases/validation/, the paper's claims, the
error budget and the convergence of fig3b, ParaView's pictures. Results in results/, all on one page in
results/report.html. With case files: these alone, and the page. The exit code is that of the
first step that failed; the others are run all the same.
END
  exit 0
fi

program=build/release/ciliaval
paper=cases/paper
work=$(mktemp -d)
background=
# An interrupt ends the steps in the background too; their group is their own (set -m below).
trap '[ -z "$background" ] || kill -- "-$background" 2>/dev/null || true; rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
touch "$work/failed"

# step WORDS…: runs `ciliaval WORDS…`. A failure costs no other step, but is noted in $work/failed: "CODE what".
step() {
  local code=0 start=$SECONDS
  say "ciliaval $*"
  "$program" "$@" || code=$?
  [ $code -eq 0 ] || echo "$code ciliaval $* (exit code $code)" >> "$work/failed"
  printf '(%d s)\n' $((SECONDS - start)) >&2
}

# The parameter studies and the test benches of the paper, and a ParaView for its pictures.
in_background() {
  local file
  for file in "$paper"/*.study.toml; do step study "$file" -o results; done
  for file in "$paper"/*.sense.toml; do step sense "$file" --json "results/$(basename "$file" .toml).json"; done
  scripts/paraview.sh >/dev/null || true # pictures() says what that means
}

# pictures: ParaView's, of what was run. Without ParaView the page has none.
pictures() {
  local pvpython script name
  pvpython=$(scripts/paraview.sh) || { say "no ParaView: no pictures"; return; }
  mkdir -p results/pictures
  for script in results/*/vtk/open.py; do
    [ -e "$script" ] || continue # nothing was run
    name=$(basename "${script%/vtk/open.py}")
    say "picture of $name"
    "$pvpython" "$script" "results/pictures/$name.png" >&2 || echo "4 the picture of $name" >> "$work/failed"
  done
}

install_packages
build release ciliaval ciliaval_python # the pages are made by Python
tell_openblas_the_processor release
mkdir -p results
if [ $# -gt 0 ]; then
  step run "$@" -o results
else
  for file in "$paper"/*.toml cases/validation/*.toml; do
    case $file in
      *.study.toml | *.sense.toml) ;; # studies and benches are no cases
      *) set -- "$@" "$file" ;;
    esac
  done
  # Side by side, as no step keeps two cores busy all the time; what those in the background say is shown when they have ended.
  say "the studies and benches run in the background, beside:"
  set -m
  in_background > "$work/log" 2>&1 < /dev/null &
  background=$!
  set +m
  step run "$@" -o results
  step claims --json results/claims.json
  step budget "$paper/fig3b.toml" --json results/fig3b.budget.json
  step converge "$paper/fig3b.toml" --json results/fig3b.converge.json
  wait "$background" || echo "$? the steps in the background" >> "$work/failed"
  background=
  cat "$work/log"
fi
pictures
step report results

status=0
if [ -s "$work/failed" ]; then
  read -r status _ < "$work/failed"
  say "failed:"
  cut -d' ' -f2- "$work/failed" >&2
fi
say "results: $PWD/results (one folder for each case and study)"
[ ! -e results/report.html ] || say "report: $PWD/results/report.html"
exit "$status"
