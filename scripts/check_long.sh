#!/usr/bin/env bash
# Soaks: 10,000 updates of a cloud and data sets of 5,000 frames, whose memory must not grow; data sets killed 1000 times; 100,000
# frames of a scene that changes, viewers made and dropped, recorders killed (EASYPBR_LONG_SOAK); many faults of the system; all
# loaders on 10,000 mutated files each under AddressSanitizer and UBSan, and all C++ tests under both and under ThreadSanitizer; a picture of 16384 x 9216 pixels
# in tiles; native shading against the driver's on 200 random scenes; golden scenes on llvmpipe,
# zink and softpipe; the native shaders' kernels for AArch64 against those for x86-64-v2; the library built as a part of another
# project; each source compiled alone, as what unity files hold together hides headers that a source does not include. usage: check_long.sh
set -euo pipefail
cd "$(dirname "$0")/.."
.venv/bin/python bench/cloud_updates.py
.venv/bin/python -m pytest -q -s tests/long
EASYPBR_FAULTS=100 build/tests/test_faults
EASYPBR_FAULTS=20 .venv/bin/python -m pytest -q tests/faults
EASYPBR_TEST_SCENES=200 build/tests/test_app --gtest_filter='NativeShading.*'
.venv/bin/python tests/golden/compare_drivers.py
scripts/check_aarch64.sh
scripts/sanitize.sh -E Fuzz
EASYPBR_FUZZ_COUNT=10000 scripts/sanitize.sh address -R Fuzz --timeout 7200
cmake -G Ninja -S tests/package/fetched -B build-fetched -DEASYPBR_SOURCE="$PWD" >/dev/null
cmake --build build-fetched --target fetched
cmake --preset dev -DPython_EXECUTABLE="$PWD/.venv/bin/python" >/dev/null
cmake --build --preset dev
