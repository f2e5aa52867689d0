#!/usr/bin/env bash
# Builds wheels that need nothing of the system but the C and C++ libraries of manylinux_2_34: dist/easypbr-*.whl, one for
# each version of Python below 3.12, and one for 3.12 and all later ones (stable ABI). usage: wheel.sh [VERSION ...]
# Versions default to 3.10, 3.11 and 3.12; each is looked for as pythonVERSION in PATH, then among pyenv's. WHEEL_OPTIONS
# holds further options of `pip wheel`.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/find_python.sh
versions=("$@")
[ ${#versions[@]} -gt 0 ] || versions=(3.10 3.11 3.12)
platform=manylinux_2_34_x86_64
largest=30000000
# FFmpeg's libraries come with x264, whose licence would bind the wheel: those of the system are used where it has them.
excluded=(--exclude 'libav*.so.*' --exclude 'libsw*.so.*')
# The names that the preset's compiler has, so that ccache knows what a build beside this one compiled.
export CC=${CC:-cc} CXX=${CXX:-c++}

interpreters=()
for version in "${versions[@]}"; do interpreters+=("$(python_of "$version")"); done

rm -rf build-wheel/raw build-wheel/repaired
for i in "${!versions[@]}"; do
  version=${versions[i]} environment=.venv-wheel/${versions[i]}
  if ! cmp -s scripts/requirements-wheel.txt "$environment/requirements"; then
    "${interpreters[i]}" -m venv "$environment"
    "$environment/bin/python" -m pip install --quiet --disable-pip-version-check -r scripts/requirements-wheel.txt
    cp scripts/requirements-wheel.txt "$environment/requirements"
  fi
  echo "wheel: Python $version, $(date -u +%T)"
  # One build folder for all: what does not depend on the version of Python is compiled once.
  PATH=$PWD/$environment/bin:$PATH "$environment/bin/python" -m pip wheel . --quiet --disable-pip-version-check \
      --no-deps --no-index --no-build-isolation -w build-wheel/raw --config-settings=cmake.define.EASYPBR_PORTABLE=ON ${WHEEL_OPTIONS:-}
done
tools=$PWD/.venv-wheel/${versions[-1]}/bin
for wheel in build-wheel/raw/*.whl; do
  PATH=$tools:$PATH auditwheel repair --plat "$platform" --only-plat "${excluded[@]}" \
      --zip-compression-level 9 -w build-wheel/repaired "$wheel"
done
mkdir -p dist
rm -f dist/easypbr-*.whl
for wheel in build-wheel/repaired/*.whl; do
  size=$(stat -c %s "$wheel")
  echo "$(basename "$wheel"): $size bytes"
  python3 scripts/write_licenses.py --check "$wheel"
  [ "$size" -le "$largest" ] || { echo "wheel: more than $largest bytes" >&2; exit 1; }
  mv "$wheel" dist/
done
