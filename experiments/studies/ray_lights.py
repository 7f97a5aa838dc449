#!/usr/bin/python3
"""Virtual ray lights against virtual point lights, photons and paths: processor seconds to 5 % of error.

Two scenes, 48 x 30: a small room full of fog (micro_fog.xml) and the smoke room. Every method has the best of its settings: all
of them are rendered by three seeds, and the one with the least squared error times seconds is rendered anew by other seeds, which
are judged. Starting is taken off (a render of one pass measures it); errors are the relative RMSE (measure.py) of all light, against two
references, one of volpath and one of long ray lights. The time to 5 % is that of
an error that falls with the root of the time, above the bias, which is the part that pairs of seeds share: where that alone is
above 5 %, there is none ("never"). `--quick`: the foggy room in less than a minute, numbers without a meaning.
"""
import csv
import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
import plotting
from claims import Claims
from measure import series_error
from origin import table_of
from renders import approximate, luminance, main, write_csv

FOG = Path(__file__).resolve().parent / "micro_fog.xml"
TARGET = 0.05
CHOICE_SEEDS, SEEDS = (101, 102, 103), (1, 2, 3, 4, 5)


def of(integrator, **settings):
    return {"integrator": integrator, **{f"integrator.{k}": v for k, v in settings.items()}}


def vpls(steps=0, **settings):
    return of("mote_vpl", **settings) | (approximate(steps) if steps else {})


# By method: its settings, by name. Eye paths are those that share the VPLs of a pass.
METHODS = {
    "ray lights": {"12 of 128": of("mote_ray_lights"), "8 of 64": of("mote_ray_lights", connections=8, candidates=64),
                   "20 of 256": of("mote_ray_lights", connections=20, candidates=256)},
    "VPLs, ABC": {"1 step, 64": vpls(1, paths=64), "2 steps, 64": vpls(2, paths=64), "3 steps, 64": vpls(3, paths=64),
                  "2 steps, 16": vpls(2, paths=16), "2 steps, 64, 8 eye paths": vpls(2, paths=64, eye_samples=8),
                  "2 steps, 32, 1-to-n": vpls(2, paths=32) | {"integrator.compensation.strategy": "1-to-n"}},
    "VPLs bounded": {"64": vpls(paths=64), "256": vpls(paths=256)},
    "photon map": {"20000": of("mote_photon_map", photon_paths=20000)},
    "volpath": {"": of("volpath")},
}
# The smoke room's own settings would go to mote_vpl: those of its methods are named by its parameters.
OWN_NAMES = {"integrator.paths": "paths"}


def seconds_to_target(pictures, references, bias_stays):
    """By picture: its error and its seconds to the target; and the error that pairs of pictures share. Few seeds do not show
    bias from the noise of virtual lights, which pixels have in common: without `bias_stays` all of it is noise."""
    shared = series_error([light for light, _ in pictures], references)["systematic"]
    stays = shared**2 if bias_stays else 0.0
    errors, times = [], []
    for light, cpu in pictures:
        alone = series_error([light], references)["squared_error"]
        left = TARGET**2 - stays
        errors.append(math.sqrt(max(alone, 0.0)))
        times.append(cpu * max(alone - stays, 0.0) / left if left > 0 else math.inf)
    return errors, times, shared


class Scene:
    """Renders of one scene at equal processor seconds."""

    def __init__(self, mote, scene, label, size):
        self.mote, self.scene, self.label, self.size, self.costs = mote, scene, label, size, {}

    def render(self, name, settings, cpu, seed):
        """As many passes as take so long: the light, and its processor seconds without those of the start."""
        named = {**self.size, **settings}
        if not isinstance(self.scene, Path) and settings["integrator"] == "mote_vpl":
            named = {OWN_NAMES.get(key, key): value for key, value in named.items()}
        tag = "".join(c if c.isalnum() else "_" for c in f"{self.label} {name}")
        if name not in self.costs:
            once = self.mote.render(self.scene, f"{tag}_once", named, 1, seed=99)
            some = self.mote.render(self.scene, f"{tag}_some", named, 4, seed=99)
            each = max(1e-4, (some.cpu - once.cpu) / 3)
            self.costs[name] = each, max(0.0, once.cpu - each)
        each, start = self.costs[name]
        picture = self.mote.render(self.scene, f"{tag}", named, max(2, round(cpu / each)), seed=seed)
        return luminance(picture[""]), max(picture.cpu - start, 1e-3)


