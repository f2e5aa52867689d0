#!/usr/bin/env bash
# gpu_check.sh --carried from outside: in a fresh Debian made by debootstrap, cut off from the network, with a folder that
# gpu_check.sh --fill has filled. Every step must succeed; without limits on time, as this machine may be a slow one.
# usage: test_carried.sh [FOLDER [STEP...]]     by default build-carried/folder, which is filled, and all steps
set -euo pipefail
cd "$(dirname "$0")/.."
[ "$(id -u)" = 0 ] || { echo "test_carried: needs root, to cut off the network and to enter another system" >&2; exit 1; }
carried=$(realpath -m "${1:-build-carried/folder}")
shift || true
suite=${EASYPBR_CHROOT_SUITE:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
root=$PWD/build-carried/chroot-$suite
mkdir -p build-carried
[ -e "$carried/release" ] || scripts/gpu_check.sh --fill "$carried"
# Anew each time: what a machine has from before would hide what the folder lacks.
rm -rf "$root"
debootstrap --variant=minbase "$suite" "$root" >build-carried/debootstrap.log || { tail build-carried/debootstrap.log; exit 1; }
mkdir -p "$root/easypbr" "$root/carried" "$root/out"
git ls-files -z | tar --null --files-from=- -c | tar -x -C "$root/easypbr"

status=0
unshare --net --mount --pid --fork bash -c 'mount --bind "$1" "$2/carried" && mount -t proc proc "$2/proc" && mount -t tmpfs tmpfs "$2/tmp"
  cd / && exec chroot "$2" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
      /easypbr/scripts/gpu_check.sh --software --no-limit --carried /carried --output /out --steps "$3"' - "$carried" "$root" "$*" || status=$?
[ $status = 0 ] || tail -n 20 "$root"/out/*.log
exit $status
