#!/usr/bin/env bash
# cpack's Debian package depends on a package for each library that the program loads, and runs where it is unpacked: package_test.sh BUILD
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
for tool in cpack dpkg-deb dpkg-shlibdeps objdump; do
  command -v "$tool" >/dev/null || { echo "no $tool: skipped"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cpack --config "$1/CPackConfig.cmake" -B "$work" > log 2>&1 || { cat log; exit 1; }
dpkg-deb -x ./*.deb root
depends=" $(dpkg-deb -f ./*.deb Depends | tr ',|' '  ') "
program=$work/root/usr/bin/ciliaval
# Some have several packages (BLAS and LAPACK): the one that is named, or what it provides.
for library in $(objdump -p "$program" | awk '/NEEDED/ { print $2 }'); do
  found=
  for package in $(dpkg -S "*/$library" | sed 's/:.*//; s/,//g' | sort -u); do
    for name in $(dpkg-query -W -f '${Package} ${Provides}\n' "$package" | tr ',' ' '); do
      [[ $depends == *" $name "* ]] && found=$name
    done
  done
  [ -n "$found" ] || { echo "the package does not depend on that of $library:$depends"; exit 1; }
done
"$program" --version
"$program" new touch
"$program" validate touch.toml
module=$(find root -name ciliaval -path '*-packages/*' -type d)
[ -z "$module" ] || PYTHONPATH=$(dirname "$module") /usr/bin/python3 -c '
import ciliaval as cv
shape = cv.bend(cv.Cilium(3e-3, [cv.Segment(0.02, 1e6)]), cv.Load("contact", force=1e-4, height=0.016))
assert 0 < shape.tip[0] < 1e-3, shape.tip'
