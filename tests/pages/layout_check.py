#!/usr/bin/env python3
"""Does what plotting.save writes beside a PNG show the faults of the figure? Draws a sound one and one for each fault, and expects check_figures
to find that fault and no other.

    tests/pages/layout_check.py
"""
import sys
import tempfile
from pathlib import Path

import check_figures
import numpy as np
from panels import BAR, TITLE, Canvas, letters, show, show_difference

OUT = "'out' reaches out of the canvas"
PANEL = (9, TITLE, 400, 300)


def shown(canvas):
    show(canvas.panel(*PANEL), np.ones((4, 4, 3)), 0.5, "a picture")


def compared(canvas):
    show_difference(canvas.panel(*PANEL), np.linspace(-1, 1, 48).reshape(4, 4, 3), 1, 2, "a difference")


def without_bar(canvas):
    axes = canvas.panel(*PANEL)
    axes.set(xticks=[], yticks=[])
    return axes.imshow(np.eye(4), cmap="RdBu_r")


def nameless_bar(canvas):
    shown = without_bar(canvas)
    canvas.figure.colorbar(shown, ax=shown.axes).ax.tick_params(labelsize=letters(canvas.figure))


def text_at(x, y, size=None):
    return lambda canvas: canvas.figure.text(x, y, "out", fontsize=size or letters(canvas.figure))


def plot(x, y):
    def draw(canvas):
        axes = canvas.panel(100, 40, 500, 300)
        axes.plot([1, 2, 3], [2, 1, 1])
        axes.set_xlabel(x, fontsize=letters(canvas.figure))
        axes.set_ylabel(y, fontsize=letters(canvas.figure))
        axes.tick_params(labelsize=letters(canvas.figure))
    return draw


def two_titles(canvas):
    for x in (100, 200):
        show(canvas.panel(x, TITLE, 160, 100), np.ones((4, 4, 3)), 0.5, "a title wider than its panel")


CASES = [(shown, ""), (compared, ""), (plot("wall time", "relative RMSE"), ""),
         (text_at(0.99, 0.5), OUT), (text_at(-0.001, 0.5), OUT), (text_at(0.5, 0.999), OUT), (text_at(0.5, -0.02), OUT),
         (text_at(0.5, 0.5, 8), "'out' has 6.2 points"),
         (plot("", "relative RMSE"), "a horizontal axis"), (plot("wall time", "y"), "a vertical axis"),
         (without_bar, "no colour bar"), (nameless_bar, "no colour bar"), (two_titles, "lies on")]


def found(draw, width=1280):
    """Faults of a figure of so many pixels."""
    with tempfile.TemporaryDirectory() as folder:
        gallery = Path(folder) / "docs/gallery"
        gallery.mkdir(parents=True)
        canvas = Canvas(width, TITLE + 300 + BAR + 60)
        draw(canvas)
        canvas.save(gallery / "figure.png")
        return list(check_figures.check(Path(folder)))


def main():
    judged = [(expected, found(draw)) for draw, expected in CASES]
    judged += [("", found(draw, width)) for draw in (shown, compared) for width in (960, 1576)]
    failed = [f"expected '{expected}', found {what}" for expected, what in judged
              if (what if not expected else len(what) != 1 or expected not in what[0])]
    print("\n".join([*failed, f"{len(judged)} figures, {len(failed)} not judged as they should be"]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
