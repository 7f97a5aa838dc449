#!/usr/bin/python3
"""Direct light of an environment map by directions that serve both ways: Tokuyoshi and Ogaki 2012, Fig. 6.

A bunny and a ball under the sky of scenes/generate represent the paper's scene of 87 thousand triangles. Light of the sky
alone, without bounces. Directions that serve one way, as a shadow map tests, were measured at commit 05a8b1c, where their
code last stood (docs/gallery/tokuyoshi_06_environment.md). `time` turns the bunny. A full run takes half a minute of one core, --quick 10 s.

    experiments/figures/tokuyoshi_06_environment.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_figures import BUNDLES, View, with_options
from claims import Claims
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

COUNTS = (8, 16, 32, 64)
SKY = BUNDLES | with_options(sky=True, techniques="bundles", paths=0)


def figure(mote, quick, output):
    claims, rows = Claims(), []
    seeds = range(1, 9 if quick else 13)
    size = {"resx": 120, "resy": 80} if quick else {"resx": 360, "resy": 240}
    view = View(mote, "open_sky", size, 64 if quick else 128, "sky", depth=2)
    errors, shown = {}, {}
    for n in COUNTS:
        pictures = [view.render(f"both ways {n}", SKY | with_options(directions=n), 1, s) for s in seeds]
        errors[n], shown[n] = view.error(pictures), pictures[0]
        rows.append(["both ways", n, errors[n], *map(float, view.bias(pictures)), float(np.mean([p.cpu for p in pictures]))])
    falls = [errors[n] / errors[2 * n] for n in COUNTS[:-1]]
    claims.check("twice the directions have less error by a root of two, within a fifth", ", ".join(f"{f:.2f}" for f in falls),
                 all(abs(f / 2 ** 0.5 - 1) < 0.2 for f in falls))
    moved = [view.mote.render(view.scene, f"frame_{t}", size | view.depth | SKY | with_options(directions=32) | {"time": t}, passes=1)
             for t in (0, 60, 120)]
    draw(view, shown, moved, errors, output)
    write_csv(output.with_suffix(".csv"), ["directions_serve", "directions", "error", "bias", "bias_standard_error", "cpu_seconds"], rows)
    return claims.exit_code()


def draw(view, shown, moved, errors, output):
    height, width = view.truth.shape[:2]
    canvas = Canvas(4 * width + 50, 2 * height + 2 * TITLE + 30)
    exposure = 0.6 / np.percentile(luminance(view.truth), 90)
    panels = [(f"{n} directions: {errors[n]:.1%}", shown[n][""]) for n in (8, 16, 32)] + [("path", view.truth)]
    panels += [(f"time = {60 * k}, 32 directions", p[""]) for k, p in enumerate(moved)]
    for k, (text, image) in enumerate(panels):
        show(canvas.panel(10 + k % 4 * (width + 10), TITLE + k // 4 * (height + TITLE), width, height), image, exposure, text)
    canvas.save(output.with_suffix(".png"))


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
