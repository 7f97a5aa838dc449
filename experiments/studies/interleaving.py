#!/usr/bin/python3
"""Virtual point lights in image space (mote_vpl): interleaving, the filter, and upsampling: error against counted work, and bias.

Usage: interleaving.py [--mote build/release/bin/mote] [--seeds N] [--reference PASSES] [--scale N] [--quick]
For the smoke room and the Cornell box, with the same bounded lights throughout: squared relative RMSE (measure.py) against a
long render without either, whose own noise is taken off, counted work of a pixel
(core/render/counted_work.h) and processor seconds of a picture, their products, and the signed bias of the mean over seeds.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
import measure
from exr import read_exr

SCENES = {"smoke_room": (64, 40), "cornell_box": (56, 56)}
# name, settings, passes
METHODS = [("n = 1", {}, 4), ("n = 1, filter", {"filter": "true"}, 4),
           ("n = 2", {"interleaving": 2}, 12), ("n = 2, filter", {"interleaving": 2, "filter": "true"}, 12),
           ("n = 4", {"interleaving": 4}, 32), ("n = 4, filter", {"interleaving": 4, "filter": "true"}, 32),
           ("upsampling 2", {"upsampling": 2}, 12), ("upsampling 4", {"upsampling": 4}, 24),
           ("upsampling 4, filter", {"upsampling": 4, "filter": "true"}, 24)]


def render(args, scene, settings, passes, seed, folder):
    exr, stats = folder / "p.exr", folder / "p.json"
    width, height = (args.scale * n for n in SCENES[scene])
    settings = {"paths": 64, "bound": 20, **settings}
    defines = [x for k, v in settings.items() for x in ("-D", f"integrator.{k}={v}")]
    subprocess.run([args.mote, "render", ROOT / f"scenes/{scene}.xml", "--integrator", "mote_vpl", "-t", "1", "--quiet",
                    "-D", f"resx={width}", "-D", f"resy={height}", "--passes", str(passes), "--seed", str(seed), *defines,
                    "-o", exr, "--stats", stats], check=True)
    s = json.loads(stats.read_text())
    return read_exr(exr), measure.counted_work(s) / (width * height), s["seconds"]["render"] + s["seconds"].get("finish", 0)


def study(args, scene, folder):
    long, _, _ = render(args, scene, {}, args.reference, 99, folder)
    for name, settings, passes in METHODS:
        pictures, works, seconds = zip(*(render(args, scene, settings, passes, s, folder) for s in range(1, args.seeds + 1)))
        found = measure.series_error([p[""] for p in pictures], [long[""]], variances=[long["Variance"]])
        error, work, time = found["squared_error"], np.mean(works), np.mean(seconds)
        print(f"{scene}, {name}, {passes} passes: error^2 {error:.4f}; work {work:.0f}, {time:.1f} s; error^2 x work "
              f"{error * work:.1f}, x s {error * time:.4f}; bias {found['bias']:+.2%} +- "
              f"{found['bias_standard_error']:.2%}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=ROOT / "build/release/bin/mote")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--reference", type=int, default=200)
    parser.add_argument("--scale", type=int, default=1, help="pictures so many times as wide and high")
    parser.add_argument("--quick", action="store_true", help="tiny: numbers without a meaning")
    args = parser.parse_args()
    if args.quick:
        args.seeds, args.reference = 2, 4
    measure.use(Path(args.mote).parent)
    with tempfile.TemporaryDirectory() as folder:
        for scene in list(SCENES)[-1 if args.quick else 0 :]:
            study(args, scene, Path(folder))


if __name__ == "__main__":
    main()
