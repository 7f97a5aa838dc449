#!/usr/bin/python3
"""OpenImageDenoise by qualities: error of a denoised path tracer, and processor seconds, with features and colour at high,
balanced and fast quality.

    denoiser_quality.py -o FOLDER [--quick]      table quality.csv; needs pyoidn

Two references a scene as for experiments/trade/run --peers, in MOTE_REFERENCES; --quick: one scene at 80 x 50, with its own.
"""
import argparse
import csv
import os
import resource
import sys
from pathlib import Path

import numpy as np
import pyoidn

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "experiments" / part) for part in ("peers/real_sizes", "peers/witness", "figures")]
import measure  # noqa: E402
from exr import _exr_file  # noqa: E402
from mote_runs import Mote, beauty_and_variance, found_references  # noqa: E402
from oidn import filtered  # noqa: E402
from origin import commit  # noqa: E402
from times import References  # noqa: E402

SCENES = {"cornell_box": "path", "smoke_room": "volpath", "atrium": "volpath", "fog_grille": "volpath"}
QUALITIES = {"high": pyoidn.OIDN_QUALITY_HIGH, "balanced": pyoidn.OIDN_QUALITY_BALANCED, "fast": pyoidn.OIDN_QUALITY_FAST}
CHOICES = [("high", "high"), ("balanced", "high"), ("balanced", "balanced"), ("fast", "fast")]  # of features, of colour


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def denoised(device, picture, of_features, of_colour):
    """The picture, and the processor seconds that it took."""
    before = processor_seconds()
    clean = {name: filtered(device, {name: picture[name]}, QUALITIES[of_features]) for name in ("albedo", "normal")}
    result = filtered(device, {"color": picture["color"], **clean}, QUALITIES[of_colour], hdr=True, cleanAux=True)
    return result, processor_seconds() - before


def read_picture(path):
    """Radiance, albedo and normals of a render with --auxiliary."""
    planes = _exr_file.read_exr(path)
    stack = lambda names: np.stack([planes[n] for n in names], axis=2).astype(np.float32)
    return {"color": stack("RGB"), "albedo": np.clip(stack([f"Albedo.{c}" for c in "RGB"]), 0, 1),
            "normal": stack([f"Ns.{c}" for c in "XYZ"])}


def references_of(mote, scene, folder, quick):
    if not quick:
        files = found_references(os.environ.get("MOTE_REFERENCES", str(ROOT / "out/references")).split(os.pathsep), scene)
        if None in files:
            raise SystemExit(f"{scene}: no references; experiments/trade/run --peers --references makes them")
    else:
        files = [folder / f"{scene}_{letter}.exr" for letter in "ab"]
        for seed, file in enumerate(files):
            mote.render(file, SCENES[scene], {}, "--passes", 400, seed=100 + seed)
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("-o", dest="folder", type=Path, default=ROOT / "out" / "denoiser_quality")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--mote", default=os.environ.get("MOTE", str(ROOT / "build/release/bin/mote")))
    options = parser.parse_args()
    measure.use(Path(options.mote).parent)
    options.folder.mkdir(parents=True, exist_ok=True)
    device = pyoidn.Device()
    device.commit()
    rows = []
    for scene in list(SCENES)[:1] if options.quick else SCENES:
        mote = Mote(options.mote, ROOT / "scenes" / f"{scene}.xml", ["resx=80", "resy=50", "film.rfilter=box"], 2)
        images, variances = zip(*map(beauty_and_variance, references_of(mote, scene, options.folder, options.quick)))
        references = References(images, variances)
        mote.sizes[:2] = [f"resx={images[0].shape[1]}", f"resy={images[0].shape[0]}"]
        for passes in (1, 8):
            path = options.folder / f"{scene}_{passes}.exr"
            mote.render(path, SCENES[scene], {}, "--passes", passes, "--auxiliary", seed=0)
            for choice in CHOICES:
                image, seconds = denoised(device, read_picture(path), *choice)
                rows.append([scene, passes, *choice, f"{references.series_error([image])['error']:.4g}", f"{seconds:.3g}"])
                print(*rows[-1], flush=True)
    with open(options.folder / "quality.csv", "w", newline="", encoding="utf-8") as file:
        file.write(f"# Script: experiments/studies/denoiser_quality.py\n# Commit: {commit()}\n"
                   f"# Run: {'quick' if options.quick else 'full'}\n")
        csv.writer(file).writerows([["scene", "passes", "features", "colour", "error", "cpu_s"], *rows])


if __name__ == "__main__":
    main()
