#!/usr/bin/python3
"""How often the stated interval of 95 % contains the true error of an image (docs/testing.md, "Error with the bias of filters").

Usage: coverage.py [--mote build/release/bin/mote] [--scenes A,B] [--methods "A;B"] [--seeds N] [--first-seed N] [--passes N] [--error E]
                   [--references FOLDER] [--reference-passes N] [--size WxH] [--threads N] [--csv FILE] [--cost] [--quick]
Renders each scene (at 96 x 64 pixels without --size) with many seeds and compares each image, by `mote compare`, with a long reference of
another seed, whose noise is subtracted. Prints for every scene and method the share of seeds whose
interval contains the true error, how many miss it on either side, true error and ends of the interval (root mean squares over
seeds), and the share of an optimist: an interval of the same width around the noise, which ignores the bias of filters. A method whose error is not known states no interval. --csv adds a row for each scene and method to a file. --error E renders until the upper end is below E instead, and prints the
share of seeds whose true error is between 0.6 and 1.0 of E: an interval that is evaluated until it is short enough contains
the error less often. --cost prints instead what the two halves cost at equal passes: true error and processor time of building,
passes and filter with film.interval, over those without, seed by seed in turns. The exit status is 1 where a share
lies outside of 93 to 97 % by more than three standard deviations of so many seeds, and where the optimist is right everywhere:
then the study could not have found a wrong interval.
"""
import argparse
import csv
import json
import math
import re
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENES = ("cornell_box", "window", "statue", "smoke_room", "fog_grille", "mist", "atrium", "city", "tree", "cloud")
METHODS = {
    "layers, own filter": ("mote_layers", {"filter": "own"}),
    "layers, OIDN": ("mote_layers", {"filter": "oidn"}),
    "layers, no filter": ("mote_layers", {"filter": "none"}),
    "layers, far lights, OIDN": ("mote_layers", {"filter": "oidn", "far_light": "lights"}),
    "paths, OIDN": ("mote_layers", {"filter": "oidn", "nested": "volpath"}),
    "volpath": ("volpath", {}),
    "mote_vpl": ("mote_vpl", {}),
    "mote_vpl, unbounded": ("mote_vpl", {"bound": -1}),
}


def scene_with(scene, nested, folder):
    """The scene with mote_layers of one nested integrator, as a file beside links to what it names."""
    for path in (ROOT / "scenes").iterdir():
        link = folder / path.name
        if path.suffix != ".xml" and not link.exists():
            link.symlink_to(path)
    text = (ROOT / f"scenes/{scene}.xml").read_text()
    text = re.sub(r'<integrator [^>]*[^/]>.*?</integrator>|<integrator [^>]*/>', "", text, flags=re.S)
    file = folder / f"{scene}_{nested}.xml"
    file.write_text(text.replace("<sensor ", f'<integrator type="mote_layers"><integrator type="{nested}"/></integrator><sensor ', 1))
    return file


