#!/usr/bin/env bash
# Compiles the native shaders' kernels for AArch64, where they use the compiler's own vectors, and for x86-64-v2, runs both on
# the same numbers (tests/native/cross_kernels.cpp; AArch64 under qemu) and compares the bits of all that they write. Prints how
# many results are the same; names the kernels that differ, and then the exit status is 1. The flags are those of the build
# (cmake/native.cmake). usage: check_aarch64.sh
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-aarch64
log=$build/log
compiler=aarch64-linux-gnu-g++
emulator=qemu-aarch64
command -v "$emulator" >/dev/null || emulator=qemu-aarch64-static
for program in "$compiler" "$emulator"; do
  command -v "$program" >/dev/null ||
      { echo "check_aarch64: $program is missing (Debian: g++-aarch64-linux-gnu qemu-user)" >&2; exit 1; }
done
[ "$(uname -m)" = x86_64 ] || { echo "check_aarch64: results are compared with those of an x86-64 processor" >&2; exit 1; }
mkdir -p "$build"

# Without the hardening's flags, some of which are x86's alone.
cmake --preset release -B "$build" -DEASYPBR_INSTRUCTION_SETS=v2 -DEASYPBR_HARDENING=OFF -DEASYPBR_BUILD_TESTS=OFF -DEASYPBR_BUILD_PYTHON=OFF \
    -DCMAKE_CXX_COMPILER=g++ -DCMAKE_UNITY_BUILD=OFF >"$log" 2>&1 || { cat "$log"; exit 1; }
ninja -C "$build" generated/native/shaders.h >"$log" || { cat "$log"; exit 1; }
# What the build compiles kernels.cpp with, from the definition of the instruction set on.
flags=$(ninja -C "$build" -t commands easypbr_native_v2 | sed -n 's/.* -DEASYPBR_ISA=v2 \(.*\) -march=x86-64-v2 \(.*\) -MD .*/\1 \2/p')
[ -n "$flags" ] || { echo "check_aarch64: the build's flags are not known" >&2; exit 1; }

# build_kernels NAME COMPILER MARCH: the program for an instruction set.
build_kernels() {
  local definitions=(-DEASYPBR_ISA="$1" -march="$3")
  # shellcheck disable=SC2086
  "$2" "${definitions[@]}" $flags -c src/easypbr/native/simd/kernels.cpp -o "$build/kernels_$1.o"
  # shellcheck disable=SC2086
  "$2" "${definitions[@]}" $flags -static -o "$build/cross_$1" tests/native/cross_kernels.cpp "$build/kernels_$1.o"
}
build_kernels base "$compiler" armv8-a
build_kernels v2 g++ x86-64-v2
"$emulator" "$build/cross_base" >"$build/base.txt"
"$build/cross_v2" >"$build/v2.txt"

# The first column is the kernel, the third the hash.
mapfile -t different < <(diff "$build/v2.txt" "$build/base.txt" | awk '/^[<>]/ {print $2}' | sort -u)
if [ ${#different[@]} -gt 0 ]; then
  printf 'check_aarch64: %s differs from x86-64-v2\n' "${different[@]}" >&2
  echo "check_aarch64: hashes of all results are in $build/v2.txt and $build/base.txt" >&2
  exit 1
fi
awk '{names[$1]} END {for (name in names) ++kernels
     print "AArch64 and x86-64-v2: all " NR " results of " kernels " kernels are the same bits"}' "$build/base.txt"
