#!/usr/bin/python3
"""Micro-rendering with and without ray casting of the points that cover several texels: Engelhardt 2013, Fig. 8.13.

Without it a point fills the one texel that it falls on, so buffers near surfaces have holes and edges darken. A bunny in a
room, one bounce, indirect light alone. A full run takes some 2 minutes of one core, --quick a quarter of one.

    experiments/figures/engelhardt_08_13_raycast.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from claims import Claims
from micro_figures import BUNNY, IndirectView, micro, zoom
from panels import BAR, TITLE, Canvas, show, show_difference
from renders import luminance, main, write_csv
from tokuyoshi_04_mis import regions

NAMES = {True: "with ray casting", False: "without"}


def figure(mote, quick, output):
    claims = Claims()
    size = {"resx": 80, "resy": 50} if quick else {"resx": 256, "resy": 160}
    view = IndirectView(mote, BUNNY, size, 128 if quick else 256, "bunny", depth=3)
    points = 4096 if quick else 65536
    pictures = {cast: view.render("cast" if cast else "holes", micro(light="direct", points=points, ray_casting=cast), 2) for cast in NAMES}
    edges = regions(size["resy"], size["resx"])["corner"]
    places = {"edges": edges, "elsewhere": ~edges}
    light = {cast: {name: view.ratio(p, place) - 1 for name, place in places.items()} for cast, p in pictures.items()}
    error = {cast: view.error(p) for cast, p in pictures.items()}
    measured = "; ".join(f"{NAMES[c]} {light[c]['edges']:+.1%} at edges, {light[c]['elsewhere']:+.1%} elsewhere" for c in NAMES)
    claims.check("without ray casting light is missing, and around edges more of it", measured,
                 light[False]["edges"] < min(light[False]["elsewhere"], light[True]["edges"] - 0.02))
    claims.check("it cannot be omitted: the error is larger without", ", ".join(f"{NAMES[c]} {error[c]:.1%}" for c in NAMES), error[False] > error[True])
    seconds = {c: p.value("gather_cpu_seconds") for c, p in pictures.items()}
    claims.check("it costs a small part of the gather (the thesis: 2.5 instead of 2.9 pictures a second, a seventh)",
                 f"{seconds[True]:.1f} s with, {seconds[False]:.1f} s without", seconds[True] < 1.5 * seconds[False])
    write_csv(output.with_suffix(".csv"), ["ray_casting", "error", "light_at_edges", "light_elsewhere", "gather_cpu_seconds"],
              [[NAMES[c], error[c], light[c]["edges"], light[c]["elsewhere"], seconds[c]] for c in NAMES])
    draw(view, pictures, error, output)
    return claims.exit_code()


def draw(view, pictures, error, output):
    height, width = (k * zoom(view.truth.shape[1]) for k in view.truth.shape[:2])
    exposure = 0.6 / np.percentile(luminance(view.truth), 95)
    canvas = Canvas(3 * (width + 10) + 10, 2 * (height + TITLE + 10) + BAR + 10)
    show(canvas.panel(10, TITLE, width, height), view.truth, exposure, "path")
    for k, (cast, picture) in enumerate(pictures.items(), 1):
        x = 10 + k * (width + 10)
        show(canvas.panel(x, TITLE, width, height), view.light(picture), exposure, f"{NAMES[cast]}: {error[cast]:.1%}")
        show_difference(canvas.panel(x, height + 2 * TITLE + 10, width, height), view.light(picture) - view.truth, exposure, 3, "difference")
    canvas.save(output.with_suffix(".png"))


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