def render(args, scene, method, rule, seed, output, interval=True):
    """The statistics of the image, and the processor time of the whole command."""
    integrator, settings = method
    stats = output.with_suffix(".json")
    nested = settings.get("nested")
    file = scene_with(scene, nested, output.parent) if nested else ROOT / f"scenes/{scene}.xml"
    defines = {f"integrator.{k}": v for k, v in settings.items() if k != "nested"}
    defines |= {"film.width": args.size[0], "film.height": args.size[1], "film.interval": str(interval).lower()}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([args.mote, "render", file, "--integrator", integrator, "-t", str(args.threads),
                    "--quiet", *rule, "--seed", str(seed), *(x for k, v in defines.items() for x in ("-D", f"{k}={v}")),
                    "-o", output, "--stats", stats], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {**json.loads(stats.read_text()), "processor_seconds": spent}


def true_error(args, image, reference):
    done = subprocess.run([args.mote, "compare", "--json", image, reference], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["metrics"]["error"]["value"]


def reference_of(args, scene, folder):
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{scene}_{args.size[0]}x{args.size[1]}.exr"
    if not file.exists():
        render(args, scene, ("mote_layers", {"filter": "none"}), ["--passes", str(args.reference_passes)], 1000001, file)
    return file


def seeds_of(args):
    return range(args.first_seed, args.first_seed + args.seeds)


def root_mean_square(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def study(args, scene, name, reference, folder):
    """Counts of seeds; None where the error is not known."""
    rule = ["--error", str(args.error)] if args.error else ["--passes", str(args.passes)]
    errors, lows, highs, counts = [], [], [], {"in": 0, "above": 0, "below": 0, "optimist": 0, "in time": 0}
    for seed in seeds_of(args):
        file = folder / "image.exr"
        said = render(args, scene, METHODS[name], rule, seed, file)
        interval = said["error"]
        if "unknown" in interval:
            print(f"{scene:12} {name:20} unknown: {interval['unknown']}", flush=True)
            return None
        error, low, high = true_error(args, file, reference), interval["low"], interval["high"]
        counts["in"] += low <= error <= high
        counts["above"] += error > high
        counts["below"] += error < low
        # The same width on the squares, around the noise.
        middle, within = (said["noise"] or 0.0) ** 2, (high ** 2 - low ** 2) / 2
        counts["optimist"] += middle - within <= error ** 2 <= middle + within
        counts["in time"] += bool(args.error) and 0.6 * args.error <= error <= args.error
        errors.append(error), lows.append(low), highs.append(high)
    n = args.seeds
    print(f"{scene:12} {name:20} {100 * counts['in'] / n:5.0f} %  (above {counts['above']}, below {counts['below']} of {n})   "
          f"true {root_mean_square(errors):7.2%}   stated {root_mean_square(lows):7.2%} to {root_mean_square(highs):7.2%}   "
          f"optimist {100 * counts['optimist'] / n:4.0f} %"
          + (f"   0.6 to 1.0 of the limit {100 * counts['in time'] / n:4.0f} %, "
             f"below {sum(e <= args.error for e in errors)} of {n}" if args.error else ""), flush=True)
    if args.csv:
        new = not args.csv.exists()
        with args.csv.open("a", newline="") as file:
            rows = csv.writer(file)
            if new:
                rows.writerow(["scene", "method", "rule", "seeds", "in", "above", "below", "optimist", "true", "low", "high",
                               "0.6_to_1.0_of_the_limit"])
            rows.writerow([scene, name, " ".join(rule), n, counts["in"], counts["above"], counts["below"], counts["optimist"],
                           *(f"{root_mean_square(values):.5f}" for values in (errors, lows, highs)),
                           counts["in time"] if args.error else ""])
    return counts


def cost(args, scene, name, reference, folder):
    """Error and processor time with halves of the passes, over those without."""
    errors, seconds = {False: [], True: []}, {False: 0.0, True: 0.0}
    for seed in seeds_of(args):
        for interval in (False, True) if seed % 2 else (True, False):
            file = folder / "image.exr"
            said = render(args, scene, METHODS[name], ["--passes", str(args.passes)], seed, file, interval)
            errors[interval].append(true_error(args, file, reference))
            seconds[interval] += said["processor_seconds"]
    ratios = [math.log(a / b) for a, b in zip(errors[True], errors[False])]
    ratio, spread = math.exp(statistics.fmean(ratios)), statistics.stdev(ratios) / math.sqrt(len(ratios))
    print(f"{scene:12} {name:20} error {root_mean_square(errors[False]):7.2%}, with halves {root_mean_square(errors[True]):7.2%}: "
          f"x {ratio:.3f} +- {ratio * spread:.3f}   processor time {seconds[False] / args.seeds:.2f} s, "
          f"x {seconds[True] / seconds[False]:.2f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=ROOT / "build/release/bin/mote")
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--methods", default=";".join(METHODS), help="names, separated by ';'")
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--first-seed", type=int, default=1, help="more seeds of a study: their counts add up")
    parser.add_argument("--passes", type=int, default=32)
    parser.add_argument("--error", type=float)
    parser.add_argument("--references", type=Path, help="folder of references, made where they are missing")
    parser.add_argument("--reference-passes", type=int, default=8192)
    parser.add_argument("--size", type=lambda text: tuple(int(n) for n in text.split("x")), default=(96, 64), metavar="WxH",
                        help="of the pictures, in pixels")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--cost", action="store_true", help="error and time with halves over those without, at equal passes")
    parser.add_argument("--quick", action="store_true", help="tiny: numbers without a meaning")
    args = parser.parse_args()
    if args.quick:
        args.scenes, args.seeds, args.passes, args.reference_passes = "cornell_box", 2, 8, 32
        args.methods = "layers, own filter;mote_vpl"
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for scene in args.scenes.split(","):
            reference = reference_of(args, scene, args.references or Path(folder))
            found += [(cost if args.cost else study)(args, scene, name, reference, Path(folder)) for name in args.methods.split(";")]
    if args.cost:
        return 0
    known = [counts for counts in found if counts]
    if args.quick:
        return 0 if known else 1
    chance = 3 * math.sqrt(0.95 * 0.05 * args.seeds)
    lowest, highest = 0.93 * args.seeds - chance, 0.97 * args.seeds + chance
    wrong = sum(not lowest <= counts["in"] <= highest for counts in known)
    fooled = bool(known) and all(counts["optimist"] >= lowest for counts in known)
    print(f"{wrong} of {len(known)} shares outside of 93 to 97 %" + ("; the optimist was not found out" if fooled else ""))
    return 1 if wrong or fooled else 0


if __name__ == "__main__":
    sys.exit(main())
