#!/bin/bash
# The C interface under the address and the undefined-behaviour sanitizer: what tests/c does, a hundred renders among it, may
# read and write nothing that is not its own, leak nothing, and do nothing undefined.
#
#   tools/check_c_sanitized.sh [MOTE]
#
# Compiles the libraries for it in build/sanitize_c (minutes of processor time, once). MOTE is the command whose
# bits are compared (build/release/bin/mote). Not part of ./test. LeakSanitizer needs ptrace; where that is forbidden it
# says so, and ASAN_OPTIONS=detect_leaks=0 leaves that part out.
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)
mote=$(realpath "${1:-$source/build/release/bin/mote}")
build=$source/build/sanitize_c
# Not optimized: that compiles in half of the time, and the renders of the tests are small.
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -g1" \
  "-DCMAKE_C_FLAGS_RELEASE=-O0 -g1" -DMOTE_SANITIZE=address,undefined -DMOTE_BUILD_BENCHMARKS=OFF > /dev/null
cmake --build "$build" --target mote_c_interface_test mote_c_dlopen_test mote_grid_reader
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
mkdir -p "$build/c_tests"
"$build/bin/mote_c_interface_test" "$mote" "$build/c_tests"
"$build/bin/mote_c_dlopen_test" "$build/bin/libmote_c.so"
echo "no report of a sanitizer"
