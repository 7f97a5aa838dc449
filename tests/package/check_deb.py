"""Makes the Debian packages, unpacks them into the build folder, and looks whether they would work where nothing else is.

The command runs from there; each library that it and the helper program load comes from a package in Depends; mote-dev
depends on the packages that hold what mote-config.cmake looks for. --simulate has apt-get say besides what it would
install on a system without any package (needs apt's lists).
"""
import argparse
import re
import shutil
import subprocess
import sys
from pathlib import Path

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--build", type=Path, required=True)
parser.add_argument("--simulate", action="store_true")
arguments = parser.parse_args()
work = arguments.build / "deb_test"

for tool in ("dpkg-deb", "dpkg-shlibdeps", "dpkg", "objdump", "ldd"):
    if not shutil.which(tool):
        print(f"SKIPPED: no {tool}")
        sys.exit(77)


def fail(what):
    sys.exit(f"deb: {what}")


def run(*command):
    done = subprocess.run([str(c) for c in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          cwd=arguments.build)
    if done.returncode != 0:
        fail(f"{' '.join(map(str, command))}\n{done.stdout[-4000:]}\nended with {done.returncode}")
    return done.stdout


def depends(package):
    return {entry.split("(")[0].strip() for entry in run("dpkg-deb", "-f", package, "Depends").split(",")}


def owner(file):
    """The package that a file of the system belongs to; /lib may be a link to /usr/lib."""
    for name in (file.resolve(), Path(str(file.resolve()).removeprefix("/usr")), file):
        done = subprocess.run(["dpkg", "-S", name], text=True, capture_output=True)
        if done.returncode == 0:
            return done.stdout.split(":")[0]
    fail(f"no package holds {file}")


def check_libraries(binary, known):
    needed = set(re.findall(r"NEEDED\s+(\S+)", run("objdump", "-p", binary)))
    for name, file in re.findall(r"(\S+) => (\S+)", run("ldd", binary)):
        if name in needed and owner(Path(file)) not in known:
            fail(f"{binary.name} loads {name}, of {owner(Path(file))}, which Depends does not name")
    if re.search(r"R(UN)?PATH", run("objdump", "-p", binary)):
        fail(f"{binary.name} names folders of the build")
    return len(needed)


shutil.rmtree(work, ignore_errors=True)
work.mkdir()
run("cpack", "-G", "DEB", "-B", work)
command, dev = next(work.glob("mote_*.deb")), next(work.glob("mote-dev_*.deb"))
root = work / "root"
for package in (command, dev):
    run("dpkg", "-x", package, root)
version = run(root / "usr/bin/mote", "--version").split()[-1]
if version not in command.name:
    fail(f"{command.name} holds version {version}")
libraries = check_libraries(root / "usr/bin/mote", depends(command))
libraries += check_libraries(root / "usr/libexec/mote/mote_grid_reader", depends(command))
config = next(root.rglob("mote-config.cmake")).read_text()
homes = {"TBB": "libtbb-dev", "glm": "libglm-dev", "embree": "libembree-dev", "fmt": "libfmt-dev",
         "pugixml": "libpugixml-dev", "OpenEXR": "libopenexr-dev", "PNG": "libpng-dev", "JPEG": "libjpeg-dev",
         "assimp": "libassimp-dev", "ZLIB": "zlib1g-dev"}
for name in re.findall(r"find_dependency\((\w+)", config):
    if name != "Threads" and homes.get(name) not in depends(dev):
        fail(f"mote-config.cmake looks for {name}, and mote-dev does not depend on it")
if f"mote (= {version})" not in run("dpkg-deb", "-f", dev, "Depends"):
    fail("mote-dev may be installed beside another version of mote")
if arguments.simulate:
    (work / "status").touch()
    plan = run("apt-get", "install", "-s", "--no-install-recommends", "-o", f"Dir::State::status={work}/status",
               command.resolve(), dev.resolve())
    if "Conf mote-dev" not in plan:
        fail(f"apt-get would not install them:\n{plan[-2000:]}")
print(f"{command.name} {command.stat().st_size / 1e6:.1f} MB, {dev.name} {dev.stat().st_size / 1e6:.1f} MB; "
      f"{libraries} libraries of the system, all in Depends")
