#!/usr/bin/python3
"""Eye rays through media: one distance by chance, or scattering points and the surface behind them (mote_vpl).

Usage: scattering_points.py [--mote build/release/bin/mote] [--seeds N] [--passes N] [--size 96x60] [--points 0,1,2,4,8]
                            [--quick]
For the smoke room and the fog behind a grille: the variance of one pass, the square of the noise of
docs/testing.md, Eq. 4, relative to the beauty, layer by layer, times the counted work of a
pass and pixel (core/render/counted_work.h): less is better, and all settings have the same mean. Variances are those
between seeds, so that what pixels of a pass share counts; r is a picture of mote_layers, since weights by what is
measured itself would hide its outliers.
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
from exr import read_exr
from measure import counted_work, series_error, use

SCENES = ("smoke_room", "fog_grille")
LAYERS = ("", "single_scattering", "multiple_scattering_bounded", "direct", "indirect_bounded")


def run(args, scene, integrator, more, folder):
    exr, stats = folder / "p.exr", folder / "p.json"
    width, height = args.size.split("x")
    subprocess.run([args.mote, "render", ROOT / f"scenes/{scene}.xml", "--integrator", integrator, "-t", "1", "--quiet",
                    "-D", f"resx={width}", "-D", f"resy={height}", "-o", exr, "--stats", stats, *map(str, more)],
                   check=True)
    return read_exr(exr), json.loads(stats.read_text())


def render(args, scene, points, seed, folder):
    """The layers, the counted work of a pass and pixel, and seconds."""
    picture, s = run(args, scene, "mote_vpl", ["-D", f"integrator.paths={args.paths}", "-D",
                                               f"integrator.scattering_points={points}", "--passes", args.passes,
                                               "--seed", seed], folder)
    width, height = args.size.split("x")
    return picture, counted_work(s) / (args.passes * int(width) * int(height)), s["seconds"]["render"]


def measure(args, scene, points, reference, folder):
    pictures, works, seconds = zip(*(render(args, scene, points, s, folder) for s in range(1, args.seeds + 1)))
    variance = {layer: args.passes * series_error([p[layer] for p in pictures], [reference])["noise"] ** 2
                for layer in LAYERS if layer in pictures[0]}
    return variance, np.mean(works), np.mean(seconds) / args.passes


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=ROOT / "build/release/bin/mote")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--passes", type=int, default=2)
    parser.add_argument("--paths", type=int, default=64)
    parser.add_argument("--size", default="96x60")
    parser.add_argument("--points", default="0,1,2,4,8")
    parser.add_argument("--quick", action="store_true", help="tiny: numbers without a meaning")
    args = parser.parse_args()
    if args.quick:
        args.seeds, args.passes, args.paths, args.size, args.points = 2, 1, 8, "24x15", "0,1"
    use(Path(args.mote).parent)
    print("scene, points: variance of a pass by layer; work, seconds; variance x work, variance x seconds")
    with tempfile.TemporaryDirectory() as folder:
        for scene in SCENES:
            reference = run(args, scene, "mote_layers", ["--passes", 200], Path(folder))[0][""]
            for points in args.points.split(","):
                variance, work, seconds = measure(args, scene, points, reference, Path(folder))
                layers = ", ".join(f"{name or 'beauty'} {v:.3f}" for name, v in variance.items())
                print(f"{scene}, {points}: {layers}; {work:.0f}, {seconds:.2f}; {variance[''] * work:.0f}, "
                      f"{variance[''] * seconds:.3f}", flush=True)


if __name__ == "__main__":
    main()
