#!/usr/bin/env bash
# The completion of bash names the program's commands, a command's options, case files, and nothing else: completion_test.sh SOURCE PROGRAM
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
source "$1/cmake/completion/ciliaval.bash"
expect() { # expect "COMPLETIONS" WORD…
  COMP_WORDS=("${@:2}")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  COMPREPLY=()
  _ciliaval || true
  [ "${COMPREPLY[*]}" = "$1" ] || { echo "'${*:2}' completes to '${COMPREPLY[*]}', not to '$1'"; exit 1; }
}
cd "$1/cases/paper"
expect validate "$2" va
expect "" "$2" nocommand
expect --fresh "$2" run --fr
expect --load "$2" new --lo
expect schema "$2" sch
expect --quiet "$2" run --qu
expect fig3d.toml "$2" run fig3d
