#!/usr/bin/env bash
# Builds the documentation into site/, the reference pages from the settings table and the stubs. usage: docs.sh
set -euo pipefail
cd "$(dirname "$0")/.."
.venv/bin/python scripts/write_reference.py docs/reference
.venv/bin/mkdocs build --strict --quiet
echo "documentation: site/index.html"
