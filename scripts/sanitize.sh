#!/usr/bin/env bash
# All C++ tests under AddressSanitizer and UBSan (address), or under ThreadSanitizer (thread); without a name under both, one
# after the other. usage: sanitize.sh [address|thread] [CTEST-OPTION...]
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  address | thread) sanitizers=("$1"); shift ;;
  *) sanitizers=(address thread) ;;
esac
# Mesa and its JIT keep memory until the process ends; what leaks is theirs. Tests send themselves SIGBUS,
# and ask for more memory than there is.
export ASAN_OPTIONS=detect_leaks=0:handle_sigbus=0:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp history_size=4 second_deadlock_stack=1 handle_sigbus=0 allocator_may_return_null=1"
failed=0
for sanitizer in "${sanitizers[@]}"; do
  preset=asan
  [ "$sanitizer" = address ] || preset=tsan
  cmake --preset $preset >/dev/null
  cmake --build build-$preset
  ctest --test-dir build-$preset --output-on-failure -j "$(nproc)" "$@" || failed=1
done
exit $failed
