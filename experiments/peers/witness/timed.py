"""Mitsuba at doubling samples, with times: the job of real_sizes/peer_runs.py, in DIR/job.json.

Loading and compiling come first and are stated apart (`build_s`), with a picture of one sample. Its pictures are DIR/N.npy;
each is the mean of renders of `samples_at_once` samples, which the compiled program renders in one go (a go of its own
takes some milliseconds to set up, and much memory where it is large).
"""
import json
import sys
from pathlib import Path

import drjit
import mitsuba as mi
import numpy as np
import renderers
from trade import Clock

sys.path.append(str(Path(__file__).resolve().parent.parent / "real_sizes"))
from doubling import next_passes  # noqa: E402


def picture(scene, samples, at_once, seed):
    """The mean over all samples."""
    total, done, parts = 0.0, 0, 0
    while done < samples:
        more = min(at_once, samples - done)
        total = total + more * renderers.mitsuba_picture(scene, more, seed + 65537 * parts).astype(float)
        done, parts = done + more, parts + 1
    return total / samples


def write_timed(folder):
    folder = Path(folder)
    job = json.loads((folder / "job.json").read_text())
    if mi.variant().startswith("llvm"):
        drjit.set_thread_count(job["threads"])
    start = Clock()
    scene = renderers.load_mitsuba(job["folder"])
    at_once = job["samples_at_once"]
    picture(scene, 1, at_once, 0)
    log = {"version": f"Mitsuba {mi.__version__} {mi.variant()}", "build_s": start.read()[0], "runs": [],
           "notes": [f"integrator {scene.integrator().class_name()}"]}
    samples = next_passes([], job["budget"])
    while samples:
        index = len(log["runs"])
        seed, clock = renderers.seed_list(1, offset=job["seed"] + index)[0], Clock()
        mean = picture(scene, samples, at_once, seed)
        wall, cpu = clock.read()
        np.save(folder / f"{index}.npy", mean.astype(np.float32))
        log["runs"].append({"passes": samples, "seed": seed, "wall_s": wall, "cpu_s": cpu, "file": f"{index}.npy"})
        samples = next_passes(log["runs"], job["budget"])
    (folder / "log.json").write_text(json.dumps(log, indent=1))
    return 0
