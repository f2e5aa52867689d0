#!/usr/bin/env bash
# Makes .venv-oracle, the environment of what tests/oracle compares with. Does nothing when it
# is there already in the version asked for.
set -euo pipefail
cd "$(dirname "$0")/.."

mitsuba=3.7.1
numpy=2.4.6
openexr=3.5.3
opencv=4.11.0.86
pycocotools=2.0.11
flip=1.7
folder=.venv-oracle
marker=$folder/versions
versions="mitsuba==$mitsuba numpy==$numpy OpenEXR==$openexr opencv-python-headless==$opencv pycocotools==$pycocotools flip-evaluator==$flip"

[ "$(cat "$marker" 2>/dev/null || true)" = "$versions" ] && exit 0
/usr/bin/python3 -m venv --clear "$folder"
# shellcheck disable=SC2086
"$folder/bin/pip" install --quiet --disable-pip-version-check $versions
echo "$versions" > "$marker"
