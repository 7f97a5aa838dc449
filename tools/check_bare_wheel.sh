#!/bin/bash
# Does a wheel of tools/make_wheel.sh work on a Debian that has Python and nothing else?
#
#   tools/check_bare_wheel.sh [RELEASE...]     RELEASE: bookworm (Python 3.11), trixie (3.13); default: both
#
# Makes a Debian of the smallest kind with python3-venv in build/bare_wheel_RELEASE (debootstrap; kept for the next time),
# installs the wheel of build/wheelhouse into a fresh environment there, renders with the command and from Python, reads a
# VDB file, and prints how long each took; fails where the first picture takes over a minute. That of the other release's Python: tools/make_wheel.sh --also. Needs root, debootstrap, Debian's packages (100 MB each) and PyPI for NumPy.
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)
(($#)) || set -- bookworm trixie
if ((EUID != 0)) || ! command -v debootstrap > /dev/null; then
  echo "error: needs root, and debootstrap (apt-get install debootstrap)" >&2
  exit 1
fi

root=
inside() {
  chroot "$root" env -i PATH=/check/python/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HOME=/root DEBIAN_FRONTEND=noninteractive \
    ${PIP_CERT:+PIP_CERT=/check/certificates.crt} "$@"
}
timed() {
  local begin=$EPOCHREALTIME
  inside "$@"
  awk -v a="$begin" -v b="$EPOCHREALTIME" -v c="$(echo "$*" | cut -c1-60)" 'BEGIN { printf "  %.2f s: %s\n", b - a, c }'
}
trap 'mountpoint -q "$root/proc" && umount "$root/proc"' EXIT

for release in "$@"; do
  root=$source/build/bare_wheel_$release log=$source/build/bare_wheel_$release.log
  : > "$log"
  [[ -e $root/etc/debian_version ]] || debootstrap --variant=minbase --include=python3-venv,ca-certificates "$release" "$root" >> "$log"
  mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
  rm -rf "$root/check" && mkdir -p "$root/check"
  tag=cp$(inside python3 -c 'import sys; print("%d%d" % sys.version_info[:2])')
  wheels=("$source"/build/wheelhouse/mote-*-"$tag"-manylinux*.whl)
  cp "${wheels[@]}" "$source/scenes/cornell_box.xml" "$source/tests/blender/ramp.vdb" "$root/check"
  cp -r "$source/scenes/meshes" "$root/check"
  [[ -z ${PIP_CERT:-} ]] || cp -L "$PIP_CERT" "$root/check/certificates.crt"
  echo "== $release: $(inside sh -c 'ls /check/*.whl'), $(inside dpkg-query -f '.\n' -W | wc -l) packages of the system"
  inside python3 -m venv /check/python
  begin=$EPOCHREALTIME
  timed sh -c 'pip install -q --disable-pip-version-check /check/mote-*.whl' 2>> "$log"
  timed mote --version
  timed mote render /check/cornell_box.xml -o /check/box.exr --passes 4 -D resx=64 -D resy=64 --quiet
  awk -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { printf "  %.2f s from the wheel to the first picture\n", b - a; exit b - a > 60 }'
  timed python -m mote info /check/ramp.vdb
  timed python -c "import mote; p = mote.render('/check/cornell_box.xml', passes=1); p.save('/check/box.png'); print(mote.__version__, p)"
  timed python -c "import mote"
  inside test -s /check/python/share/man/man1/mote.1
  umount "$root/proc"
done
echo "all good"