def judge(scene, name, settings, cpu, seeds, references):
    """A row of the table."""
    pictures = [scene.render(name, settings, cpu, seed) for seed in seeds]
    errors, times, shared = seconds_to_target(pictures, references, seeds != CHOICE_SEEDS)
    bias = np.mean([light.mean() for light, _ in pictures]) / np.mean([r.mean() for r in references]) - 1
    spread = float(np.std(times, ddof=1)) if all(map(math.isfinite, times)) else math.nan
    return [float(np.mean([c for _, c in pictures])), float(np.mean(errors)), shared, float(bias), float(np.mean(times)), spread]


def show(row):
    print("{:11} {:18} {:24} {:6} {:5.1f} s  error {:6.1%}, shared {:5.1%}, mean {:+.1%}  to 5 %: {:6.2f} s, spread {:.2f} s"
          .format(*row), flush=True)


def study(mote, scene, label, quick):
    size, choice, judged = ({"resx": 16, "resy": 10}, 0.1, 0.2) if quick else ({"resx": 48, "resy": 30}, 1.5, 3)
    renders = Scene(mote, scene, label, size)
    references = [renders.render("reference paths", of("volpath"), 8 * judged, 11)[0],
                  renders.render("reference rays", of("mote_ray_lights"), 5 * judged, 12)[0]]
    rows = []
    for method, settings in METHODS.items():
        tried = {}
        settings = dict(list(settings.items())[:2 if quick else None])
        for name, values in settings.items() if len(settings) > 1 else ():
            found = judge(renders, f"{method} {name}", values, choice, CHOICE_SEEDS, references)
            rows.append([label, method, name, "choice", *found])
            show(rows[-1])
            tried[name] = found[4]
        best = min(tried, key=tried.get) if tried else next(iter(settings))
        found = judge(renders, f"{method} {best}", settings[best], judged, SEEDS[:2 if quick else None], references)
        rows.append([label, method, best, "judged", *found])
        show(rows[-1])
    return rows


def plot_table(table, path):
    """Seconds to the target of each method: candidates in grey, the chosen setting with its spread in the method's colour."""
    rows = [row for row in csv.DictReader(table_of(table).splitlines()) if row["to_target"]]
    scenes, methods = (list(dict.fromkeys(row[key] for row in rows)) for key in ("scene", "method"))
    made, axes = plotting.figure(columns=len(scenes), height=420, sharey=True)
    for ax, scene in zip(axes, scenes):
        for i, method in enumerate(methods):
            reached = [row for row in rows if (row["scene"], row["method"]) == (scene, method) and math.isfinite(float(row["to_target"]))]
            tried = [float(row["to_target"]) for row in reached if row["stage"] == "choice"]
            ax.plot(tried, [i] * len(tried), "o", color="#bbbbbb", markersize=5)
            judged = [(float(row["to_target"]), float(row["spread"])) for row in reached if row["stage"] == "judged"]
            for seconds, spread in judged:
                ax.errorbar(seconds, i, xerr=spread, fmt="s", color=plotting.colour(method), markersize=7, capsize=3)
            if not judged:
                ax.text(0.98, i, "never", transform=ax.get_yaxis_transform(), ha="right", va="center", fontsize=10,
                        bbox={"facecolor": "white", "edgecolor": "none", "pad": 2})
        ax.set(xscale="log", xlabel="processor seconds to a relative RMSE of 5 %", ylim=(len(methods) - 0.5, -0.5))
        ax.xaxis.set_major_locator(plotting.LogLocator(subs=(1, 2, 5)))
        ax.xaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{v:g}"))
        ax.xaxis.set_minor_locator(plotting.NullLocator())
        ax.set_title(scene, loc="left", fontsize=12)
        ax.grid(True, axis="x", color="#e4e4e4")
    axes[0].set_yticks(range(len(methods)), methods)
    axes[0].set_ylabel("method")
    plotting.save(made, path)


def run(mote, quick, output):
    rows, claims = [], Claims()
    scenes = (FOG, "foggy room", 0.2), ("smoke_room", "smoke room", 0.5)
    for scene, label, most in scenes[:1 if quick else None]:
        rows += study(mote, scene, label, quick)
        seconds = {row[1]: row[8:] for row in rows if row[0] == label and row[3] == "judged"}
        (rays, ray_spread), (points, point_spread) = seconds["ray lights"], seconds["VPLs, ABC"]
        ratio = rays / points
        error = ratio * math.hypot(ray_spread / rays, point_spread / points) / math.sqrt(len(SEEDS)) if ratio > 0 else math.nan
        if not quick:
            claims.check(f"{label}: ray lights take at most {most} of the time of VPLs with ABC to 5 % of error", f"{ratio:.3f} +- {error:.3f}", ratio <= most)
    write_csv(output.with_suffix(".csv"), ["scene", "method", "settings", "stage", "seconds", "error", "shared_error", "bias",
                                           "to_target", "spread"], rows)
    plot_table(output.with_suffix(".csv"), output.with_suffix(".png"))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
