#!/usr/bin/env python3
"""The same scene of Blender in Cycles and in mote: means with standard errors, and processor time to equal error.

    python3 experiments/studies/blender_agreement.py MOTE [SAMPLES [SEEDS]]

Each engine renders SEEDS pictures of SAMPLES samples a pixel. The standard error is that of the mean over seeds. Time
to equal error: variance of a pixel between seeds, averaged over the picture, times processor seconds a picture (export and
loading included); the ratio is Cycles' over mote's. It falls with
SAMPLES for mote, whose process starts and loads anew for every picture.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "figures"))
from exr import read_exr  # noqa: E402

SCENES = ("room", "sun", "fog")


def measure(folder, runs):
    """Mean of the picture, its standard error, and variance times processor seconds."""
    pictures = np.stack([read_exr(folder / run["file"])[""] for run in runs])
    means = pictures.mean(axis=(1, 2, 3))
    seconds = sum(run["cpu_s"] for run in runs) / len(runs)
    return means.mean(), means.std(ddof=1) / len(means)**0.5, pictures.var(axis=0, ddof=1).mean() * seconds, seconds


def main():
    mote, samples, seeds = [*sys.argv[1:], *("64", "8")[len(sys.argv) - 2:]]
    path = os.pathsep.join(["/usr/bin", "/bin", os.environ["PATH"]])  # Blender needs the system's Python
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scripts" / "addons").mkdir(parents=True)
        subprocess.run([sys.executable, str(HERE.parents[1] / "plugins" / "blender" / "make_zip.py"),
                        str(folder / "addon.zip")], check=True, stdout=subprocess.DEVNULL)
        environment = {**os.environ, "PATH": path, "MOTE_COMMAND": str(Path(mote).resolve()),
                       "BLENDER_USER_SCRIPTS": str(folder / "scripts"), "BLENDER_USER_CONFIG": str(folder / "config")}
        done = subprocess.run([shutil.which("blender", path=path), "-b", "--factory-startup", "--python-exit-code", "1",
                               "--python", str(HERE / "blender_agreement_scenes.py"), "--", str(folder / "addon.zip"),
                               str(folder), samples, seeds, *SCENES], env=environment, capture_output=True, text=True)
        if done.returncode:
            sys.exit(done.stdout + done.stderr)
        print("| scene | Cycles | mote | difference | standard error | processor s | time to equal error |\n" + "|---" * 7 + "|")
        notes = []
        for scene in SCENES:
            log = json.loads((folder / f"{scene}.json").read_text())
            cycles, ours = (measure(folder, [r for r in log["runs"] if r["engine"] == e]) for e in ("CYCLES", "MOTE"))
            error = (cycles[1]**2 + ours[1]**2)**0.5 / cycles[0]
            print(f"| {scene} | {cycles[0]:.5f} | {ours[0]:.5f} | {100 * (ours[0] / cycles[0] - 1):+.2f} % | {100 * error:.2f} % "
                  f"| {cycles[3]:.2f}, {ours[3]:.2f} | {cycles[2] / ours[2]:.2f} |")
            notes += [f"{scene}: {line}" for line in log["notes"].splitlines()]
        print("\n".join(notes))


main()
