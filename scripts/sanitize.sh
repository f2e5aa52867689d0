#!/usr/bin/env bash
# All C++ tests under AddressSanitizer and UBSan. usage: sanitize.sh [CTEST-OPTION...]
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset asan >/dev/null
cmake --build build-asan
# Mesa and its JIT keep memory until the process ends; what leaks is theirs.
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1
ctest --test-dir build-asan --output-on-failure -j "$(nproc)" "$@"
