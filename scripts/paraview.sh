#!/usr/bin/env bash
# Unpacks Debian's ParaView into build/paraview, for its Python (pvpython) and without a screen. It cannot be installed beside
# the build: python3-paraview conflicts with libvtk9-dev. Prints the path of a pvpython that works; what is there is kept.
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/build.sh

program=build/paraview/pvpython

if [ ! -x $program ]; then
  command -v pvpython >/dev/null || command -v apt-get >/dev/null ||
    die "no pvpython, and this is not a Debian system: install ParaView 5.10 or later by hand"
  say "unpacking ParaView into build/paraview"
  mkdir -p build
  new=$(mktemp -d build/paraview.XXXXXX)
  trap 'rm -rf "$new"' EXIT
  if ! command -v pvpython >/dev/null; then
    # What an installation would bring; nothing is installed.
    packages=$(apt-get install -s --no-install-recommends paraview python3-paraview 2>/dev/null | awk '/^Inst/ { print $2 }')
    [ -n "$packages" ] || die "apt-get knows no paraview (run 'apt-get update')"
    mkdir "$new/packages" "$new/root"
    # shellcheck disable=SC2086
    (cd "$new/packages" && apt-get -qq download $packages 2>/dev/null) || die "apt-get could not download ParaView"
    for package in "$new"/packages/*.deb; do dpkg -x "$package" "$new/root"; done
    rm -r "$new/packages"
  fi
  cat > "$new/pvpython" <<'END'
#!/bin/sh
# pvpython on a screen of its own. -noreset: ParaView closes its connection and opens another, and an X server that resets
# itself at the close drops the second one.
root=$(cd "$(dirname "$0")" && pwd)/root
if [ -d "$root" ]; then
  export LD_LIBRARY_PATH="$root/usr/lib/$(uname -m)-linux-gnu${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
  export PYTHONPATH="$root/usr/lib/python3/dist-packages"
  PATH="$root/usr/bin:$PATH"
fi
exec xvfb-run --auto-servernum --server-args='-screen 0 1280x1024x24 -noreset' pvpython "$@"
END
  chmod +x "$new/pvpython"
  "$new/pvpython" -c 'import paraview.simple' >/dev/null || die "the unpacked ParaView does not start"
  chmod 755 "$new"
  rm -rf build/paraview
  mv "$new" build/paraview
  trap - EXIT
fi
printf '%s\n' "$PWD/$program"
