#!/bin/bash
# A part of test_wheel.sh, which runs it cut off from the network, as a user without root: installs the wheel from
# FOLDER/wheels, draws, and runs the tests in FOLDER. usage: check_wheel.sh PYTHON FOLDER
set -euo pipefail
python=$1 folder=$2
cd "$folder/user"
now() { "$python" -c 'import time; print(time.time())'; }
"$python" -m venv venv
begin=$(now)
venv/bin/python -m pip install --quiet --disable-pip-version-check --no-cache-dir --no-index --find-links "$folder/wheels" easypbr
installed=$(now)
venv/bin/python -c "import easypbr; easypbr.render(easypbr.shapes.teapot(), 'first.png', size=(640, 480))"
"$python" -c "print('install %.1f s, first picture %.1f s' % ($installed - $begin, $(now) - $installed))"
site=$(venv/bin/python -c "import easypbr, os; print(os.path.dirname(os.path.dirname(easypbr.__file__)))")
du -sb --total "$site"/easypbr "$site"/easypbr.libs | awk 'END {printf "installed: %.1f MB\n", $1 / 1e6}'
venv/bin/python "$folder/test_installed.py" -v
