#!/usr/bin/python3
"""mote_upbp, each of its techniques alone, mote_bdpt, ray lights and volpath at equal processor time in ten scenes with media.

Usage: upbp_trade.py [--seconds 60] [--reference 120] [--size 320x200] [--scenes NAME,...] [--methods "NAME;..."] [--output CSV]
                     [--pictures FOLDER] [--gallery FOLDER] [--quick]
Every method renders as many passes as a pilot says fit into --seconds of one thread's processor time. The error is `mote compare`
against two references of the unbiased method that has least noise, each --reference seconds long; `trimmed` leaves out the thousandth of pixels that differ
most, where a bright path decides. Each result is appended to --output at once, each picture kept in --pictures, and what is there is
not rendered again. The tables at the end have the relative RMSE [%] at --seconds (errors fall as the root of the time that a method
took), the combination over the best of its techniques alone, and volpath's time to the combination's error over that of the
combination. --gallery writes them there, with a plot. benchmark/generate makes the volumetric caustic.
"""
import argparse
import csv
import json
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
import plotting
from exr import read_exr
from origin import Origin

FIGURES = ROOT / "experiments/figures/scenes"
# File, its settings, and the integrator of the references.
SCENES = {
    "glass in thin fog": (FIGURES / "glass_in_fog.xml", [], "mote_bdpt"),
    "glass in dense fog": (FIGURES / "glass_in_fog.xml", ["sigma_t=2"], "mote_ray_lights"),
    "glass of milk": (FIGURES / "glass_of_milk.xml", [], "volpath"),
    "volumetric caustic": (ROOT / "benchmark/generated/volumetric-caustic.xml", [], "mote_bdpt"),
    "room of dense fog": (ROOT / "experiments/studies/vpls_and_media.xml", ["sigma_t=5", "wall=0.6"], "mote_ray_lights"),
    "fog grille": (ROOT / "scenes/fog_grille.xml", [], "volpath"),
    "shade in smoke": (FIGURES / "shade_in_smoke.xml", [], "mote_bdpt"),
    "smoke room": (ROOT / "scenes/smoke_room.xml", [], "volpath"),
    "mist": (ROOT / "scenes/mist.xml", [], "volpath"),
    "cloud": (ROOT / "scenes/cloud.xml", [], "volpath"),
}
NO_RAY_LIGHTS = ("glass of milk", "cloud")  # their paths scatter too often for virtual lights
COLOURS = {"volpath": "volpath", "mote_bdpt": "bidirectional", "ray lights": "ray lights", "combined": "layers", "bpt": "Mitsuba",
           "surf, pp3d": "VPL", "surf, pb2d": "photon", "surf, bb1d": "lightcuts"}
TECHNIQUES = ("bpt", "surf", "pp3d", "pb2d", "bb1d")


def only(*names):
    return "mote_upbp", [f"integrator.{t}={'true' if t in names else 'false'}" for t in TECHNIQUES]


ALONE = {"bpt": only("bpt"), "surf, pp3d": only("surf", "pp3d"), "surf, pb2d": only("surf", "pb2d"), "surf, bb1d": only("surf", "bb1d")}
METHODS = {"volpath": ("volpath", []), "mote_bdpt": ("mote_bdpt", []), "ray lights": ("mote_ray_lights", []),
           "combined": ("mote_upbp", []), **ALONE}


