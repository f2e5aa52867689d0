#!/usr/bin/env bash
# Prints one table, EasyPBR beside VTK 9 and Open3D. usage: EASYPBR_TEST_DATA=FOLDER bench.sh [run.py's options]
set -euo pipefail
cd "$(dirname "$0")/.."
: "${EASYPBR_TEST_DATA:?set it to a folder with nefertiti.obj and env/studio.hdr}"
missing=()
for package in python3-vtk9 python3-open3d python3-numpy xvfb xauth time; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "installing Debian packages: ${missing[*]}"
  as_root=(); [ "$(id -u)" = 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi
exec xvfb-run -a -s "-screen 0 1920x1080x24" python3 bench/run.py --data "$EASYPBR_TEST_DATA" "$@"
