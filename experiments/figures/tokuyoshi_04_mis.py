#!/usr/bin/python3
"""Virtual point lights, bundles from the eye, and both weighted against each other: Tokuyoshi and Ogaki 2012, Fig. 4.

One bounce, 21 light paths and 21 directions a picture, as in the paper; a bunny in a room with a light close to its ears
represents the paper's (70 thousand triangles there as here). Errors are the relative RMSE of a picture (measure.py), over
several seeds, against two references of `path`. A full run takes some 3 minutes of
one core, --quick half of one.

    experiments/figures/tokuyoshi_04_mis.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_figures import BUNDLES, View, with_options
from claims import Claims
from panels import TITLE, Canvas, mark, show
from renders import luminance, main, write_csv

METHODS = ("vpls", "bundles", "combined")
NAMES = {"vpls": "(a) virtual point lights", "bundles": "(b) bundles", "combined": "(c) combined"}


ROOM = ((-2.0, 2.0), (0.0, 2.6), (-2.0, 3.0))  # of scenes/bunny_room.xml
EYE, TARGET, FOV = np.array([1.5, 1.7, 2.6]), np.array([-0.75, 0.95, -0.9]), np.radians(55)


def room_points(height, width):
    """Where the ray of each pixel meets the walls, as if there were no bunny."""
    forward = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
    left = np.cross([0, 1, 0], forward)
    left /= np.linalg.norm(left)
    up = np.cross(forward, left)
    x = (1 - 2 * (np.arange(width) + 0.5) / width) * np.tan(FOV / 2)
    y = (1 - 2 * (np.arange(height) + 0.5) / height) * np.tan(FOV / 2) * height / width
    d = forward + x[None, :, None] * left + y[:, None, None] * up
    with np.errstate(divide="ignore"):
        t = np.min([np.where(d[..., k] > 0, (hi - EYE[k]) / d[..., k], (lo - EYE[k]) / d[..., k]) for k, (lo, hi) in enumerate(ROOM)], axis=0)
    return EYE + t[..., None] * d


def regions(height, width):
    """Pixels within 8 cm of an edge of the room, and those of the back wall that the bright spot on the ears lights."""
    p = room_points(height, width)
    planes = np.sort(np.stack([np.minimum(p[..., k] - lo, hi - p[..., k]) for k, (lo, hi) in enumerate(ROOM)]), axis=0)
    return {"corner": planes[1] < 0.08, "bright spot": (p[..., 2] < -1.99) & (planes[1] > 0.4)}


def figure(mote, quick, output):
    claims = Claims()
    seeds = range(1, 7 if quick else 13)
    size = {"resx": 160, "resy": 100} if quick else {"resx": 480, "resy": 300}
    view = View(mote, "bunny_room", size, 64 if quick else 96, "bunny", depth=3)
    pictures = {t: [view.render(t, BUNDLES | with_options(techniques=t, paths=21, directions=21), 1, seed) for seed in seeds]
                for t in METHODS}
    places = regions(size["resy"], size["resx"]) | {"all": None}
    error = {t: {p: view.error(pictures[t], r) for p, r in places.items()} for t in METHODS}
    indirect = lambda t: np.mean([np.percentile(view.squares(p), 99.9) ** 0.5 for p in pictures[t]])
    spikes = {t: float(indirect(t)) for t in METHODS}
    row = lambda place: ", ".join(f"{t} {error[t][place]:.1%}" for t in METHODS)
    claims.check("VPLs spike in the corner, where bundles do better", row("corner"), error["bundles"]["corner"] < error["vpls"]["corner"])
    claims.check("bundles miss the bright spot for most of the wall that it lights, where VPLs do better", row("bright spot"),
                 error["vpls"]["bright spot"] < error["bundles"]["bright spot"])
    claims.check("the combination is at least as good as the better one in either place, within 5 %", row("corner") + "; " + row("bright spot"),
                 all(error["combined"][p] <= 1.05 * min(error["vpls"][p], error["bundles"][p]) for p in ("corner", "bright spot")))
    claims.check("and better than both in the whole picture", row("all"),
                 error["combined"]["all"] < min(error["vpls"]["all"], error["bundles"]["all"]))
    claims.check("neither spikes nor misses: the worst thousandth of its pixels is off by less than that of either",
                 ", ".join(f"{t} {spikes[t]:.2f}" for t in METHODS), spikes["combined"] < min(spikes["vpls"], spikes["bundles"]))
    write_csv(output.with_suffix(".csv"), ["method", "error_corner", "error_bright_spot", "error", "error_of_the_worst_thousandth", "cpu_seconds"],
              [[t, error[t]["corner"], error[t]["bright spot"], error[t]["all"], spikes[t], float(np.mean([p.cpu for p in pictures[t]]))]
               for t in METHODS])
    draw(view, pictures, places, error, output)
    return claims.exit_code()


def draw(view, pictures, places, error, output):
    height, width = view.truth.shape[:2]
    piece = (slice(int(0.55 * height), int(0.85 * height)), slice(int(0.5 * width), int(0.8 * width)))
    canvas = Canvas(4 * width + 50, 2 * height + 2 * TITLE + 20)
    exposure = 0.6 / np.percentile(luminance(view.truth), 95)
    panels = [(NAMES[t] + f": {error[t]['all']:.1%}", pictures[t][0][""]) for t in METHODS] + [("path, for comparison", view.truth)]
    where = view.truth.mean(axis=2) * exposure
    marked = np.stack([where + 0.4 * places["corner"], where, where + 0.4 * places["bright spot"]], axis=2)
    for k, (text, image) in enumerate(panels):
        x = 10 + k * (width + 10)
        axes = canvas.panel(x, TITLE, width, height)
        show(axes, image, exposure, text)
        mark(axes, piece)
        below = canvas.panel(x, height + 2 * TITLE + 10, width, height)
        if k < 3:
            show(below, image[piece], 1.3 * exposure, f"corners {error[METHODS[k]]['corner']:.1%}, wall {error[METHODS[k]]['bright spot']:.1%}")
        else:
            show(below, marked, 1, "red: corners, blue: lit by the spot")
    canvas.save(output.with_suffix(".png"))


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
