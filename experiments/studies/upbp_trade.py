#!/usr/bin/python3
"""mote_upbp, its techniques alone, mote_bdpt and volpath at equal processor time in scenes with media.

Usage: upbp_trade.py [--mote build/release/bin/mote] [--seconds 10] [--reference 60] [--size 96x64] [--scenes NAME,...] [--quick]
Every method renders as many passes as its pilot says fit into --seconds of one processor; waiting for other programs does not
count. The error is `mote compare` against two references of mote_bdpt (cloud: volpath), each --reference seconds long. Printed
is the relative RMSE in per cent, and, in the last columns, the combination over the best of its techniques alone, and how many
times longer volpath takes to the combination's error, its error falling as the root of time.
"""
import argparse
import json
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIGURES = "experiments/figures/scenes"
SCENES = {"glass in thin fog": (f"{FIGURES}/glass_in_fog.xml", []), "glass in dense fog": (f"{FIGURES}/glass_in_fog.xml", ["sigma_t=2"]),
          "glass of milk": (f"{FIGURES}/glass_of_milk.xml", []), "shade in smoke": (f"{FIGURES}/shade_in_smoke.xml", []),
          "smoke room": ("scenes/smoke_room.xml", []), "fog grille": ("scenes/fog_grille.xml", []), "cloud": ("scenes/cloud.xml", [])}
TECHNIQUES = ("bpt", "surf", "pp3d", "pb2d", "bb1d")


def only(*names):
    return [f"integrator.{t}={'true' if t in names else 'false'}" for t in TECHNIQUES]


METHODS = {"volpath": ("volpath", []), "mote_bdpt": ("mote_bdpt", []), "combined": ("mote_upbp", []),
           "bpt": ("mote_upbp", only("bpt")), "surf, pp3d": ("mote_upbp", only("surf", "pp3d")),
           "surf, pb2d": ("mote_upbp", only("surf", "pb2d")), "surf, bb1d": ("mote_upbp", only("surf", "bb1d"))}
ALONE = ("bpt", "surf, pp3d", "surf, pb2d", "surf, bb1d")


def render(args, scene, integrator, settings, passes, seed, exr):
    """Processor time [s]."""
    path, defined = SCENES[scene]
    width, height = args.size.split("x")
    words = [w for d in [f"film.width={width}", f"film.height={height}", *defined, *settings] for w in ("-D", d)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([args.mote, "render", ROOT / path, "--integrator", integrator, "--quiet", "-t", "1", "--passes", str(passes),
                    "--seed", str(seed), *words, "-o", exr], check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def passes_in(args, seconds, scene, integrator, settings, exr):
    one, four = (render(args, scene, integrator, settings, n, 1, exr) for n in (1, 4))
    return max(2, round(seconds / max((four - one) / 3.0, 1e-3)))


def error(args, picture, references):
    found = subprocess.run([args.mote, "compare", picture, references[0], "--second", references[1], "--json"], check=True,
                           capture_output=True, text=True)
    return json.loads(found.stdout)["metrics"]["error"]["value"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=str(ROOT / "build/release/bin/mote"))
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--reference", type=float, default=60.0)
    parser.add_argument("--size", default="96x64")
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--quick", action="store_true", help="one scene, a second")
    args = parser.parse_args()
    if args.quick:
        args.seconds, args.reference, args.size, args.scenes = 0.3, 0.5, "24x16", "glass in thin fog"
    print(f"{'scene':20}" + "".join(f"{m:>12}" for m in METHODS) + "    over best   volpath's time", flush=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        references = [folder / "a.exr", folder / "b.exr"]
        for scene in args.scenes.split(","):
            truth = "volpath" if scene == "cloud" else "mote_bdpt"
            passes = passes_in(args, args.reference, scene, truth, [], references[0])
            for seed, exr in zip((1001, 1002), references):
                render(args, scene, truth, [], passes, seed, exr)
            errors = {}
            for method, (integrator, settings) in METHODS.items():
                exr = folder / "p.exr"
                passes = passes_in(args, args.seconds, scene, integrator, settings, exr)
                render(args, scene, integrator, settings, passes, 1, exr)
                errors[method] = error(args, exr, references)
            ours = errors["combined"]
            print(f"{scene:20}" + "".join(f"{100 * e:12.1f}" for e in errors.values()) +
                  f"{ours / min(errors[m] for m in ALONE):13.2f}{(errors['volpath'] / ours) ** 2:17.1f}", flush=True)


if __name__ == "__main__":
    main()
