#!/bin/bash
# A part of test_wheel.sh, which runs it cut off from the network, as a user without root: installs the wheel from
# FOLDER/wheels, draws, prints times and sizes, and runs the tests in FOLDER. usage: check_wheel.sh PYTHON FOLDER
set -euo pipefail
python=$1 folder=$2
cd "$folder/user"
TIMEFORMAT='  %R s, of which the CPU worked %U s'
"$python" -m venv venv
echo installation
time venv/bin/python -m pip install --quiet --disable-pip-version-check --no-cache-dir --no-index \
    --find-links "$folder/wheels" easypbr
du -sb --total venv/lib/python*/site-packages/easypbr{,.libs} | awk 'END {printf "  %.1f MB\n", $1 / 1e6}'
echo "first picture of this user"
time venv/bin/python -c "import easypbr; easypbr.render(easypbr.shapes.teapot(), 'first.png', size=(640, 480))"
echo "import of numpy alone; of easypbr with it"
time venv/bin/python -c "import numpy"
time venv/bin/python -c "import easypbr"
echo "picture after that"
time venv/bin/python -c "import easypbr; easypbr.render(easypbr.shapes.teapot(), 'second.png', size=(640, 480))"
venv/bin/python "$folder/test_installed.py" -v
