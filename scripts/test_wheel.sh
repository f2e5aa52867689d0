#!/usr/bin/env bash
# Tests the wheels of dist/ from outside: installed without a network into fresh virtual environments, used by a user
# without root whose HOME cannot be written; then in systems made by debootstrap: Debian 12 and 13 with Python and nothing
# else, Debian 12 with Python and Mesa. Prints times and sizes. usage: test_wheel.sh [VERSION ...]     of Python;
# default: 3.10 3.11 3.12 3.13
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/find_python.sh
versions=("$@")
[ ${#versions[@]} -gt 0 ] || versions=(3.10 3.11 3.12 3.13)
[ -n "$(find dist -name 'easypbr-*.whl' 2>/dev/null)" ] || { echo "test_wheel: dist/ holds no wheel: run make wheel" >&2; exit 1; }
[ "$(id -u)" = 0 ] || { echo "test_wheel: needs root, to cut off the network and to become another user" >&2; exit 1; }
house=build-wheel/wheelhouse

# Wheels of what the package depends on, for each Python: the only use of a network.
for version in "${versions[@]}" 3.11 3.13; do
  [ -e "$house/$version" ] && continue
  platforms=()
  for glibc in 17 24 27 28; do platforms+=(--platform "manylinux_2_${glibc}_x86_64"); done
  .venv/bin/python -m pip download --quiet --disable-pip-version-check --only-binary :all: --python-version "$version" \
      "${platforms[@]}" --platform manylinux2014_x86_64 -d "$house" numpy tomli
  touch "$house/$version"
done

# usage: make_system NAME SUITE [PACKAGE ...]      build-wheel/chroot-NAME, made once
make_system() {
  local name=$1 suite=$2 packages=python3,python3-venv package
  shift 2
  for package in "$@"; do packages+=,$package; done
  local root=$PWD/build-wheel/chroot-$name
  [ ! -e "$root/made" ] || return 0
  rm -rf "$root"
  debootstrap --variant=minbase --include="$packages" "$suite" "$root" >"$root.log" || { tail "$root.log"; exit 1; }
  touch "$root/made"
}
make_system bookworm bookworm
make_system trixie trixie
make_system bookworm-mesa bookworm libegl1 libopengl0 libgl1-mesa-dri

# Where the other user may read and write, whoever may read this folder.
work=$(mktemp -d)
trap 'rm -rf "$work" build-wheel/chroot-*/work' EXIT

# usage: prepare FOLDER      a folder with all that a check needs
prepare() {
  rm -rf "$1"
  mkdir -p "$1/wheels" "$1/home"
  cp dist/easypbr-*.whl "$house"/*.whl "$1/wheels"
  cp tests/wheel/*.py scripts/check_wheel.sh "$1"
  chmod -R go+rX "$1"
  mkdir -m 777 "$1/user"
}

failed=0
alone=(setpriv --reuid 65534 --regid 65534 --clear-groups env -i PATH=/usr/bin:/bin LC_ALL=C.UTF-8)
for version in "${versions[@]}"; do
  echo "Python $version, a fresh virtual environment"
  prepare "$work/$version"
  chmod 755 "$work"
  python=$(python_of "$version")
  # pyenv's Pythons and their libraries stand in a home that other users cannot enter.
  chain=(unshare --net --mount)
  "${chain[@]}" bash -c 'ip link set lo up && mount --bind "$1" /mnt && shift && exec "$@"' - "$("$python" -c 'import sys; print(sys.base_prefix)')" \
      "${alone[@]}" EASYPBR_TEST_GL=yes HOME="$work/$version/home" LD_LIBRARY_PATH=/mnt/lib "$work/$version/check_wheel.sh" \
      "/mnt/bin/python$version" "$work/$version" || failed=1
done

# usage: check_system NAME yes|no      whether it has OpenGL
check_system() {
  local root=$PWD/build-wheel/chroot-$1
  prepare "$root/work"
  unshare --net --mount --pid --fork bash -c '
    ip link set lo up && mount -t proc proc "$0/proc" && mount -t tmpfs tmpfs "$0/dev/shm" &&
        mount -t tmpfs -o mode=1777 tmpfs "$0/tmp" && exec chroot "$0" "$@"' "$root" "${alone[@]}" EASYPBR_TEST_GL="$2" \
      HOME=/work/home /work/check_wheel.sh /usr/bin/python3 /work || failed=1
}
echo "Debian 12 with Python and nothing else"
check_system bookworm no
echo "Debian 13 with Python and nothing else"
check_system trixie no
echo "Debian 12 with Python and Mesa"
check_system bookworm-mesa yes
exit $failed
