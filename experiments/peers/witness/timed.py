"""Mitsuba at doubling samples, with times: the job of real_sizes/peer_runs.py, in DIR/job.json.

Loading and compiling come first and are stated apart (`build_s`), with a picture of one sample. Its pictures are DIR/N.npy;
each is the mean of renders of `samples_at_once` samples, which the compiled program renders in one go (a go of its own
takes some milliseconds to set up, and much memory where it is large). With `denoise` each is denoised by OpenImageDenoise.
"""
import importlib.util
import json
import sys
import time
from pathlib import Path

import drjit
import mitsuba as mi
import numpy as np
import renderers
from trade import Clock

sys.path.append(str(Path(__file__).resolve().parent.parent / "real_sizes"))
from doubling import next_passes  # noqa: E402


def with_features(scene):
    """The scene's integrator, which also sees albedo and shading normals."""
    return mi.load_dict({"type": "aov", "aovs": "albedo:albedo,normal:sh_normal", "image": scene.integrator()})


def picture(scene, integrator, samples, at_once, seed):
    """The mean over all samples: radiance, and albedo and normals where the integrator sees them [height, width, 3 or 9]."""
    total, done, parts = 0.0, 0, 0
    while done < samples:
        more = min(at_once, samples - done)
        image = np.array(mi.render(scene, integrator=integrator, spp=more, seed=(seed + 65537 * parts) % 2**32))
        total = total + more * image.astype(float)
        done, parts = done + more, parts + 1
    return (total / samples).astype(np.float32)


def write_timed(folder):
    folder = Path(folder)
    job = json.loads((folder / "job.json").read_text())
    if job["denoise"] and not importlib.util.find_spec("pyoidn"):
        return 0
    if mi.variant().startswith("llvm"):
        drjit.set_thread_count(job["threads"])
    start = Clock()
    scene = renderers.load_mitsuba(job["folder"])
    at_once = job["samples_at_once"]
    integrator = with_features(scene) if job["denoise"] else scene.integrator()
    finish = lambda image: image[..., :3]
    if job["denoise"]:
        from oidn import denoised as finish
    finish(picture(scene, integrator, 1, at_once, 0))
    log = {"version": f"Mitsuba {mi.__version__} {mi.variant()}", "build_s": start.read()[0], "runs": [],
           "notes": [f"integrator {scene.integrator().class_name()}"]}
    samples = next_passes([], job["budget"])
    while samples:
        index = len(log["runs"])
        seed, clock, started = renderers.seed_list(1, offset=job["seed"] + index)[0], Clock(), time.time()
        mean = finish(picture(scene, integrator, samples, at_once, seed))
        wall, cpu = clock.read()
        np.save(folder / f"{index}.npy", mean)
        log["runs"].append({"passes": samples, "seed": seed, "started": started, "wall_s": wall, "cpu_s": cpu, "file": f"{index}.npy"})
        samples = next_passes(log["runs"], job["budget"])
    (folder / "log.json").write_text(json.dumps(log, indent=1))
    return 0
