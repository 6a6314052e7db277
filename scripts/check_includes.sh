#!/usr/bin/env bash
# Fails, with file and line, where an include goes against the arrows of docs/developer/architecture.md, a folder holds more than 20
# sources and headers, a file has more than 600 lines, or a folder's files declare another namespace than the folder's.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# Folder: what it may include beside itself. The longest folder that fits a file counts; tests may include everything.
shared="problem compare/input compare/models compare/results compare/output"
export rules="
problem:
analytic: problem
meshes: problem
fem: problem
fem/beam: problem fem/lanczos.h
fem/potential: problem fem/parallel.h
fem/solid: problem meshes fem
fem/calculix: problem meshes fem
compare/input: problem compare/results/quantity.h
compare/models: problem analytic fem meshes compare/input compare/results/quantity.h
compare/results: problem compare/input compare/models
compare/output: problem compare/results meshes analytic/rod/field_models.h analytic/sources/push_forward.h compare/input compare/models ciliaval_version.h
compare/regression: $shared
compare/convergence: $shared compare/regression
compare/budget: $shared
compare/study: $shared compare/budget
compare/validation: $shared compare/study
compare/app: .
tools: problem fem
python/core: problem compare/input compare/models compare/output compare/study compare/validation fem/solid/archive.h
tests: ."
git ls-files '*.h' '*.cc' | xargs awk '
  function complain(text) { print FILENAME ":" FNR ": " text; failed = 1 }
  BEGIN {
    n = split(ENVIRON["rules"], lines, "\n")
    for (i = 1; i <= n; ++i) if (split(lines[i], part, ":") > 1) allowed[part[1]] = part[1] " " part[2]
  }
  FNR == 1 {
    folder = FILENAME; sub("/[^/]*$", "", folder)
    if (++files[folder] == 21) complain(folder " holds more than 20 sources and headers")
    for (key = folder; key != "" && !(key in allowed);) if (!sub("/[^/]*$", "", key)) key = ""
    n = split(allowed[key], may)
    space = "ciliaval::" folder; gsub("/", "::", space); sub("ciliaval::problem", "ciliaval", space)
  }
  FNR == 601 { complain("more than 600 lines") }
  /^#include "/ && key != "tests" {
    split($0, quoted, "\"")
    for (i = 1; i <= n && may[i] != "." && index(quoted[2] "/", may[i] "/") != 1;) ++i
    if (i > n) complain(key " must not include " quoted[2])
  }
  other != "" && !/^(struct|class) [A-Za-z]+;$/ { complain("namespace " other " in place of " space) }  # forward declarations may
  { other = "" }
  # The description of a struct stands beside what reads it.
  /^namespace ciliaval/ && key != "tests" && $2 != "ciliaval::description" && index($2 "::", space "::") != 1 { other = $2 }
  END { exit failed }'
