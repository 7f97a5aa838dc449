#!/usr/bin/env python3
"""Installs the add-on's .zip into a private Blender and lets in_blender.py render with it; then a render is cancelled.

Usage: test_addon.py MOTE SOURCE
Where there is no Blender it prints LEFT OUT and succeeds.
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


def start(blender, mote, folder, archive, what):
    environment = {**os.environ, "PATH": PATH, "MOTE_COMMAND": mote, "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
                   "BLENDER_USER_CONFIG": str(folder / "config")}
    return subprocess.Popen([blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                             str(HERE / "in_blender.py"), "--", what, str(archive), str(folder)],
                            env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def finish(process, word, code=0):
    words = process.communicate(timeout=400)[0]
    if process.returncode != code or word not in words:
        sys.exit(f"Blender ended with {process.returncode}, and should have said '{word}':\n{words}")
    print("\n".join(line for line in words.splitlines() if line.startswith("checked:")))


def cancel(process):
    """Ctrl-C after the first passes of far more than there is time for; the engine has seconds to come back."""
    for line in process.stdout:
        if "| pass " in line:
            break
    process.send_signal(signal.SIGINT)
    began = time.monotonic()
    finish(process, "checked: cancel", code=1)  # Blender ends with 1 after any Ctrl-C
    print(f"checked: cancelled within {time.monotonic() - began:.1f} s, Blender's end included")
    if time.monotonic() - began > 10:  # what the add-on waits before it ends the process by force
        sys.exit("a cancelled render went on")


def main():
    mote, source = sys.argv[1], Path(sys.argv[2])
    blender = shutil.which("blender", path=PATH)
    if blender is None:
        return print("LEFT OUT: the Blender add-on is not tested: no 'blender' on the path")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scripts" / "addons").mkdir(parents=True)
        page = folder / "formats.md"
        page.write_text(subprocess.run([mote, "formats"], check=True, capture_output=True, text=True).stdout)
        archive = folder / "mote_render.zip"
        subprocess.run([sys.executable, "-B", str(source / "plugins" / "blender" / "make_zip.py"), str(archive), str(page)],
                       check=True)
        finish(start(blender, mote, folder, archive, "pictures"), "checked: all")
        cancel(start(blender, mote, folder, archive, "cancel"))
    return None


main()
