#!/usr/bin/python3
"""Guided paths against unguided ones at equal processor time, training included, in six scenes.

`volpath` renders 320 x 200 pixels on one thread for 30 and 120 s, with `guiding` off and automatic, two seeds each. The error is
the root of the variance between seeds, relative and weighted as that of docs/testing.md, Eq. 1, with the mean of 9 x 9 pixels in
the weight: a bright path in a pixel's own mean would hide the variance that it makes. `trimmed` leaves out the hundredth of pixels
with most of it, where a bright path decides. The gain is the quotient of both variances times seconds, after 120 s; above 1, guiding
pays. mote_study_guiding_field draws what was learned in the smoke room. `--quick`: tiny pictures, numbers without a meaning.
"""
import csv
import math
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
import plotting
from claims import Claims
from exr import read_exr
from origin import table_of
from renders import main, write_csv

FIGURES = ROOT / "experiments/figures/scenes"
SCENES = {"smoke room": ROOT / "scenes/smoke_room.xml", "atrium": ROOT / "scenes/atrium.xml", "fog": FIGURES / "glass_in_fog.xml",
          "city": ROOT / "scenes/city.xml", "door ajar": FIGURES / "door_ajar.xml", "lamp under a shade": FIGURES / "lamp_shade.xml"}
METHODS = {"volpath": "off", "volpath guided": "automatic"}
MIN_GAIN = 0.9
POINT = (2.3, 1.2, 2.0)  # in the smoke room's medium: what has been learned there is shown


def smoothed(picture, reach=4):
    """Mean of the square of pixels around each, at the border of those that there are."""
    padded = np.pad(picture, ((reach, reach), (reach, reach), (0, 0)), mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, (2 * reach + 1, 2 * reach + 1), axis=(0, 1)).mean(axis=(-2, -1))


