#!/usr/bin/env python3
"""The wheel for a Python that this system does not have: of the one that it has, with the module compiled for the other's headers.

    tools/wheel_for_headers.py --wheel WHEEL --build build/wheel --version 3.13 --include FOLDER -o FOLDER

FOLDER of --include is the usr/include of the other Python's development package (holds python3.13/Python.h). Nothing else in a wheel
depends on the interpreter. The commands that compiled the module here are run again, with those headers.
"""
import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path


def commands(build, target):
    """What ninja runs for the module alone: its files, nanobind's, and the link."""
    said = subprocess.run(["ninja", "-C", build, "-t", "commands", target], check=True, capture_output=True, text=True).stdout
    own = re.compile(r"python/CMakeFiles/(_mote|nanobind-static\w*)\.dir/|-o python/_mote\.|/_mote\.cpython-\d+")
    return [line for line in said.splitlines() if own.search(line)]


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--wheel", type=Path, required=True)
    options.add_argument("--build", type=Path, required=True)
    options.add_argument("--version", required=True, help="3.13")
    options.add_argument("--include", type=Path, required=True)
    options.add_argument("-o", dest="folder", type=Path, required=True)
    chosen = options.parse_args()
    tag, include = "cp" + chosen.version.replace(".", ""), chosen.include.resolve()
    headers = include / f"python{chosen.version}"
    if not (headers / "Python.h").is_file():
        sys.exit(f"{headers} holds no Python.h")
    own_tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    own_headers = __import__("sysconfig").get_paths()["include"]
    own_module = next(chosen.build.rglob(f"_mote.cpython-{own_tag[2:]}-*.so"))
    module = own_module.with_name(own_module.name.replace(f"-{own_tag[2:]}-", f"-{tag[2:]}-"))
    run = partial(subprocess.run, shell=True, check=True, cwd=chosen.build)
    compiling, linking = [], []
    for line in commands(chosen.build, "_mote"):
        for own, other in ((own_headers, headers), ("python/CMakeFiles/", f"python/{tag}/"), ("python/libnanobind", f"python/{tag}/libnanobind"),
                           (own_module.name, module.name)):
            line = line.replace(str(own), str(other))
        if " -c " in line:
            line = line.replace(" -c ", f" -idirafter {shlex.quote(str(include))} -c ")
        for output in re.findall(r"-o (\S+)", line):
            (chosen.build / output).parent.mkdir(parents=True, exist_ok=True)
        (compiling if " -c " in line else linking).append(line)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(run, compiling))
    for line in linking:  # archive, then module
        run(line)
    with tempfile.TemporaryDirectory() as scratch:
        wheel = [sys.executable, "-m", "wheel"]
        subprocess.run([*wheel, "unpack", "-d", scratch, chosen.wheel], check=True, stdout=subprocess.DEVNULL)
        tree = next(Path(scratch).iterdir())
        next(tree.glob(f"mote/{own_module.name}")).unlink()
        (tree / "mote" / module.name).write_bytes(module.read_bytes())
        info = next(tree.glob("*.dist-info/WHEEL"))
        info.write_text(info.read_text(encoding="utf-8").replace(own_tag, tag), encoding="utf-8")
        subprocess.run([*wheel, "pack", "-d", chosen.folder, tree], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()
