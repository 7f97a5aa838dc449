#!/usr/bin/env python3
"""Installs the add-on's .zip into a private Blender and lets in_blender.py render with it; then a render is cancelled.

Usage: test_addon.py MOTE SOURCE [BPY_PYTHON]
Blender is the program on the path, and the module `bpy` where a Python has it: that of MOTE_BPY_PYTHON, else BPY_PYTHON
(what tools/install_bpy.sh makes), else the one that runs this. Nothing is downloaded. Each that is there is tested;
where there is neither it prints LEFT OUT and succeeds.
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Blender takes the first Python of the path for its own, which then has to be the system's.
PATH = os.pathsep.join(["/usr/bin", "/bin", os.environ.get("PATH", "")])


def blenders(built):
    """By name: the words before the script's own, for each Blender that is here."""
    found = {}
    blender = shutil.which("blender", path=PATH)
    if blender:
        found["blender"] = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python"]
    for python in (os.environ.get("MOTE_BPY_PYTHON"), built, sys.executable):
        if python and shutil.which(python) and not subprocess.run(
                [python, "-c", "import importlib.util as u, sys; sys.exit(u.find_spec('bpy') is None)"], check=False).returncode:
            found["bpy"] = [python, "-B"]
            break
        if python and python == os.environ.get("MOTE_BPY_PYTHON"):
            sys.exit(f"MOTE_BPY_PYTHON names '{python}', which has no module bpy")
    return found


def in_window(words):
    """The program in a window of a virtual display, by software; None where there is no such thing."""
    display = shutil.which("xvfb-run", path=PATH)
    if "-b" not in words or not display:
        return None
    return [display, "-a", "-s", "-screen 0 1280x800x24", words[0], "--factory-startup", "--python"]


def start(words, mote, folder, archive, what):
    environment = {**os.environ, "PATH": PATH, "MOTE_COMMAND": mote, "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
                   "BLENDER_USER_CONFIG": str(folder / "config"), "PYTHONUNBUFFERED": "1", "LIBGL_ALWAYS_SOFTWARE": "1"}
    return subprocess.Popen([*words, str(HERE / "in_blender.py"), "--", what, str(archive), str(folder)],
                            env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def finish(process, word, codes=(0,)):
    words = process.communicate(timeout=400)[0]
    if process.returncode not in codes or word not in words:
        sys.exit(f"Blender ended with {process.returncode}, and should have said '{word}':\n{words}")
    print("\n".join(line for line in words.splitlines() if line.startswith("checked:")))


def cancel(process):
    """Ctrl-C after the first passes of far more than there is time for; the engine has seconds to come back."""
    for line in process.stdout:
        if "| pass " in line:
            break
    process.send_signal(signal.SIGINT)
    began = time.monotonic()
    finish(process, "checked: cancel", codes=(0, 1))  # the program ends with 1 after any Ctrl-C
    print(f"checked: cancelled within {time.monotonic() - began:.1f} s, Blender's end included")
    if time.monotonic() - began > 10:  # what the add-on waits before it ends the process by force
        sys.exit("a cancelled render continued")


def test(words, mote, source):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scripts" / "addons").mkdir(parents=True)
        page = folder / "formats.md"
        page.write_text(subprocess.run([mote, "formats"], check=True, capture_output=True, text=True).stdout)
        archive = folder / "mote_render.zip"
        subprocess.run([sys.executable, "-B", str(source / "plugins" / "blender" / "make_zip.py"), str(archive), str(page)],
                       check=True)
        for what in ("pictures", "parts", "live"):
            finish(start(words, mote, folder, archive, what), "checked: all")
        cancel(start(words, mote, folder, archive, "cancel"))
        window = in_window(words)
        if window:
            finish(start(window, mote, folder, archive, "window"), "checked: all")
        else:
            print("LEFT OUT: the viewport in a window: no 'blender' or no 'xvfb-run' on the path")


def main():
    mote, source, built = sys.argv[1], Path(sys.argv[2]), sys.argv[3] if len(sys.argv) > 3 else ""
    found = blenders(built)
    for name, words in found.items():
        print(f"{name}:", flush=True)
        test(words, mote, source)
    missing = {"blender": "no 'blender' on the path", "bpy": "no Python has the module; tools/install_bpy.sh makes one"}
    for name, how in missing.items():
        if name not in found:
            print(f"LEFT OUT: the Blender add-on is not tested in {name}: {how}")


main()
