#!/bin/bash
# Installs missing packages, configures the preset `release` (or MOTE_PRESET: `ci`, with warnings as errors) and builds the
# targets given (none: everything). The binaries are in build/release/bin.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/install_packages.sh

options=()
if [[ -r /proc/cpuinfo ]] && ! grep -qw avx2 /proc/cpuinfo; then
  echo "This processor has no AVX2: building for any x86-64."
  options+=(-DMOTE_ARCH=x86-64)
fi
log=build/release/configure.log
mkdir -p build/release
if ! cmake --preset "${MOTE_PRESET:-release}" "${options[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  echo "error: CMake could not configure the build (see above)" >&2
  exit 1
fi
targets=()
(($# == 0)) || targets=(--target "$@")
cmake --build build/release "${targets[@]}"
