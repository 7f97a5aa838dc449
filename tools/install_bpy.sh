#!/bin/sh
# Fetches Blender as a Python module (bpy; 4.5: 370 MB to load, 950 MB on the disk) from PyPI into a virtual environment of
# its own; nothing of the user's Python changes. Only for who wants the add-on tested there as well, or Cycles measured
# (experiments/trade/run --peers: 5.0.1, build/bpy_env): no test runs this. It needs Python 3.11.
# Usage: tools/install_bpy.sh [VERSION [FOLDER]]      default: 4.5.* build/bpy
set -e
cd "$(dirname "$0")/.."
python=${PYTHON:-python3.11} version=${1:-4.5.*} folder=${2:-build/bpy}
mkdir -p build
"$python" -m venv "$folder"
"$folder/bin/pip" install --quiet --disable-pip-version-check "bpy==$version" numpy
"$folder/bin/python" -c "import bpy; print('$folder: Blender', bpy.app.version_string)"
