#!/usr/bin/env bash
# The notebook widget in JupyterLab and nbconvert, from PyPI into .venv-notebook; the library must be built.
# usage: check_notebook.sh [PYTEST_OPTIONS]
set -euo pipefail
cd "$(dirname "$0")/.."
file=scripts/requirements-notebook.txt
stamp=.venv-notebook/requirements
if ! cmp -s "$file" "$stamp"; then
  echo "installing the Python packages of $file into .venv-notebook"
  [ -x .venv-notebook/bin/python ] || /usr/bin/python3 -m venv .venv-notebook
  .venv-notebook/bin/python -m pip install --quiet --disable-pip-version-check -r "$file"
  cp "$file" "$stamp"
fi
.venv-notebook/bin/python scripts/link_python.py build .venv-notebook
.venv-notebook/bin/python -m pytest -q --durations=3 "$@" tests/notebook
