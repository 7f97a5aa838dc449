#!/usr/bin/python3
"""Indirect light of one bounce by micro-rendering and by path tracing: Engelhardt 2013, Figs. 8.5 and 8.14.

Micro-rendering at every pixel and at one pixel of 4 x 4 with bilateral upsampling, buffers of 24 x 24 texels as in the
thesis, in the Cornell box and in a room with a bunny of 70 thousand triangles. The thesis compares pictures with direct
light, which is the same for all methods: measured here is indirect light alone. A full run takes some 5 minutes of one
core, --quick half of one.

    experiments/figures/engelhardt_08_01_bounce.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from claims import Claims
from micro_figures import BUNNY, CORNELL, IndirectView, micro
from panels import BAR, TITLE, Canvas, show, show_difference
from renders import luminance, main, write_csv

METHODS = {"every pixel": 1, "1/16 of the pixels": 4}


def figure(mote, quick, output):
    claims = Claims()
    sizes = {CORNELL: {"resx": 64, "resy": 64} if quick else {"resx": 256, "resy": 256},
             BUNNY: {"resx": 80, "resy": 50} if quick else {"resx": 320, "resy": 200}}
    points, passes = (8192, 2) if quick else (65536, 2)
    rows, panels = [], []
    for scene, size in sizes.items():
        view = IndirectView(mote, scene, size, 128, scene.stem, depth=3)
        pictures = {name: view.render(name.replace("/", "_"), micro(light="direct", points=points, micro_buffer=24, upsampling=n), passes)
                    for name, n in METHODS.items()}
        path = view.render("path", {"integrator": "path"}, 4)
        error = {name: view.error(p) for name, p in pictures.items()}
        noise = view.error(path)
        # The error of path falls with the square root of its time.
        slower = {name: path.cpu * (noise / error[name]) ** 2 / p.cpu for name, p in pictures.items()}
        measured = "; ".join(f"{name}: error {error[name]:.1%}, mean {view.ratio(p) - 1:+.1%}, {p.cpu:.1f} s" for name, p in pictures.items())
        title = scene.stem.replace("_", " ")
        claims.check(f"{title}: differences are minor: below {LARGEST:.0%}, the mean within {LARGEST_BIAS:.0%}", measured,
                     all(error[n] < LARGEST and abs(view.ratio(p) - 1) < LARGEST_BIAS for n, p in pictures.items()))
        claims.check(f"{title}: with bilateral upsampling they are slightly more perceptible", f"{error['every pixel']:.2%} and {error['1/16 of the pixels']:.2%}",
                     error["every pixel"] < error["1/16 of the pixels"] < 2 * error["every pixel"], differs=None if quick else SMOOTHED)
        claims.check(f"{title}: path tracing takes longer to the same error, of upsampled pictures at the least", ", ".join(f"{s:.1f} times ({n})" for n, s in slower.items()),
                     slower["1/16 of the pixels"] > 1)
        rows += [[title, name, error[name], view.ratio(p) - 1, p.cpu, slower[name]] for name, p in pictures.items()]
        panels.append((title, view, pictures, error))
    write_csv(output.with_suffix(".csv"), ["scene", "receivers", "error", "bias_of_the_mean", "cpu_seconds", "times_path_takes_longer"], rows)
    draw(panels, output)
    return claims.exit_code()


LARGEST, LARGEST_BIAS = 0.15, 0.05
PANEL = 400  # pixels that a panel is wide
SMOOTHED = ("away from edges pixels of this size blur nothing, and light that is shared by neighbours is smoother than that of one buffer "
            "each; with few pixels it holds")


def draw(panels, output):
    """By scene two lines: `path` and the methods, and below each method what it differs by."""
    heights = [PANEL * view.truth.shape[0] // view.truth.shape[1] for _, view, _, _ in panels]
    canvas = Canvas(3 * (PANEL + 10) + 10, sum(2 * (height + TITLE + 10) + BAR + 10 for height in heights))
    y = TITLE
    for (title, view, pictures, error), height in zip(panels, heights):
        exposure = 0.6 / np.percentile(luminance(view.truth), 90)
        show(canvas.panel(10, y, PANEL, height), view.truth, exposure, f"{title}: path")
        for k, (name, picture) in enumerate(pictures.items(), 1):
            x, light = 10 + k * (PANEL + 10), view.light(picture)
            show(canvas.panel(x, y, PANEL, height), light, exposure, f"{name}: {error[name]:.1%}")
            show_difference(canvas.panel(x, y + height + TITLE + 10, PANEL, height), light - view.truth, exposure, 3, "difference")
        y += 2 * (height + TITLE + 10) + BAR + 10
    canvas.save(output.with_suffix(".png"))


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
