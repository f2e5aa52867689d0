#!/usr/bin/env bash
# Makes .venv-bench, the environment of the programs that benchmarks compare with. Does nothing when it has them.
set -euo pipefail
cd "$(dirname "$0")/.."
peers=("vtk==9.7.*" "threepp==2026.10.*" "open3d==0.20.*" "f3d==4.0.*" trimesh numpy pillow)
.venv-bench/bin/python -c "import vtk, threepp, open3d, f3d, trimesh, PIL" 2>/dev/null && exit 0
echo "installing into .venv-bench: ${peers[*]}"
python3 -m venv .venv-bench
.venv-bench/bin/pip install --quiet "${peers[@]}"
