"""Mitsuba 3 (experiments/peers/mitsuba.py): "denoise" by OpenImageDenoise."""
import os
import subprocess
import sys

from _peer import ROOT, Peer

FIND = ("import importlib.util as u, sys; sys.exit(0 if u.find_spec('mitsuba') and u.find_spec('numpy') else 1)")


def python_with_mitsuba():
    """This Python, that of MOTE_MITSUBA_PYTHON, or build/mitsuba_env's; None where none has it."""
    for python in (sys.executable, os.environ.get("MOTE_MITSUBA_PYTHON"), str(ROOT / "build" / "mitsuba_env" / "bin" / "python")):
        if python and os.access(python, os.X_OK) and subprocess.run([python, "-c", FIND], check=False, capture_output=True).returncode == 0:
            return python
    return None


class Renderer(Peer):
    program = "mitsuba"

    def missing(self):
        if python_with_mitsuba():
            return ""
        return "Mitsuba 3 is not installed (experiments/peers/mitsuba.py --install, or MOTE_MITSUBA_PYTHON)"

    def version(self):
        if not self._version:
            done = subprocess.run([python_with_mitsuba(), "-c", "import mitsuba; print(mitsuba.__version__)"], capture_output=True,
                                  text=True, check=True)
            self._version = f"Mitsuba {done.stdout.strip()}"
        return self._version
