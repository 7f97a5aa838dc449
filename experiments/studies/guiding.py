#!/usr/bin/python3
"""Guided paths against unguided ones: variance times time, training included.

Usage: guiding.py [--mote build/release/bin/mote] [--seconds 120] [--seeds 4] [--size 320x200] [--scenes NAME,...]
                  [--guiding on|automatic] [--threads N] [--set NAME=VALUE ...] [--quick]
Every scene is rendered for the same time with `guiding` off and on (--set adds settings of the guided renders), with
several seeds. The variance is that between seeds, relative and weighted as the error of docs/testing.md, Eq. 1, with the mean
of 9 x 9 pixels in the weight: a bright path in a pixel's own mean would hide the variance that it makes. `trimmed` leaves
out the hundredth of pixels with most of it, where a bright path decides. A gain above 1: guiding pays. The last
columns are the share of the time that training took, and of the renders that were guided. Run it on an idle machine.
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

FIGURES = "experiments/figures/scenes"
SCENES = {"smoke_room": "scenes/smoke_room.xml", "atrium": "scenes/atrium.xml", "fog": f"{FIGURES}/glass_in_fog.xml",
          "fog_grille": "scenes/fog_grille.xml", "city": "scenes/city.xml", "door_ajar": f"{FIGURES}/door_ajar.xml",
          "lamp_shade": f"{FIGURES}/lamp_shade.xml", "cornell_box": "scenes/cornell_box.xml",
          "cloud": "scenes/cloud.xml", "bunny_room": f"{FIGURES}/bunny_room.xml"}


def render(args, scene, seed, settings, folder):
    """The picture, and its seconds."""
    exr, stats = folder / "p.exr", folder / "p.json"
    width, height = args.size.split("x")
    defined = [f"resx={width}", f"resy={height}", *settings]
    stop = ["--passes", args.passes] if args.passes else ["--time", args.seconds]
    threads = ["--threads", args.threads] if args.threads else []
    subprocess.run([args.mote, "render", ROOT / SCENES[scene], "--integrator", "volpath", "--quiet", "--seed", seed, *threads,
                    *(word for d in defined for word in ("-D", d)), *stop, "-o", exr, "--stats", stats],
                   check=True)
    return read_exr(exr)[""], json.loads(stats.read_text())


def measure(args, scene, settings, folder):
    """Pictures, mean seconds of one, mean passes, the share of time that training took, and of guided renders."""
    pictures, seconds, passes, training, guided = [], [], [], [], []
    for seed in range(1, args.seeds + 1):
        picture, stats = render(args, scene, str(seed), settings, folder)
        taken = stats["seconds"]
        pictures.append(picture)
        seconds.append(taken["build"] + taken["render"])
        passes.append(stats["passes"])
        training.append(taken.get("guiding", 0.0) / seconds[-1])
        guided.append(stats["values"].get("guided", 0.0))
    return np.stack(pictures), np.mean(seconds), np.mean(passes), np.mean(training), np.mean(guided)


def smoothed(picture, reach=4):
    """Mean of the square of pixels around each, at the border of those that there are."""
    padded = np.pad(picture, ((reach, reach), (reach, reach), (0, 0)), mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, (2 * reach + 1, 2 * reach + 1), axis=(0, 1)).mean(axis=(-2, -1))


def variance(pictures, mean):
    """Relative variance of one picture (docs/testing.md, Eq. 1): all pixels, and without the hundredth with most of it."""
    squares, noise = (smoothed(mean) ** 2).mean(axis=2), pictures.var(axis=0, ddof=1).mean(axis=2)
    median = np.median(np.sqrt(squares[squares > 0.0]))
    weight = 1.0 / (squares + (median / 10.0) ** 2)
    terms = np.sort((weight * noise).ravel())
    whole = (weight * squares).sum()
    return terms.sum() / whole, terms[: len(terms) - len(terms) // 100].sum() / whole


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=ROOT / "build/release/bin/mote")
    parser.add_argument("--seconds", default="120")
    parser.add_argument("--passes", help="instead of a time: variance and time are then multiplied")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--size", default="320x200")
    parser.add_argument("--scenes", default="smoke_room,atrium,fog,city,door_ajar,lamp_shade")
    parser.add_argument("--guiding", default="on", choices=["on", "automatic"])
    parser.add_argument("--threads")
    parser.add_argument("--set", nargs="*", default=[], help="settings of the guided renders: guiding_passes=63")
    parser.add_argument("--quick", action="store_true", help="tiny: numbers without a meaning")
    args = parser.parse_args()
    if args.quick:
        args.passes, args.seeds, args.size, args.scenes = "2", 2, "16x10", "cornell_box,door_ajar"
        args.set = ["guiding_passes=3", "guiding_paths=256"]
    print("scene: variance off, on; gain in variance (trimmed); in variance x seconds (trimmed); passes off, on; training; guided")
    with tempfile.TemporaryDirectory() as folder:
        for scene in args.scenes.split(","):
            guided = [f"integrator.guiding={args.guiding}", *(f"integrator.{s}" for s in args.set)]
            runs = [measure(args, scene, settings, Path(folder)) for settings in (["integrator.guiding=off"], guided)]
            mean = np.concatenate([r[0] for r in runs]).mean(axis=0)
            off, on = (np.array(variance(r[0], mean)) for r in runs)
            gain, timed = off / on, off * runs[0][1] / (on * runs[1][1])
            print(f"{scene}: {off[0]:.4g}, {on[0]:.4g}; {gain[0]:.2f} ({gain[1]:.2f}); {timed[0]:.2f} ({timed[1]:.2f}); "
                  f"{runs[0][2]:.0f}, {runs[1][2]:.0f}; {100 * runs[1][3]:.0f} %; {100 * runs[1][4]:.0f} %", flush=True)


if __name__ == "__main__":
    main()
