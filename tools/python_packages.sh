#!/bin/sh
# Fetches what the Python module is built and tested with (nanobind, NumPy) from PyPI into a virtual environment of its
# own, build/python; nothing of the user's Python changes. Where PyPI cannot be reached it says so and ends with 0: the
# module is then not built, and all else is. With --notebook also what the notebooks of examples/ are run with (120 MB), with
# --denoiser OpenImageDenoise (170 MB).
# Usage: tools/python_packages.sh [--notebook | --denoiser]
cd "$(dirname "$0")/.." || exit 1
folder=build/python
python=${PYTHON:-python3}
mkdir -p build

has() { "$folder/bin/python" -c "import $1" 2> /dev/null; }
install() { timeout 300 "$folder/bin/pip" install --quiet --disable-pip-version-check "$@" > build/python.log 2>&1; }

if ! has "nanobind, numpy"; then
    if ! "$python" -m venv "$folder" > /dev/null 2>&1 || ! install "nanobind>=2.2" numpy; then
        echo "No nanobind and NumPy (build/python.log says why): the Python module is not built, and its tests are skipped." >&2
        rm -rf "$folder"
        exit 0
    fi
fi
if [ "${1:-}" = --notebook ] && ! has "anywidget, nbclient, ipykernel"; then
    install anywidget nbclient ipykernel ||
        echo "No anywidget, nbclient and ipykernel (build/python.log says why): notebooks are not run." >&2
fi
if [ "${1:-}" = --denoiser ] && ! has pyoidn; then
    install pyoidn ||
        echo "No pyoidn (build/python.log says why): mote denoises by its own filter." >&2
fi
exit 0
