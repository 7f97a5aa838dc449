#!/usr/bin/python3
"""mote_upbp, each of its techniques alone, mote_bdpt, ray lights and volpath at equal processor time in ten scenes with media.

Every method renders as many passes as a pilot says fit into 60 s of one thread, at 320 x 200. The error is the relative RMSE
(measure.py) against two references of the unbiased method that has least noise, of 120 s each; `trimmed` leaves out the thousandth of
pixels with most of it, where a bright path decides. Errors are those at 60 s: they fall as the root of the time that a method took.
Said are also the combination's error over that of the best technique alone, and volpath's time to it over the combination's.
benchmark/generate makes the volumetric caustic. `--quick`: tiny pictures, numbers without a meaning.
"""
import csv
import math
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
import plotting
from measure import pixel_errors
from origin import table_of
from renders import main, write_csv

FIGURES = ROOT / "experiments/figures/scenes"
# File, its settings, and the integrator of the references.
SCENES = {
    "glass in thin fog": (FIGURES / "glass_in_fog.xml", {}, "mote_bdpt"),
    "glass in dense fog": (FIGURES / "glass_in_fog.xml", {"sigma_t": 2}, "mote_ray_lights"),
    "glass of milk": (FIGURES / "glass_of_milk.xml", {}, "volpath"),
    "volumetric caustic": (ROOT / "benchmark/generated/volumetric-caustic.xml", {}, "mote_bdpt"),
    "room of dense fog": (ROOT / "experiments/studies/vpls_and_media.xml", {"sigma_t": 5, "wall": 0.6}, "mote_ray_lights"),
    "fog grille": (ROOT / "scenes/fog_grille.xml", {}, "volpath"),
    "shade in smoke": (FIGURES / "shade_in_smoke.xml", {}, "mote_bdpt"),
    "smoke room": (ROOT / "scenes/smoke_room.xml", {}, "volpath"),
    "mist": (ROOT / "scenes/mist.xml", {}, "volpath"),
    "cloud": (ROOT / "scenes/cloud.xml", {}, "volpath"),
}
NO_RAY_LIGHTS = ("glass of milk", "cloud")  # their paths scatter too often for virtual lights
TECHNIQUES = ("bpt", "surf", "pp3d", "pb2d", "bb1d")


def only(*names):
    return {"integrator": "mote_upbp", **{f"integrator.{t}": t in names for t in TECHNIQUES}}


ALONE = {"bpt": only("bpt"), "pp3d": only("surf", "pp3d"), "pb2d": only("surf", "pb2d"), "bb1d": only("surf", "bb1d")}
METHODS = {"volpath": {"integrator": "volpath"}, "mote_bdpt": {"integrator": "mote_bdpt"}, "ray lights": {"integrator": "mote_ray_lights"},
           "combined": {"integrator": "mote_upbp"}, **ALONE}


class Scene:
    """Renders of one scene, of one thread."""

    def __init__(self, mote, name, quick):
        self.mote, self.name = mote, name
        self.path, settings, self.of_references = SCENES[name]
        width, height = (24, 16) if quick else (320, 200)
        self.settings = {"film.width": width, "film.height": height, **settings}
        self.seconds, self.reference_seconds = (0.3, 0.6) if quick else (60, 120)

    def render_for(self, seconds, name, method, seed):
        return self.mote.render_for(seconds, self.path, f"{self.name} {name}".replace(" ", "_"), self.settings | method, seed)

    def references(self):
        method = {"integrator": self.of_references}
        return [self.render_for(self.reference_seconds, "reference", method, seed)[""] for seed in (1001, 1002)]

    def errors(self, name, references):
        """Relative RMSE after `seconds`: of all pixels, and trimmed; NaN where the noise of the references hides it."""
        picture = self.render_for(self.seconds, name, METHODS[name], 1)
        squares = pixel_errors(picture[""], references)
        rest = squares[np.abs(squares) <= np.quantile(np.abs(squares), 0.999)]
        return [math.sqrt(s.mean() * picture.cpu / self.seconds) if s.mean() > 0.0 else math.nan for s in (squares, rest)]


def study(mote, name, quick):
    """Rows of the table."""
    scene = Scene(mote, name, quick)
    references = scene.references()
    return [[name, method, *scene.errors(method, references)] for method in METHODS if method != "ray lights" or name not in NO_RAY_LIGHTS]


def say(rows):
    for column, measure in ((2, "all pixels"), (3, "trimmed")):
        print(f"{measure:20}" + "".join(f"{m:>12}" for m in METHODS) + "    over best   volpath's time")
        for scene in dict.fromkeys(row[0] for row in rows):
            errors = {row[1]: row[column] for row in rows if row[0] == scene}
            ours, best = errors["combined"], min(errors[m] for m in ALONE)
            cells = "".join(f"{100 * errors[m]:12.1f}" if m in errors else f"{'':12}" for m in METHODS)
            print(f"{scene:20}{cells}{ours / best:13.2f}{(errors['volpath'] / ours) ** 2:17.1f}")


def plot_table(table, path, seconds):
    """A row for each scene, a dot for each method: `trimmed`."""
    rows = list(csv.DictReader(table_of(table).splitlines()))
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    made, axes, height_of = plotting.scene_rows(scenes, f"{plotting.RMSE} after {seconds} s, without a thousandth of pixels", 700, (1, 2, 5))
    for i, method in enumerate(METHODS):
        dots = [(float(row["trimmed"]), height_of(row["scene"], (i + 0.5) / len(METHODS))) for row in rows if row["method"] == method]
        style = {"marker": "D", "ms": 7} if method == "combined" else {"marker": "o", "ms": 5}
        axes.plot(*zip(*dots), ls="none", color=plotting.colour(method), label=method, **style)
    plotting.legend_above(axes)
    plotting.save(made, path)


def run(mote, quick, output):
    rows = [row for name in list(SCENES)[:3 if quick else None] for row in study(mote, name, quick)]
    say(rows)
    write_csv(output.with_suffix(".csv"), ["scene", "method", "relative_rmse", "trimmed"], rows)
    plot_table(output.with_suffix(".csv"), output.with_suffix(".png"), 0.3 if quick else 60)
    return 0


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
