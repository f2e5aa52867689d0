#!/usr/bin/env bash
# Prints one table, EasyPBR beside VTK, threepp and Open3D. usage: EASYPBR_TEST_DATA=FOLDER bench.sh [run.py's options]
set -euo pipefail
cd "$(dirname "$0")/.."
: "${EASYPBR_TEST_DATA:?set it to a folder with nefertiti.obj, env/studio.hdr and DamagedHelmet}"
peers=("vtk==9.7.*" "threepp==2026.10.*" "open3d==0.20.*" trimesh numpy)
if ! .venv-bench/bin/python -c "import vtk, threepp, open3d, trimesh" 2>/dev/null; then
  echo "installing into .venv-bench: ${peers[*]}"
  python3 -m venv .venv-bench
  .venv-bench/bin/pip install --quiet "${peers[@]}"
fi
exec python3 bench/run.py --data "$EASYPBR_TEST_DATA" "$@"
