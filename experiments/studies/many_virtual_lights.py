#!/usr/bin/python3
"""Virtual point lights by the hundred thousand: what selecting them costs, and what it leaves of the picture.

Runs mote_study_selection at tiles of 4 x 4 pixels drawn from a picture of 512 x 512: all methods have the same lights, eye
paths and points along them, and are held against many lights drawn by the hierarchy, whose variance is taken off (--brute:
against all lights). Prints a table a scene, and how the time of a lightcut grows with the number of lights: the slope of a
line through the logarithms. Seconds are of one processor, for the whole picture, without eye paths and direct light.

--quick: few tiles and lights, a minute. --csv FILE writes all lines.
"""
import argparse
import csv
import math
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
METHODS = ["lightcuts:0.02:1000", "multidimensional:0.02:1000", "stochastic:64", "stochastic:256", "tree:64", "tree:256",
           "ris:256:16:none:cut", "ris:256:64:none:cut", "ris:256:16:unbiased:cut", "ris:1024:32:none:power",
           "ris:1024:32:unbiased:power", "ris:1024:32:biased:power"]
# Scene, light paths for a million lights, bound [1/m^2].
SCENES = [("atrium", 1000000, 2.0), ("smoke_room", 410000, 20.0)]


def study(program, scene, paths, bound, tiles, methods, brute=False):
    command = [program, str(ROOT / "scenes" / f"{scene}.xml"), *methods, "--paths", str(paths), "--bound", str(bound),
               "--tiles", str(tiles)] + (["--brute"] if brute else [])
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    print(done.stderr.strip().splitlines()[0])
    return [dict(line, scene=scene, paths=paths) for line in csv.DictReader(done.stdout.splitlines())]


def table(lines):
    print("| scene | lights | method | error [%] | bias [%] | seconds | rays a pixel | groups | at the limit |")
    print("|---|---|---|---|---|---|---|---|---|")
    for l in lines:
        print(f"| {l['scene']} | {l['lights']} | {l['method']} | {l['relative_error_percent']} +- {l['its_standard_error']} | "
              f"{l['bias_percent']} | {l['gather_seconds']} | {l['rays_a_pixel']} | {l['groups_a_cut']} | {l['at_limit']} |")


def slope(lines):
    """Of the logarithm of the seconds by that of the lights, by least squares."""
    x = [math.log(float(l["lights"])) for l in lines]
    y = [math.log(float(l["gather_seconds"])) for l in lines]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/mote_study_selection"))
    parser.add_argument("--quick", action="store_true", help="few tiles and lights")
    parser.add_argument("--brute", action="store_true", help="all lights as the reference: minutes a tile")
    parser.add_argument("--tiles", type=int, help="of 4 x 4 pixels")
    parser.add_argument("--csv", type=Path)
    options = parser.parse_args()
    tiles = options.tiles or (8 if options.quick else 125)
    lines = []
    for scene, paths, bound in SCENES:
        share = 20 if options.quick else 1
        lines += study(options.program, scene, paths // share, bound, tiles, METHODS, options.brute)
    table(lines)
    for scene, paths, bound in SCENES:
        growth = []
        for exponent in range(3, 5 if options.quick else 8):
            number = int(paths * 10.0 ** (exponent - 6))
            growth += study(options.program, scene, number, bound, tiles, [METHODS[0]])
        table(growth)
        print(f"{scene}: seconds grow as lights^{slope(growth):.2f}")
        lines += growth
    if options.csv:
        with open(options.csv, "w", newline="") as file:
            writer = csv.DictWriter(file, lines[0].keys())
            writer.writeheader()
            writer.writerows(lines)


if __name__ == "__main__":
    main()
