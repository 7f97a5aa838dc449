"""A suite of one scene whose truth is known, references with noise of known size, and submissions made of formulas."""
import json
import os
import sys
import tempfile
from pathlib import Path

MOTE, SOURCE = (sys.argv + ["", ""])[1:3]
if MOTE:
    os.environ["MOTE"] = MOTE
import numpy as np  # noqa: E402
from mote import Picture  # noqa: E402
from mote.benchmark import submission as manifest  # noqa: E402
from mote.benchmark.references import References, load  # noqa: E402
from mote.benchmark.suite import load_suite  # noqa: E402

WIDTH, HEIGHT, BUDGETS, SEEDS = 96, 64, [1, 4], 4


def scene(name, **more):
    return {"name": name, "title": name.title(), "tests": "Nothing.", "licence": "none", "file": "scene.xml", "width": WIDTH,
            "height": HEIGHT, "budgets": BUDGETS, "reference": {"integrator": "path", "passes": 64}, **more}


def suite_file(folder, scenes=("plain",), seeds=SEEDS):
    """Writes suite.json; returns the suite."""
    folder.mkdir(parents=True, exist_ok=True)
    content = {"format": 1, "name": "synthetic", "version": 1, "seeds": seeds, "targets": [0.1, 0.05],
               "quick": {"shrink": 1, "fewer_passes": 1, "seeds": 2, "budgets": [1]}, "scenes": [scene(n) for n in scenes]}
    (folder / "suite.json").write_text(json.dumps(content))
    (folder / "scene.xml").write_text("<scene/>")
    return load_suite(folder)


def textured(height=HEIGHT, width=WIDTH):
    """A truth that varies by a factor of ten, with edges."""
    y, x = np.mgrid[0:height, 0:width]
    grey = 0.2 + 0.15 * np.sin(x / 7.0) + 0.3 * (x // 8 + y // 8) % 2 + 1.5 * (x > 0.7 * width)
    return np.stack([grey, 0.8 * grey, 0.5 * grey + 0.1], axis=2)


def noisy(truth, noise, random, heavy=False):
    """truth with independent noise of that relative standard deviation in every channel; heavy: of rare bright samples, by a
    log-normal distribution of mean 1."""
    if heavy:
        s = np.sqrt(np.log(1 + noise**2))
        return (truth * np.exp(s * random.standard_normal(truth.shape) - 0.5 * s * s)).astype(np.float32)
    return (truth * (1 + noise * random.standard_normal(truth.shape))).astype(np.float32)


def write_references(folder, name, truth, noise, random, hidden=False):
    """NAME_a.exr, ... with layers that make the left half shadow and one column an edge."""
    folder.mkdir(parents=True, exist_ok=True)
    height, width = truth.shape[:2]
    left = np.arange(width) < width // 2
    share = np.where(left, 0.0, 1.0)[None, :, None]
    ids = np.ones((height, width), np.float32)
    ids[:, 3 * width // 4:] = 2
    for letter in "abcd" if hidden else "ab":
        picture = noisy(truth, noise, random)
        layers = {"beauty": picture, "direct": share * picture, "indirect": (1 - share) * picture, "ObjectId": ids}
        Picture(layers).save(folder / f"{name}_{letter}.exr")


def references(truth, noise, random, hidden=False):
    """The same in memory, with one region."""
    pictures = [noisy(truth, noise, random) for _ in range(4 if hidden else 2)]
    return References(*pictures[:2], {"all": np.ones(truth.shape[:2], bool)}, tuple(pictures[2:]) if hidden else None)


def write_submission(folder, suite, picture_of, **changes):
    """picture_of(scene, budget, seed) -> array. Returns the manifest's content, for damage."""
    pictures, clock = [], 1.7e9
    for s in suite.scenes:
        for budget in s.budgets:
            for seed in suite.seeds_of(s):
                file = f"{s.name}/{budget:g}/{seed}.exr"
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                Picture({"beauty": picture_of(s, budget, seed)}, {"seed": seed}).save(folder / file)
                pictures.append({"scene": s.name, "budget_s": budget, "seed": seed, "file": file, "passes": int(8 * budget),
                                 "wall_s": 0.9 * budget, "cpu_s": 1.7 * budget, "load_s": 0.1, "started": manifest.time_text(clock)})
                clock += 1.1 * budget
    content = {"format": 1, "suite": suite.label(), "method": "formula", "program": "formula", "version": "1", "settings": {},
               "kind": "raw", "noise": "independent", "unbiased": True, "repeatable": True,
               "machine": {"processor": "paper", "threads": 2}, "yardstick_s": [1.0, 1.01, 0.99, 1.0, 1.0], "pictures": pictures, **changes}
    manifest.write_manifest(folder, content)
    return content


def temporary():
    return tempfile.TemporaryDirectory(prefix="mote_benchmark_")


__all__ = ["MOTE", "SOURCE", "Path", "np", "load", "manifest", "noisy", "references", "scene", "suite_file", "temporary", "textured",
           "write_references", "write_submission", "BUDGETS", "SEEDS", "WIDTH", "HEIGHT"]
