#!/usr/bin/env bash
# Builds the documentation into site/, the reference pages from the settings table and the stubs. usage: docs.sh
set -euo pipefail
cd "$(dirname "$0")/.."
if [ ! -x .venv-docs/bin/mkdocs ]; then
  /usr/bin/python3 -m venv .venv-docs
  .venv-docs/bin/python -m pip install --quiet --disable-pip-version-check mkdocs
fi
.venv/bin/python scripts/write_reference.py docs/reference
.venv-docs/bin/mkdocs build --strict --quiet
echo "documentation: site/index.html"
