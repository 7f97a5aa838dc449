"""Scenes of experiments/studies/blender_agreement_scenes.py rendered by Cycles and by mote: means, standard errors, and
processor time to equal error."""
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from exr import read_exr
from origin import ROOT

SCENES = {"room": "diffuse room, area lamp", "sun": "principled and glossy ball, sun and sky", "fog": "a cube of fog in the room",
          "table": "glass, a picture, smoke of a .vdb file"}
PATH = os.pathsep.join(["/usr/bin", "/bin", os.environ["PATH"]])  # Blender needs the system's Python


def blender(python=None):
    """The words before a script of Blender's: the program, or the module bpy of a Python. None where there is neither."""
    if python:
        return [str(python), "-B"]
    found = shutil.which("blender", path=PATH)
    return [found, "-b", "--factory-startup", "--python-exit-code", "1", "--python"] if found else None


def run(words, mote, folder, width, samples, seeds, scenes=tuple(SCENES)):
    """Renders into `folder`; by scene and engine the pictures [seeds, height, width, 3] and processor seconds a picture, and
    what the add-on approximated."""
    (folder / "scripts" / "addons").mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, str(ROOT / "plugins" / "blender" / "make_zip.py"), str(folder / "addon.zip")], check=True,
                   stdout=subprocess.DEVNULL)
    environment = {**os.environ, "PATH": PATH, "MOTE_COMMAND": str(Path(mote).resolve()),
                   "BLENDER_USER_SCRIPTS": str(folder / "scripts"), "BLENDER_USER_CONFIG": str(folder / "config")}
    script = ROOT / "experiments" / "studies" / "blender_agreement_scenes.py"
    done = subprocess.run([*words, str(script), "--", str(folder / "addon.zip"), str(folder),
                           str(ROOT / "scenes" / "generated" / "smoke.vdb"), str(width), str(samples), str(seeds), *scenes],
                          env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return {scene: log_of(folder, scene) for scene in scenes}


def log_of(folder, scene):
    log = json.loads((folder / f"{scene}.json").read_text())
    found = {"notes": log["notes"].splitlines()}
    for engine, name in (("CYCLES", "Cycles"), ("MOTE", "mote")):
        runs = [r for r in log["runs"] if r["engine"] == engine]
        found[name] = {"pictures": np.stack([read_exr(folder / r["file"])[""] for r in runs]),
                       "seconds": sum(r["cpu_s"] for r in runs) / len(runs)}
    return found


def agreement(log):
    """Agreement on one scene: both means, their relative difference and its standard error, seconds an image, and the
    ratio of the times to equal error (variance of a pixel between seeds times seconds), Cycles' over mote's."""
    means = {name: log[name]["pictures"].mean(axis=(1, 2, 3)) for name in ("Cycles", "mote")}
    mean = {name: m.mean() for name, m in means.items()}
    error = sum(m.var(ddof=1) / len(m) for m in means.values())**0.5 / mean["Cycles"]
    cost = {name: log[name]["pictures"].var(axis=0, ddof=1).mean() * log[name]["seconds"] for name in means}
    return {"cycles_mean": mean["Cycles"], "mote_mean": mean["mote"], "difference": mean["mote"] / mean["Cycles"] - 1,
            "standard_error": error, "cycles_seconds": log["Cycles"]["seconds"], "mote_seconds": log["mote"]["seconds"],
            "equal_error": cost["Cycles"] / cost["mote"]}
