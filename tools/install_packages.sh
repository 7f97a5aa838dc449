#!/bin/bash
# Installs the Debian packages that mote is built from, if any is missing. Says which before it does.
#
#   tools/install_packages.sh          install what is missing (with sudo when not root)
#   tools/install_packages.sh --list   print the names and end
#   tools/install_packages.sh --fuzz   also what the long campaign of tools/fuzz/run is built with
#   tools/install_packages.sh --browser  also chromium (411 MB), in which the viewer's page is tested
#   pip install pyoidn                 not from Debian and not needed: OpenImageDenoise, for --denoise (docs/guide.md)
#   MOTE_SKIP_PACKAGES=1               believe that everything is there, on systems without dpkg
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache                        # the build
  libembree-dev                                       # ray tracing
  libopenvdb-dev libnanovdb-dev                       # smoke and clouds
  zlib1g-dev                                          # Mitsuba's serialized meshes
  libblosc-dev libboost-iostreams-dev                 # what OpenVDB's CMake module asks for, and zlib
  libboost-dev                                        # Boost.Beast, headers: the viewer's server
  libopenexr-dev libimath-dev python3-imath           # EXR; Imath's CMake config names a Python library
  libpng-dev libjpeg-dev                              # textures and previews
  libassimp-dev                                       # mesh files
  libglm-dev libtbb-dev                               # vectors, threads
  libeigen3-dev                                       # columns of light in clusters; what ours is tested against
  libpugixml-dev libcli11-dev libfmt-dev nlohmann-json3-dev
  catch2 libbenchmark-dev                             # tests and benchmarks
  python3-numpy python3-matplotlib                    # the figures of experiments/figures
  python3-venv python3-dev                            # the Python module (tools/python_packages.sh)
  dpkg-dev file                                       # the Debian packages (cpack -G DEB) and their test
  glmark2-data                                        # a real bunny and horse
  doxygen                                             # the reference of the library (19 MB; left out where missing)
)

if [[ "${1:-}" == --fuzz ]]; then
  packages+=(clang-14 libclang-rt-14-dev)
fi
if [[ "${1:-}" == --browser ]]; then
  packages+=(chromium)
fi
if [[ "${1:-}" == --list ]]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi
if [[ "${MOTE_SKIP_PACKAGES:-0}" == 1 ]]; then
  exit 0
fi
if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  {
    echo "error: this system has no dpkg and apt-get, so packages cannot be installed for you."
    echo "mote needs what these packages of Debian 12 or 13 hold:"
    printf '  %s\n' "${packages[@]}"
    echo "Where they are installed by other means, run again with MOTE_SKIP_PACKAGES=1."
  } >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ "$status" == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

echo "Missing packages, to be installed now: ${missing[*]}"
as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "error: not root, and there is no sudo. As root, run:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
install=(env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}")
if ! "${as_root[@]}" apt-get update -q || ! "${as_root[@]}" "${install[@]}" </dev/null; then
  {
    echo "error: apt-get could not install: ${missing[*]}"
    echo "The names are those of Debian 12 (bookworm) and 13 (trixie), section main; other systems may name them differently."
    echo "Where they are installed by other means, run again with MOTE_SKIP_PACKAGES=1."
  } >&2
  exit 1
fi
