# Sourced by run.sh and test.sh: installs what is missing, configures and builds one preset.
# SPDX-License-Identifier: LGPL-2.1-or-later

configure_options=()
say() { printf '\n== %s\n' "$*" >&2; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Installs the packages of scripts/packages.txt that are not there yet.
install_packages() {
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    die "this is not a Debian system; install the equivalents of scripts/packages.txt by hand, then run 'cmake --preset release && cmake --build --preset release'"
  local missing=() package
  while read -r package; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done < <(grep -v '^#' scripts/packages.txt)
  [ ${#missing[@]} -eq 0 ] && return
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo)
    command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; } ||
      die "these packages are missing, and neither root nor sudo is at hand to install them; ask an administrator for:
  apt-get install ${missing[*]}"
  fi
  say "installing ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 -qq)
  "${apt[@]}" update >&2 || die "'apt-get update' failed: are the package sources reachable?"
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2 ||
    die "apt-get could not install ${missing[*]}"
}

# build PRESET [TARGET…]: configures it, with $configure_options, and builds all of it or the targets; what has not changed is not built again.
build() {
  say "building build/$1"
  local log
  log=$(cmake --preset "$1" "${configure_options[@]}" 2>&1) || { printf '%s\n' "$log" >&2; die "configuring the preset '$1' failed"; }
  cmake --build --preset "$1" ${2:+--target "${@:2}"} >&2 || die "the build failed"
}

# OpenBLAS 0.3.21 takes a processor that is newer than itself for one of 2004, and the solid takes longer (docs/measurements.md).
# tell_openblas_the_processor PRESET, once it is built: Haswell's kernels run on every processor with AVX2.
tell_openblas_the_processor() {
  [ -z "${OPENBLAS_CORETYPE:-}" ] && grep -qsw avx2 /proc/cpuinfo || return 0
  ! OPENBLAS_VERBOSE=2 "build/$1/ciliaval" --version 2>&1 >/dev/null | grep -q "Core: Prescott" || export OPENBLAS_CORETYPE=Haswell
}