def variance(pictures, mean):
    """Relative variance of one picture: all pixels, and without the hundredth with most of it."""
    squares, noise = (smoothed(mean) ** 2).mean(axis=2), pictures.var(axis=0, ddof=1).mean(axis=2)
    median = np.median(np.sqrt(squares[squares > 0.0]))
    weight = 1.0 / (squares + (median / 10.0) ** 2)
    terms = np.sort((weight * noise).ravel())
    whole = (weight * squares).sum()
    return terms.sum() / whole, terms[: len(terms) - len(terms) // 100].sum() / whole


def runs_of(mote, scene, tag, settings, seconds, seed):
    """A short and a long render. The short one says how many passes the long one has: training makes pilots of few passes slow."""
    short = mote.render_for(seconds[0], SCENES[scene], f"{tag}_{seconds[0]}", settings, seed, pilot=tag)
    of_a_pass = (short.cpu - mote.pilots[tag][0]) / max(1, short.passes - 1)
    passes = max(2, round(short.passes + (seconds[1] - short.cpu) / max(of_a_pass, 1e-3)))
    return short, mote.render(SCENES[scene], f"{tag}_{seconds[1]}", settings, passes, seed, threads=1)


def study(mote, scene, quick):
    """Rows of the table."""
    seconds = (0.2, 0.5) if quick else (30, 120)
    size = {"film.width": 24 if quick else 320, "film.height": 16 if quick else 200, "integrator": "volpath"}
    runs = {}
    for method, guiding in METHODS.items():
        settings = size | {"integrator.guiding": guiding} | ({"integrator.guiding_paths": 256} if quick else {})
        pairs = [runs_of(mote, scene, f"{scene} {method}".replace(" ", "_"), settings, seconds, seed) for seed in (1, 2)]
        runs |= {(method, s): pictures for s, pictures in zip(seconds, zip(*pairs))}
    mean = np.mean([p[""] for method in METHODS for p in runs[method, seconds[1]]], axis=0)
    rows = []
    for (method, target), pictures in runs.items():
        values = variance(np.stack([p[""] for p in pictures]), mean)
        statistics = [p.statistics for p in pictures]
        average = lambda of: float(np.mean([of(s) for s in statistics]))
        rows.append([scene, method, target, float(np.mean([p.cpu for p in pictures])), average(lambda s: s["passes"]),
                     average(lambda s: s["seconds"].get("guiding", 0.0)), average(lambda s: s["values"].get("guided", 0.0)),
                     average(lambda s: s["values"].get("guided_vertices", 0.0)), *map(math.sqrt, values)])
    return rows


def longest_runs(rows, scene):
    """Rows of the unguided and of the guided run, and the gain: of all pixels, and trimmed."""
    of = {row[1]: row for row in rows if row[0] == scene and row[2] == max(r[2] for r in rows)}
    plain, guided = of["volpath"], of["volpath guided"]
    return plain, guided, [(plain[k] / guided[k]) ** 2 * plain[3] / guided[3] for k in (8, 9)]


def say(rows, scene):
    plain, guided, gains = longest_runs(rows, scene)
    print(f"{scene:20} gain {gains[0]:.2f}, trimmed {gains[1]:.2f}; error {plain[8]:.1%}, {guided[8]:.1%}; passes {plain[4]:.0f}, "
          f"{guided[4]:.0f}; training {guided[5]:.1f} s; guided {guided[6]:.0%}, vertices {guided[7]:.0%}", flush=True)


def check_gains(rows, scenes):
    claims = Claims()
    for scene in scenes:
        gain, trimmed = longest_runs(rows, scene)[2]
        claims.check(f"{scene}: variance times seconds is at most 1 / {MIN_GAIN} of that without guides",
                     f"gain {gain:.2f}, trimmed {trimmed:.2f}", gain >= MIN_GAIN)
    return claims.exit_code()


def draw_field(mote, quick):
    """Pictures of mote_study_guiding_field, by name."""
    folder, size = mote.folder, ["--width", "24", "--height", "16", "--paths", "256", "--samples", "4"] if quick else []
    files = {name: folder / f"{name}.exr" for name in ("probabilities", "lobes")}
    if not (mote.redraw and all(f.is_file() for f in files.values())):
        subprocess.run([mote.program.parent / "mote_study_guiding_field", SCENES["smoke room"], "--at", *map(str, POINT), *size,
                        *(word for name, f in files.items() for word in (f"--{name}", f))], check=True)
    return {name: plane[..., 0] for f in files.values() for name, plane in read_exr(f).items()}


def plot_lines(axes, rows, scene):
    for method in METHODS:
        points = [(float(r["seconds"]), float(r["relative_rmse"])) for r in rows if (r["scene"], r["method"]) == (scene, method)]
        own = plotting.colour("volpath" if method == "volpath" else "combined")
        axes.plot(*zip(*points), "o-", color=own, label={"volpath": "unguided", "volpath guided": "automatic"}[method])
    plotting.log_axes(axes, "processor seconds", plotting.RMSE)
    axes.set_title(scene, fontsize=11)


def plot_table(table, path, field):
    """Error against time in each scene, and under it the field."""
    rows = list(csv.DictReader(table_of(table).splitlines()))
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    made, axes = plotting.figure(columns=3, rows=2 + (len(scenes) > 3), height=940 if len(scenes) > 3 else 640)
    for ax, scene in zip(axes, scenes):
        plot_lines(ax, rows, scene)
    axes[0].legend(fontsize=10, frameon=False)
    light = field["light"] / np.mean(field["light"])
    for ax, picture, title, top in zip(axes[-3:], (field["guide"] - field["extinction"], field["lobes"] * 4 * np.pi, light),
                                       ("where rays scatter", "learned at a point", "light that arrives there"),
                                       (None, 4.0, 4.0)):
        if top is None:
            plotting.difference(ax, picture, 0.5, "difference of probabilities")
        else:
            ax.imshow(picture, cmap="gray", vmin=0.0, vmax=top, interpolation="nearest", aspect="auto")
            ax.set(xticks=[], yticks=[])
        ax.set_title(title, fontsize=11)
    plotting.save(made, path)


def run(mote, quick, output):
    rows = []
    for scene in list(SCENES)[:2 if quick else None]:
        rows += study(mote, scene, quick)
        say(rows[-4:], scene)
    header = ["scene", "method", "target_seconds", "seconds", "passes", "training_seconds", "guided", "vertices", "relative_rmse", "trimmed"]
    write_csv(output.with_suffix(".csv"), header, rows)
    plot_table(output.with_suffix(".csv"), output.with_suffix(".png"), draw_field(mote, quick))
    return 0 if quick else check_gains(rows, SCENES)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
