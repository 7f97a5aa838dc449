#!/usr/bin/env python3
"""Runs the commands that README.md, docs/guide.md and docs/howto/trade.md print, in their order, in a folder of their own.

A command is a line of a block without a language that begins with one of COMMANDS. Placeholders (SCENE) and what other tests run are left
out, by OTHERS. Images are small and renders have few passes unless MOTE_PAGES_SMALL=0: a program `mote` that stands before the built one on
the PATH sees to that, so the lines are run as they are printed.

    run_commands.py MOTE ROOT [PYTHON] [--list]

PYTHON: an interpreter that has the module mote; without it what begins with python is left out.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PAGES = ("README.md", "docs/guide.md", "docs/howto/trade.md")
COMMANDS = ("mote ", "scenes/generate", "python -c")
OTHERS = {
    "mote view": "tests/viewer",
    "mote trade scenes/smoke_room.xml": "takes its time with every method that suits the scene",
}
PLACEHOLDER = re.compile(r"(?<![-\w])[A-Z]{2,}\b|\b[A-Z]\.exr|\.\.\.|(?<![\w/.])(?:scene|[ab])\.\w+|^mote \w+,")
BLOCK = re.compile(r"^```\n(.*?)^```$", re.DOTALL | re.MULTILINE)
SECONDS = 600
SMALL = """#!{python}
import os, sys
a = sys.argv[1:]
if os.environ.get("MOTE_PAGES_SMALL", "1") != "0" and a and a[0] in ("render", "trade", "ssbc"):
    sized = any(x.startswith(("film.", "resx")) for x in a)
    if any(x.endswith(".xml") for x in a) and not sized and a[0] != "trade":
        a += ["-D", "film.width=48", "-D", "film.height=30"]
    for option, most in (("--passes", 4), ("--time", 3), ("--seeds", 2)):
        for i in (i for i, x in enumerate(a) if x == option):
            a[i + 1] = str(min(most + ("--resume" in a), int(a[i + 1])))
    for i in (i for i, x in enumerate(a) if x == "--resolve"):
        a[i + 1] = "0.2"
    if a[0] == "render" and not {{"--passes", "--time", "--noise"}} & set(a):
        a += ["--passes", "2"]
    if a[0] == "trade" and "--make-reference" not in a and "--time" not in a and "--redraw" not in a:
        a += ["--time", "2", "--fresh"]
os.execv({mote!r}, [{mote!r}, *a])
"""


def commands(text):
    """Lines of the blocks; a backslash joins a line to the next, comments and what a page says behind several spaces are no part of it."""
    for block in BLOCK.findall(text):
        for line in re.sub(r"\\\n\s*", "", block).split("\n"):
            line = re.sub(r"\s{2,}(?!-).*$| +# .*$", "", line)
            if line.startswith(COMMANDS) and not PLACEHOLDER.search(line):
                yield line


def left_out(line):
    return next((why for beginning, why in OTHERS.items() if line.startswith(beginning)), None)


def run(line, folder, environment):
    done = subprocess.run(["bash", "-c", line], cwd=folder, env=environment, capture_output=True, text=True, timeout=SECONDS, check=False)
    if done.returncode and "OpenImageDenoise" in done.stderr:
        print(f"LEFT OUT {line}: OpenImageDenoise is not installed")
        return True
    if done.returncode:
        print(f"FAILED ({done.returncode}) {line}\n{done.stdout[-600:]}{done.stderr[-1200:]}")
    return done.returncode == 0


def copy_scenes(programs, root, folder):
    """The scenes without what is generated, but for a small grid of smoke, which scenes/generate then leaves as it is."""
    shutil.copytree(root / "scenes", folder / "scenes", ignore=shutil.ignore_patterns("generated"))
    (folder / "build/release").mkdir(parents=True)
    (folder / "build/release/bin").symlink_to(programs)
    if os.environ.get("MOTE_PAGES_SMALL", "1") != "0":
        (folder / "scenes/generated").mkdir()
        subprocess.run([programs / "mote_smoke", "-o", folder / "scenes/generated/smoke.vdb", "--size", "25", "18", "31", "--cell", "0.16", "--steps", "20",
                        "--haze", "0.012", "--source", "0.7", "0.1", "0.37", "--source-radius", "0.22", "--buoyancy", "4"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main(mote, root):
    failed, count = 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        folder, programs = Path(scratch) / "tree", Path(scratch) / "bin"
        (folder / "out").mkdir(parents=True)
        programs.mkdir()
        for name in ("experiments", "examples", "docs"):
            (folder / name).symlink_to(root / name)
        copy_scenes(mote.parent, root, folder)
        (programs / "mote").write_text(SMALL.format(python=sys.executable, mote=str(mote)), encoding="utf-8")
        (programs / "mote").chmod(0o755)
        python = next((a for a in sys.argv[3:] if not a.startswith("--")), None)
        if python:
            (programs / "python").write_text(f'#!/bin/sh\nexec {python} "$@"\n', encoding="utf-8")
            (programs / "python").chmod(0o755)
        module = mote.parent.parent / "python"
        environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}", "PYTHONPATH": str(module), "MOTE": str(mote)}
        for page in PAGES:
            for line in commands((root / page).read_text(encoding="utf-8")):
                why = left_out(line) or ("there is no Python with the module" if line.startswith("python") and not python else None)
                if why:
                    print(f"not run, {why}: {line}")
                    continue
                count += 1
                print(f"{page}: {line}", flush=True)
                if "--list" not in sys.argv:
                    failed += not run(line, folder, environment)
        strangers = [str(p.relative_to(folder)) for p in folder.iterdir() if p.name not in ("scenes", "experiments", "examples", "docs", "build", "out", "box.exr") and "trade" not in p.name]
        if strangers:
            print(f"written beside out/: {', '.join(strangers)}")
            failed += 1
    print(f"{count} commands, {failed} failed")
    return 1 if failed or not count else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()))
