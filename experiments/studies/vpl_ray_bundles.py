#!/usr/bin/python3
"""Virtual point lights, bundles from the eye, and both weighted against each other: processor time to an error of 2 %.

Usage: vpl_ray_bundles.py [--mote build/release/bin/mote] [--scenes cornell_box,atrium] [--width 640] [--height 400]
                          [--passes N] [--seeds N] [--reference PASSES] [--folder FOLDER] [--methods "combined;bundles;vpls"] [--quick]
Each technique is rendered with a few passes and several seeds, and its error found against two pictures of `path`
(`mote compare --second`, free of the noise of both). The time to 2 % is extrapolated: the square of the error falls as one
over the number of passes. That flatters techniques alone, whose squares have no mean: a few passes seldom meet
their spikes. Of the atrium the haze is left out, for bundles are for surfaces. `path` is measured beside them.
"""
import argparse
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUNDLES = "mote_vpl_ray_bundles"
# Shares of 1024 light paths: the same work as 64 for all pixels, with an error that does not hang on a few paths.
SHARED = {"interleaving": 4, "paths": 1024}
METHODS = {"combined": (BUNDLES, SHARED), "combined, 4 directions": (BUNDLES, SHARED | {"directions": 4}),
           "bundles": (BUNDLES, SHARED | {"techniques": "bundles"}),
           "vpls": (BUNDLES, SHARED | {"techniques": "vpls"}),
           "vpls, 4096 paths": (BUNDLES, SHARED | {"techniques": "vpls", "paths": 4096}),
           "path": ("path", {})}


def without_haze(scene, folder):
    """A copy whose medium is gone, with the shape that holds it."""
    text = scene.read_text()
    text = re.sub(r'<shape type="cube">(?:(?!</shape>).)*<medium.*?</shape>', "", text, flags=re.S)
    path = folder / scene.name
    path.write_text(text)
    return path


def cpu():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def render(args, scene, method, passes, seed, output):
    integrator, settings = method
    command = [args.mote, "render", scene, "-o", output, "--integrator", integrator, "--seed", str(seed), "--quiet",
               "--passes", str(passes), "-D", f"resx={args.width}", "-D", f"resy={args.height}"]
    if scene.name == "atrium.xml":
        command += ["-D", f"meshes={ROOT / 'scenes/generated'}"]
    for key, value in settings.items():
        command += ["-D", f"integrator.{key}={value}"]
    before = cpu()
    subprocess.run(command, check=True)
    return cpu() - before


def error_of(args, picture, references, layer=None):
    command = [args.mote, "compare", picture, references[0], "--second", references[1]] + (["--layer", layer] if layer else [])
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found = re.search(r"^error\s+([\d.e+-]+) % \+- ([\d.e+-]+) %, bias ([-+\d.e]+) %", said, re.M)
    if not found:
        raise RuntimeError(said)
    return tuple(float(x) for x in found.groups())


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--mote", type=Path, default=ROOT / "build/release/bin/mote")
    parser.add_argument("--scenes", default="cornell_box,atrium")
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=400)
    parser.add_argument("--passes", type=int, default=8)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--reference", type=int, default=48, help="passes of each of the two")
    parser.add_argument("--methods", help="all, unless named here, separated by ';'")
    parser.add_argument("--folder", type=Path, help="keeps pictures, and takes references that are there")
    parser.add_argument("--quick", action="store_true", help="tiny: numbers without a meaning")
    args = parser.parse_args()
    if args.quick:
        args.scenes, args.width, args.height, args.passes, args.reference = "cornell_box", 32, 20, 2, 4
    chosen = args.methods.split(";") if args.methods else list(METHODS)
    if unknown := set(chosen) - set(METHODS):
        parser.error(f"no method {', '.join(sorted(unknown))}; there are {', '.join(METHODS)}")
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        print("method, passes, error of each seed [%], processor seconds, seconds to 2 %, error of the indirect light alone [%]")
        for name in args.scenes.split(","):
            scene = ROOT / "scenes" / f"{name}.xml"
            if name == "atrium":
                scene = without_haze(scene, folder)
            references = [folder / f"{name}_{args.width}_{args.reference}_{seed}.exr" for seed in (101, 102)]
            for seed, path in zip((101, 102), references):
                if not path.is_file():
                    render(args, scene, ("path", {}), args.reference, seed, path)
            print(f"{name}, {args.width} x {args.height}")
            for label in chosen:
                method = METHODS[label]
                passes = 4 * args.passes if label == "path" else args.passes
                squares, seconds, errors, indirect = [], [], [], []
                for seed in range(1, args.seeds + 1):
                    picture = folder / "picture.exr"
                    seconds.append(render(args, scene, method, passes, seed, picture))
                    error = error_of(args, picture, references)
                    errors.append(f"{error[0]:.2f}+-{error[1]:.2f}")
                    indirect.append(f"{error_of(args, picture, references, 'indirect')[0]:.1f}")
                    squares.append(error[0] ** 2)
                square, time = sum(squares) / args.seeds, sum(seconds) / args.seeds
                print(f"  {label:24s} {passes:4d}  {' '.join(errors):30s} {time:8.1f} {time * square / 4:9.0f}   indirect {' '.join(indirect)}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
