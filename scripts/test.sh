#!/usr/bin/env bash
# Every test of every language. usage: test.sh
# Tests on real files run where EASYPBR_TEST_DATA names their folder; elsewhere they say that they were left out.
set -uo pipefail
cd "$(dirname "$0")/.."
failed=0
caches=$(mktemp -d)
trap 'rm -rf "$caches"' EXIT
export EASYPBR_CACHE_DIR=$caches

ctest --test-dir build --output-on-failure -j "$(nproc)" || failed=1
if [ -z "${EASYPBR_TEST_DATA:-}" ]; then
  echo "EASYPBR_TEST_DATA is not set: $(ctest --test-dir build -N | grep -c 'Test *#') tests ran, those on real files were left out"
fi
.venv/bin/python -m pytest -q tests/cli tests/python tests/window tests/oracle tests/package tests/docs || failed=1
exit $failed
