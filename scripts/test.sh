#!/usr/bin/env bash
# Every test of every language. usage: test.sh
# Tests on real files run where EASYPBR_TEST_DATA names their folder; elsewhere they say that they were left out.
set -uo pipefail
cd "$(dirname "$0")/.."
failed=0
caches=$(mktemp -d)
trap 'rm -rf "$caches"' EXIT
export EASYPBR_CACHE_DIR=$caches

# What takes longer than its limit is stopped with the stacks of its threads, so that a test that hangs has a name.
limit_s=600
stacks=(-o "faulthandler_timeout=$limit_s" -o faulthandler_exit_on_timeout=true)

echo "C++ tests, $(date -u +%T)"
ctest --test-dir build --output-on-failure -j "$(nproc)" --timeout "$limit_s" || failed=1
if [ -z "${EASYPBR_TEST_DATA:-}" ]; then
  echo "EASYPBR_TEST_DATA is not set: $(ctest --test-dir build -N | grep -c 'Test *#') tests ran, those on real files were left out"
fi
for part in cli instructions python faults golden window remote web oracle package docs; do
  echo "tests/$part, $(date -u +%T)"
  .venv/bin/python -m pytest -q --durations=3 "${stacks[@]}" "tests/$part" || failed=1
done
echo "the end, $(date -u +%T)"
exit $failed
