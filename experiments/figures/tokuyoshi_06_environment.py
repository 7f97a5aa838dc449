#!/usr/bin/python3
"""Direct light of an environment map, by directions that serve both ways and one way: Tokuyoshi and Ogaki 2012, Fig. 6.

A bunny and a ball under the sky of scenes/generate stand for the paper's scene of 87 thousand triangles. Light of the sky
alone, without bounces; a direction that serves one way is what a shadow map tests. Rays are exact in both, so what is
compared is the error for as many directions, not the time of a rasterizer. `time` turns the bunny. A full run takes
a minute of one core, --quick 20 s.

    experiments/figures/tokuyoshi_06_environment.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_figures import BUNDLES, View, with_options
from claims import Claims
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

COUNTS = (8, 16, 32, 64)
SKY = BUNDLES | with_options(sky=True, techniques="bundles", paths=0, joined=0)


def figure(mote, quick, output):
    claims, rows = Claims(), []
    seeds = range(1, 9 if quick else 13)
    size = {"resx": 120, "resy": 80} if quick else {"resx": 360, "resy": 240}
    view = View(mote, "open_sky", size, 64 if quick else 128, "sky", depth=2)
    kinds = {"both ways": {}, "one way": with_options(two_way=False)}
    errors, shown = {}, {}
    for kind, settings in kinds.items():
        for n in COUNTS:
            pictures = [view.render(f"{kind} {n}", SKY | with_options(directions=n) | settings, 1, s) for s in seeds]
            errors[kind, n], shown[kind, n] = view.error(pictures), pictures[0]
            rows.append([kind, n, errors[kind, n], *map(float, view.bias(pictures)), float(np.mean([p.cpu for p in pictures]))])
    squares = [(errors["one way", n] / errors["both ways", n]) ** 2 for n in COUNTS]
    claims.check("the square of the error for as many directions is larger where they serve one way: 1.5 times or more",
                 ", ".join(f"{n}: {q:.2f}" for n, q in zip(COUNTS, squares)), min(squares) > 1.5)
    pairs = [(n, errors["both ways", n], errors["one way", 2 * n]) for n in COUNTS[:-1]]
    claims.check("equal quality with half as many directions, within a quarter",
                 ", ".join(f"{n} both ways {a:.1%}, {2 * n} one way {b:.1%}" for n, a, b in pairs),
                 all(a < 1.25 * b for _, a, b in pairs))
    moved = [view.mote.render(view.scene, f"frame_{t}", size | view.depth | SKY | with_options(directions=32) | {"time": t}, passes=1)
             for t in (0, 60, 120)]
    draw(view, shown, moved, errors, output)
    write_csv(output.with_suffix(".csv"), ["directions_serve", "directions", "error", "bias", "bias_standard_error", "cpu_seconds"], rows)
    return claims.exit_code()


def draw(view, shown, moved, errors, output):
    height, width = view.truth.shape[:2]
    canvas = Canvas(4 * width + 50, 2 * height + 2 * TITLE + 30)
    exposure = 0.6 / np.percentile(luminance(view.truth), 90)
    panels = [(f"{n} directions, {kind}: {errors[kind, n]:.1%}", shown[kind, n][""]) for kind, n in
              (("both ways", 16), ("one way", 16), ("one way", 32))] + [("path", view.truth)]
    panels += [(f"time = {60 * k}, 32 directions, both ways", p[""]) for k, p in enumerate(moved)]
    for k, (text, image) in enumerate(panels):
        show(canvas.panel(10 + k % 4 * (width + 10), TITLE + k // 4 * (height + TITLE), width, height), image, exposure, text)
    canvas.save(output.with_suffix(".png"))


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
