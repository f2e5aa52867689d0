#!/usr/bin/env bash
# Coverage-guided fuzzing of all readers, each for its share of the seconds given, by default 10 minutes: libFuzzer with
# AddressSanitizer and UBSan. Prints executions and covered branches of each, and which part of the lines of io all of them
# covered, files below 90 % by name; what breaks a reader is kept in build-fuzz/found, and the exit status is 1. A found file that is
# mended belongs into tests/fuzz/seeds or python_seeds, which the tests read.
# usage: fuzz.sh [SECONDS [TARGET...]]
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-600}
shift || true
compiler=$(compgen -c clang++ | grep -E '^clang\+\+(-[0-9]+)?$' | sort -V | tail -1 || true)
[ -n "$compiler" ] || { echo "fuzz: clang is missing (Debian: clang-14 libclang-rt-14-dev)" >&2; exit 1; }
cmake -G Ninja -B build-fuzz -DEASYPBR_FUZZ=ON -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_C_COMPILER="${compiler/++/}" -DEASYPBR_WERROR=OFF -DEASYPBR_HARDENING=OFF -DCCACHE=OFF >/dev/null
cmake --build build-fuzz
targets=("$@")
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(ls tests/fuzz/seeds tests/fuzz/python_seeds | grep '^[a-z]' | grep -v :)
mkdir -p build-fuzz/found build-fuzz/log build-fuzz/profile
rm -f build-fuzz/profile/*
failed=0 total=0

# fuzz_target NAME SECONDS CORPUS: for what Python reads by Atheris, which is libFuzzer too.
fuzz_target() {
  local options=(-max_total_time="$2" -max_len=16384 -timeout=20 -rss_limit_mb=4096 -print_final_stats=1 -artifact_prefix="build-fuzz/found/$1-")
  if [ -d "tests/fuzz/python_seeds/$1" ]; then
    .venv/bin/python "tests/fuzz/$1s.py" "${options[@]}" "$3" "tests/fuzz/python_seeds/$1"
  else
    # LeakSanitizer at the end alone: at every input it costs most of the time.
    EASYPBR_FUZZ_TARGET=$1 EASYPBR_THREADS=1 LLVM_PROFILE_FILE=/dev/null build-fuzz/fuzz "${options[@]}" -detect_leaks=0 "$3" "tests/fuzz/seeds/$1"
  fi
}
printf '%-12s %12s %10s\n' target executions branches
for target in "${targets[@]}"; do
  corpus=build-fuzz/corpus/$target log=build-fuzz/log/$target
  mkdir -p "$corpus"
  status=0
  fuzz_target "$target" $((seconds / ${#targets[@]} + 1)) "$corpus" >"$log" 2>&1 || status=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  branches=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
  printf '%-12s %12s %10s\n' "$target" "${runs:-0}" "${branches:-0}"
  total=$((total + ${runs:-0}))
  if [ $status != 0 ]; then
    echo "fuzz: $target failed: $log" >&2
    grep -m 3 -E 'ERROR|runtime error|Test unit written' "$log" >&2 || true
    failed=1
  fi
done
echo "$total executions"
version=${compiler#clang++}
if command -v "llvm-cov$version" >/dev/null; then
  # All that has been found so far is run once more: what a crash covered is not written.
  for target in "${targets[@]}"; do
    [ -d "tests/fuzz/seeds/$target" ] || continue
    EASYPBR_FUZZ_TARGET=$target EASYPBR_THREADS=1 LLVM_PROFILE_FILE=build-fuzz/profile/$target.profraw build-fuzz/fuzz \
        -runs=0 -max_len=16384 -detect_leaks=0 "build-fuzz/corpus/$target" "tests/fuzz/seeds/$target" >/dev/null 2>&1 || true
  done
  "llvm-profdata$version" merge -o build-fuzz/profile/all.profdata build-fuzz/profile/*.profraw
  "llvm-cov$version" export -summary-only -instr-profile build-fuzz/profile/all.profdata build-fuzz/fuzz src/easypbr/io |
      python3 scripts/fuzz_coverage.py
fi
exit $failed
