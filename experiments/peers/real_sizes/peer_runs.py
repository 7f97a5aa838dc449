"""Pictures by other renderers, each in a process of its own that says what it measured in a log.json.

Both read the scene that `mote export --to mitsuba3` writes. `None` represents a peer that is not installed.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from exr import read_exr

PEERS = Path(__file__).resolve().parent.parent
BPY_ENVIRONMENT = PEERS.parent.parent / "build" / "bpy_env"
HANGS = 3600  # seconds after which a program is ended: Mitsuba's threads have been seen to wait for each other
sys.path.insert(0, str(PEERS / "cycles"))
from flat_scene import vdb_volumes  # noqa: E402
from tight_boundaries import tighten  # noqa: E402


def export(mote, integrator, folder):
    """The scene for Mitsuba; what was dropped or changed, but for the sampler."""
    words = [part for word in mote.sizes for part in ("-D", word)]
    done = subprocess.run([mote.program, "export", mote.scene, "--to", "mitsuba3", "--integrator", integrator, "-o",
                           folder, *words], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    text = (Path(folder) / "dropped.txt").read_text().replace(f"{Path(mote.scene).parent}/", "")
    dropped = text.splitlines()
    return [line for line in dropped if "sampler" not in line] + tighten(Path(folder))


def run_mitsuba(mote, settings, exported, folder, budget, seed):
    job = {"folder": str(exported), "budget": budget, "seed": seed, "threads": mote.threads,
           "samples_at_once": settings["samples_at_once"], "denoise": settings["denoise"]}
    command = [sys.executable, str(PEERS / "mitsuba.py"), "--variant", settings["variant"], "--timed", str(folder)]
    return run(command, job, folder)


def run_cycles(mote, settings, exported, folder, budget, seed):
    python = python_with_bpy()
    if python is None:
        return None
    job = {**settings, "folder": str(exported), "vdb": vdb_volumes(mote.scene), "output": str(folder),
           "budget": budget, "seed": seed, "threads": mote.threads}
    return run([python, str(PEERS / "cycles" / "render.py"), str(folder / "job.json")], job, folder)


def python_with_bpy():
    """That of MOTE_CYCLES_PYTHON, or build/bpy_env's (tools/install_bpy.sh 5.0.1 build/bpy_env); None where neither is there."""
    for python in (os.environ.get("MOTE_CYCLES_PYTHON"), BPY_ENVIRONMENT / "bin/python"):
        if python and os.access(python, os.X_OK):
            return str(python)
    return None


RUNS = {"mitsuba": run_mitsuba, "cycles": run_cycles}


def run_peer(peer, mote, settings, *rest):
    """The log of one of settings["peers"], or None where its program is not installed."""
    return RUNS[peer["program"]](mote, {**settings[peer["program"]], **peer}, *rest)


def pictures(folder, log):
    """Images of any program's log, in its order: arrays [height, width, 3]."""
    for run_ in log["runs"]:
        path = folder / run_["file"]
        yield np.load(path) if path.suffix == ".npy" else read_exr(path)[run_.get("layer", "")]


def run(command, job, folder, environment=None):
    """The log that the process leaves, or None where it says that its program is not installed by leaving none."""
    folder.mkdir(parents=True, exist_ok=True)
    log = folder / "log.json"
    log.unlink(missing_ok=True)
    (folder / "job.json").write_text(json.dumps(job, indent=1))
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, timeout=HANGS)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {done.stderr.strip()[-2000:]}")
    return json.loads(log.read_text()) if log.is_file() else None
