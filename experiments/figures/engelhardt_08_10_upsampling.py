#!/usr/bin/python3
"""Bilateral upsampling from a quarter and a sixteenth of the pixels, and micro-buffers of three sizes: Engelhardt 2013, Figs. 8.10, 8.11.

A diffuse bunny in a room and a glossy one in a box. By default `mote_micro_rendering` renders glossy pixels again, which find
no neighbour to take their light from; here they share it as in the thesis (glossy_upsampling), to show what it says. Every
setting has two passes of the same points. A full run takes some 4 minutes of one core, --quick half of one.

    experiments/figures/engelhardt_08_10_upsampling.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from claims import Claims
from micro_figures import BUNNY, GLOSSY, IndirectView, micro, zoom
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

SHARES = {1: "every pixel", 2: "1/4", 4: "1/16"}
SIDES = (8, 16, 24)


def figure(mote, quick, output):
    claims = Claims()
    points, passes, references = (4096, 2, 128) if quick else (32768, 2, 256)
    views = {"diffuse": IndirectView(mote, BUNNY, {"resx": 80, "resy": 50} if quick else {"resx": 240, "resy": 150}, references, "diffuse", depth=3),
             "glossy": IndirectView(mote, GLOSSY, {"resx": 56, "resy": 56, "alpha": 0.2} if quick else {"resx": 160, "resy": 160, "alpha": 0.2},
                                    references, "glossy", depth=3)}
    # The glossy bunny stands in the middle of its picture.
    height, width = views["glossy"].truth.shape[:2]
    middle = np.zeros((height, width), bool)
    middle[int(0.42 * height):int(0.72 * height), int(0.38 * width):int(0.62 * width)] = True
    where = {"diffuse": None, "glossy": middle}
    rows, error, times, panels = [], {}, {}, []
    for kind, view in views.items():
        for n, share in SHARES.items():
            picture = view.render(f"share_{n}", micro(light="direct", points=points, micro_buffer=16, upsampling=n, glossy_upsampling=True), passes)
            error[kind, n], times[kind, n] = view.error(picture, where[kind]), picture.value("gather_cpu_seconds")
            rows.append([kind, share, 16, error[kind, n], times[kind, n]])
            panels.append((f"{kind}, {share}: {error[kind, n]:.1%}", view.light(picture), view.truth))
    listed = lambda kind: ", ".join(f"{SHARES[n]} {error[kind, n]:.1%}" for n in SHARES)
    claims.check("for diffuse surfaces 1/16 of the pixels suffices: the error grows by less than a half", listed("diffuse"), error["diffuse", 4] < 1.5 * error["diffuse", 1])
    claims.check("for glossy surfaces it does not: there the error grows, by more than a quarter", listed("glossy"), error["glossy", 4] > 1.25 * error["glossy", 1])
    gain = times["diffuse", 1] / times["diffuse", 4]
    claims.check("1/16 of the pixels is at least twice as fast (the thesis: 4.2 against 0.83 pictures a second)", f"{gain:.1f} times", gain > 2)
    again = views["glossy"].render("again", micro(light="direct", points=points, micro_buffer=16, upsampling=4), passes)
    error["again"] = views["glossy"].error(again, middle)
    claims.check("ours: glossy pixels that are rendered again are as good as at every pixel", f"{error['again']:.1%} against {error['glossy', 1]:.1%}",
                 error["again"] < 1.1 * error["glossy", 1])
    rows.append(["glossy", "1/16, glossy pixels again", 16, error["again"], again.value("gather_cpu_seconds")])
    for side in SIDES:
        picture = views["diffuse"].render(f"side_{side}", micro(light="direct", points=points, micro_buffer=side), 1)
        error[side], times[side] = views["diffuse"].error(picture), picture.value("gather_cpu_seconds")
        rows.append(["diffuse", "every pixel, 1 pass", side, error[side], times[side]])
        panels.append((f"{side} x {side}: {error[side]:.1%}", views["diffuse"].light(picture), views["diffuse"].truth))
    claims.check("smaller buffers are faster and worse", ", ".join(f"{s} x {s}: {error[s]:.1%} in {times[s]:.1f} s" for s in SIDES),
                 error[8] > error[16] > error[24] and times[8] < times[16] < times[24])
    write_csv(output.with_suffix(".csv"), ["surfaces", "receivers", "texels_a_side", "error", "gather_cpu_seconds"], rows)
    draw(panels, output)
    return claims.exit_code()


def draw(panels, output):
    """Three panels a row, as high as the first of them."""
    size = lambda image: [k * zoom(image.shape[1]) for k in image.shape[:2]]
    rows = [panels[k:k + 3] for k in range(0, len(panels), 3)]
    width = max(size(image)[1] for _, image, _ in panels)
    canvas = Canvas(3 * (width + 10) + 10, sum(size(row[0][1])[0] + TITLE + 10 for row in rows) + 10)
    y = TITLE
    for row in rows:
        for k, (text, image, truth) in enumerate(row):
            height, own = size(image)
            show(canvas.panel(10 + k * (width + 10), y, own, height), image, 0.6 / np.percentile(luminance(truth), 90), text)
        y += size(row[0][1])[0] + TITLE + 10
    canvas.save(output.with_suffix(".png"))


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
