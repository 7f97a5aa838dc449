#!/bin/bash
# On a Debian that has nothing: do the packages bring what the command and the examples need?
#
#   tools/check_bare_debian.sh [--build BUILD] [ROOT]                           Debian 12, packages of this system's build
#   tools/check_bare_debian.sh --release trixie --packages FOLDER [ROOT]        packages that were made there
#
# Packages depend on libraries of the system that they were made on. tools/check_bare_commands.sh leaves those of Debian 13 in
# build/bare_trixie/srv/mote/build/release/deb_test.
# Makes a Debian of the smallest kind in ROOT (build/bare_debian_RELEASE; debootstrap, kept for the next time, of which the
# packages of the last check are taken away first), installs the .deb files of FOLDER or of BUILD (build/release, built) by
# `apt-get install` with what they declare, nothing that is merely recommended, renders a scene, installs g++ and cmake,
# and builds and runs each example from an empty folder. Needs root, debootstrap and Debian's packages (300 MB); not part of
# ./test. Its siblings: check_bare_commands.sh runs ./quickstart and ./test on a bare Debian 12 and 13, check_bare_wheel.sh
# installs the wheel there.
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)
build=$source/build/release release=bookworm packages= root=
while (($#)); do
  case $1 in
    --build) build=$(realpath "$2") && shift ;;
    --release) release=$2 && shift ;;
    --packages) packages=$(realpath "$2") && shift ;;
    *) root=$(realpath -m "$1") ;;
  esac
  shift
done
root=${root:-$source/build/bare_debian_$release}
if ((EUID != 0)) || ! command -v debootstrap > /dev/null; then
  echo "error: needs root, and debootstrap (apt-get install debootstrap)" >&2
  exit 1
fi

step() { echo "== $*"; }
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }
install() { inside apt-get install -y -q --no-install-recommends "$@" >> "$log" 2>&1 || { tail -n 20 "$log" && exit 1; }; }
log=$root.log
: > "$log"

[[ -e $root/etc/debian_version ]] || { step "a Debian in $root" && debootstrap --variant=minbase "$release" "$root" >> "$log"; }
inside apt-get update -q >> "$log"
for package in mote-dev mote g++ cmake make; do  # together they fail where one is not there
  inside apt-get purge -y -q "$package" >> "$log" 2>&1 || true
done
inside apt-get autoremove -y -q --purge >> "$log" 2>&1
trap 'umount "$root/proc"' EXIT
mount -t proc proc "$root/proc"

step "Debian packages of ${packages:-$build}"
rm -rf "$root/check" && mkdir -p "$root/check"
if [[ ! $packages ]]; then
  packages=$build/bare_debian
  rm -rf "$packages" && (cd "$build" && cpack -G DEB -B "$packages" >> "$log" 2>&1)
fi
cp "$packages"/*.deb "$root/check"
mkdir "$root/check/scenes" && cp -r "$source/scenes/cornell_box.xml" "$source/scenes/meshes" "$root/check/scenes"

step "the command alone"
before=$(inside dpkg-query -f '.\n' -W | wc -l)
install $(cd "$root/check" && echo mote_*.deb | sed 's|^|/check/|')
echo "$(($(inside dpkg-query -f '.\n' -W | wc -l) - before)) packages installed"
inside mote --version
inside mote render /check/scenes/cornell_box.xml -o /check/box.exr --passes 1 -D resx=64 -D resy=64 --quiet
inside ldd /usr/libexec/mote/mote_grid_reader | grep "not found" && exit 1

step "each example, with g++ and cmake alone"
install $(cd "$root/check" && echo mote-dev_*.deb | sed 's|^|/check/|') g++ cmake make
cp -r "$source/examples" "$root/check/examples"
inside mote render /check/examples/ssbc/room.xml -o /check/room.exr --passes 2 --auxiliary --quiet
for file in "$root"/check/examples/*/CMakeLists.txt; do
  example=$(basename "$(dirname "$file")")
  inside cmake -S "/check/examples/$example" -B "/check/build/$example" >> "$log" 2>&1 || { tail -n 20 "$log" && exit 1; }
  inside cmake --build "/check/build/$example" >> "$log" 2>&1 || { tail -n 20 "$log" && exit 1; }
  program=("/check/build/$example/$example")
  plugin=(mote render /check/scenes/cornell_box.xml --plugin "$program.so" -o /check/plugin.exr --passes 1 -D resx=64 -D resy=64)
  case $example in
    ssbc) program+=(/check/room.exr /check/compensated.exr) ;;
    render_scene) program+=(/check/scenes/cornell_box.xml /check/a.exr 1 resx=64 resy=64) ;;
    render_from_c) program+=(/check/scenes/cornell_box.xml /check/b.exr 1 resx 64 resy 64) ;;
    my_integrator) program=("${plugin[@]}" --integrator my_ambient_occlusion) ;;
    my_selector) program=("${plugin[@]}" --integrator mote_vpl -D integrator.selection=by_intensity) ;;
    python_integrator) program=(echo "left out: no headers of Python") ;;
  esac
  said=$(inside "${program[@]}" 2>> "$log" | tail -n 1) || { echo "$example fails" && tail -n 20 "$log" && exit 1; }
  echo "$example: $said"
done

echo "all good: $log"
