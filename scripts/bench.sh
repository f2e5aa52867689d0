#!/usr/bin/env bash
# Prints one table, EasyPBR beside VTK, threepp and Open3D. usage: EASYPBR_TEST_DATA=FOLDER bench.sh [run.py's options]
set -euo pipefail
cd "$(dirname "$0")/.."
: "${EASYPBR_TEST_DATA:?set it to a folder with nefertiti.obj, env/studio.hdr and DamagedHelmet}"
scripts/peers.sh
exec python3 bench/run.py --data "$EASYPBR_TEST_DATA" "$@"