def render(args, scene, method, passes, seed, exr):
    """Processor seconds."""
    path, defined, _ = SCENES[scene]
    integrator, settings = method
    width, height = args.size.split("x")
    words = [w for d in [f"film.width={width}", f"film.height={height}", *defined, *settings] for w in ("-D", d)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([args.mote, "render", path, "--integrator", integrator, "--quiet", "-t", "1", "--passes", str(passes),
                    "--seed", str(seed), *words, "-o", exr], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def render_for(args, seconds, scene, method, seed, exr):
    """Passes that fit into the time, two at the least, and the seconds that they took."""
    one, three = (render(args, scene, method, n, seed, exr) for n in (1, 3))
    passes = max(2, round((seconds - one) / max((three - one) / 2, 1e-3)))
    return passes, render(args, scene, method, passes, seed, exr)


def kept(args, scene, name):
    """Where a picture is kept."""
    folder = args.pictures / args.size / scene.replace(" ", "_")
    folder.mkdir(parents=True, exist_ok=True)
    return folder / f"{name.replace(', ', '_').replace(' ', '_')}.exr"


def references(args, scene):
    """Two of different seeds, each written under its name when it is complete."""
    paths = [kept(args, scene, f"reference_{seed}") for seed in (1001, 1002)]
    for seed, path in zip((1001, 1002), paths):
        if not path.is_file():
            part = path.with_name("part.exr")
            render_for(args, args.reference, scene, (SCENES[scene][2], []), seed, part)
            part.rename(path)
    return paths


def relative_rmse(args, image, pair):
    said = subprocess.run([args.mote, "compare", image, pair[0], "--second", pair[1], "--json"], check=True, capture_output=True, text=True)
    return json.loads(said.stdout)["metrics"]["error"]["value"]


def trimmed_rmse(image, pair):
    """Relative RMSE as of docs/testing.md, Eq. 1, without the thousandth of pixels with most of the difference."""
    picture, a, b = (read_exr(path)[""].astype(float) for path in (image, *pair))
    squares = np.maximum((a * b).mean(axis=2), 0.0)
    weight = 1.0 / (squares + (np.median(np.sqrt(squares[squares > 0.0])) / 10.0) ** 2)
    difference = weight * ((picture - (a + b) / 2) ** 2).mean(axis=2)
    rest = difference <= np.quantile(difference, 0.999)
    return np.sqrt(max(0.0, (weight * ((picture - a) * (picture - b)).mean(axis=2))[rest].sum() / (weight * squares)[rest].sum()))


def errors_of(args, scene, method):
    """Cells of the table."""
    picture, pair = kept(args, scene, method), references(args, scene)
    return {"relative_rmse": f"{relative_rmse(args, picture, pair):.5g}", "trimmed": f"{trimmed_rmse(picture, pair):.5g}"}


def measure_again(args):
    """Errors of all pictures that are kept, as after a change of references."""
    found = rows_of(args)
    rows = [{**row, **errors_of(args, scene, method)} for (scene, method), row in found.items()]
    with open(args.output, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows(rows)


def rows_of(args):
    """By scene and method: the rows of this size and time."""
    if not args.output.is_file():
        return {}
    with open(args.output, newline="", encoding="utf-8") as file:
        return {(r["scene"], r["method"]): r for r in csv.DictReader(file) if (r["size"], float(r["seconds"])) == (args.size, args.seconds)}


def append(path, row):
    new = not path.is_file()
    with open(path, "a", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, row)
        if new:
            table.writeheader()
        table.writerow(row)


def measure(args, scene):
    done = rows_of(args)
    left = [m for m in args.methods if (scene, m) not in done and not (m == "ray lights" and scene in NO_RAY_LIGHTS)]
    for method in left:
        exr = kept(args, scene, method)
        passes, taken = render_for(args, args.seconds, scene, METHODS[method], 1, exr)
        append(args.output, {"scene": scene, "method": method, "size": args.size, "seconds": args.seconds, "passes": passes,
                             "taken": f"{taken:.2f}", **errors_of(args, scene, method)})


def at_seconds(args, column):
    """By scene, and method: errors at --seconds, as the root of time."""
    errors = {scene: {} for scene in args.scenes}
    for (scene, method), r in rows_of(args).items():
        if scene in errors:
            errors[scene][method] = float(r[column]) * (float(r["taken"]) / args.seconds) ** 0.5
    return errors


def plot(args, path):
    """A row for each scene, a dot for each method: `trimmed`."""
    errors = at_seconds(args, "trimmed")
    scenes = list(errors)[::-1]
    made, (axes,) = plotting.figure(height=700)
    for i, method in enumerate(METHODS):
        rows = [(y + 1 - (i + 0.5) / len(METHODS), errors[scene][method]) for y, scene in enumerate(scenes) if method in errors[scene]]
        axes.plot([e for _, e in rows], [y for y, _ in rows], "D" if method == "combined" else "o", ms=7 if method == "combined" else 5,
                  color=plotting.colour(COLOURS[method]), label=method)
    for y in range(1, len(scenes)):
        axes.axhline(y, color="#c8c8c8", lw=0.8)
    axes.set(ylabel="scene", ylim=(0, len(scenes)), yticks=[y + 0.5 for y in range(len(scenes))])
    axes.set_yticklabels(scenes)
    axes.set(xscale="log", xlabel=f"{plotting.RMSE} after {args.seconds:g} s, without a thousandth of pixels")
    axes.xaxis.set_major_locator(plotting.LogLocator(subs=(1, 2, 5), numticks=12))
    axes.xaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{100 * v:g} %"))
    axes.xaxis.set_minor_locator(plotting.NullLocator())
    axes.grid(True, axis="x", color="#e4e4e4", linewidth=0.8)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.13), ncols=4, fontsize=10, frameon=False)
    plotting.save(made, path)


def write_gallery(args):
    table, picture = args.gallery / "upbp_trade.csv", args.gallery / "upbp_trade.png"
    whole, trimmed = at_seconds(args, "relative_rmse"), at_seconds(args, "trimmed")
    with open(table, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["scene", "method", "relative_rmse", "trimmed"])
        writer.writerows([scene, m, f"{whole[scene][m]:.5g}", f"{trimmed[scene][m]:.5g}"] for scene in whole for m in METHODS if m in whole[scene])
    plot(args, picture)
    Origin(__file__, args.quick).stamp(picture, table)


def print_table(args, column):
    print(f"{column:20}" + "".join(f"{m:>12}" for m in METHODS) + "    over best   volpath's time")
    for scene, errors in at_seconds(args, column).items():
        cells = "".join(f"{100 * errors[m]:12.1f}" if m in errors else f"{'':12}" for m in METHODS)
        if {"combined", "volpath", *ALONE} <= set(errors):
            ours, best = errors["combined"], min(errors[m] for m in ALONE)
            cells += f"{ours / best:13.2f}{(errors['volpath'] / ours) ** 2:17.1f}"
        print(f"{scene:20}{cells}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=ROOT / "build/release/bin/mote")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--reference", type=float, default=120.0)
    parser.add_argument("--size", default="320x200")
    parser.add_argument("--scenes", type=lambda names: names.split(","), default=list(SCENES))
    parser.add_argument("--methods", type=lambda names: names.split(";"), default=list(METHODS))
    parser.add_argument("--output", type=Path, default=ROOT / "out/upbp_trade.csv")
    parser.add_argument("--pictures", type=Path, default=ROOT / "out/upbp_trade")
    parser.add_argument("--again", action="store_true", help="measure the kept pictures of this size and time again; leaves no other rows")
    parser.add_argument("--gallery", type=Path, help="folder of the table and of the plot")
    parser.add_argument("--quick", action="store_true", help="tiny: numbers without a meaning")
    args = parser.parse_args()
    if args.quick:
        args.seconds, args.reference, args.size = 0.3, 0.6, "24x16"
    args.output.parent.mkdir(parents=True, exist_ok=True)
    for scene in args.scenes:
        try:
            measure(args, scene)
        except subprocess.CalledProcessError as error:
            sys.exit(f"{scene}: {error}")
    if args.again:
        measure_again(args)
    for column in ("relative_rmse", "trimmed"):
        print_table(args, column)
    if args.gallery:
        write_gallery(args)


if __name__ == "__main__":
    main()
