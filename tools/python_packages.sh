#!/bin/sh
# Fetches what the Python module is built and tested with (nanobind, NumPy) from PyPI into a virtual environment of its
# own, build/python; nothing of the user's Python changes. Where PyPI cannot be reached it says so and ends with 0: the
# module is then not built, and all else is.
# Usage: tools/python_packages.sh
cd "$(dirname "$0")/.." || exit 1
folder=build/python
python=${PYTHON:-python3}
if [ -x "$folder/bin/python" ] && "$folder/bin/python" -c "import nanobind, numpy" 2> /dev/null; then
    exit 0
fi
mkdir -p build
if "$python" -m venv "$folder" > /dev/null 2>&1 &&
    timeout 120 "$folder/bin/pip" install --quiet --disable-pip-version-check "nanobind>=2.2" numpy > build/python.log 2>&1; then
    exit 0
fi
echo "No nanobind and NumPy (build/python.log says why): the Python module is not built, and its tests are skipped." >&2
rm -rf "$folder"
exit 0
