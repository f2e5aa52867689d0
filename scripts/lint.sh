#!/usr/bin/env bash
# clang-tidy on all sources and headers of the library, the command line and the Python module: what it finds, and
# exit status 1 if it finds anything. `scripts/setup.sh tests` must have run; no build is needed. usage: lint.sh
set -euo pipefail
cd "$(dirname "$0")/.."
build=build-lint
log=$build/lint.log
jobs=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
mkdir -p "$build"

# Larger batches than the preset's: each header is parsed and searched once for many sources. Without GCC's precompiled headers and ccache's
# option for them, which clang-tidy does not know.
cmake --preset release -B "$build" -DCMAKE_UNITY_BUILD_BATCH_SIZE=32 -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCCACHE=OFF -DEASYPBR_WERROR=OFF \
    -DEASYPBR_BUILD_TESTS=OFF -DPython_EXECUTABLE="$PWD/.venv/bin/python" >"$log" 2>&1 || { cat "$log"; exit 1; }
ninja -C "$build" -j "$jobs" generated/easypbr_shaders.inc generated/easypbr_dfg.inc generated/easypbr_ltc.inc generated/easypbr_page.inc generated/easypbr_offline.inc generated/easypbr_presets.inc generated/native/shaders.h >"$log" || { cat "$log"; exit 1; }

# What only GCC knows.
sed -i 's/ -fira-region=[a-z]*//' "$build/compile_commands.json"

# A source that is in no unit, for want of an optional package say, would pass unseen.
# Of the kernels, which are compiled for each instruction set, those of the widest one are checked.
others='/(nanobind-static|bench_[a-z]+|easypbr_native_(v2|avx2))\.dir/'
mapfile -t units < <(sed -n 's/^ *"file": "\([^"]*\)".*/\1/p' "$build/compile_commands.json" | grep -Ev "$others")
mapfile -t sources < <(find src -name '*.cpp')
listed=$(printf '"%s"\n' "${units[@]}"; cat "${units[@]}")
failed=0
for source in "${sources[@]}"; do
  [[ $listed == *"/$source\""* ]] || { echo "lint: $source is in no unit of $build" >&2; failed=1; }
done

# Each line once: a header is in many units.
declare -A seen
set +e
run-clang-tidy -quiet -j "$jobs" -p "$build" "^(?!.*$others)" 2>&1 |
    sed -u "s/\x1b\[[0-9;]*m//g; s|^$PWD/||; s/: error: \(.*\),-warnings-as-errors\]/: warning: \1]/" | tee "$log" |
    grep --line-buffered -E '^([^ ]+:[0-9]+:[0-9]+: (warning|error)|error): ' | while IFS= read -r line; do
      [ -n "${seen[$line]:-}" ] || echo "$line"
      seen[$line]=1
    done
[ "${PIPESTATUS[0]}" = 0 ] || { echo "lint: all messages are in $log" >&2; failed=1; }
echo "lint: ${#units[@]} units with ${#sources[@]} sources were checked"
exit $failed
