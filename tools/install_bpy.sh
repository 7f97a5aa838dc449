#!/bin/sh
# Fetches Blender 4.5 as a Python module (bpy, 370 MB to load, 950 MB on the disk) from PyPI into a virtual environment of
# its own, build/bpy; nothing of the user's Python changes. Only for who wants the add-on tested there as well: no test
# runs this. It needs Python 3.11.
# Usage: tools/install_bpy.sh
set -e
cd "$(dirname "$0")/.."
python=${PYTHON:-python3.11}
mkdir -p build
"$python" -m venv build/bpy
build/bpy/bin/pip install --quiet --disable-pip-version-check 'bpy==4.5.*'
build/bpy/bin/python -c "import bpy; print('build/bpy: Blender', bpy.app.version_string)"
