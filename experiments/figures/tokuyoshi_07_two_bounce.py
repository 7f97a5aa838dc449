#!/usr/bin/python3
"""One and two bounces in a moving scene: Tokuyoshi and Ogaki 2012, Fig. 7.

21 light paths and 21 directions a frame, as in the paper. `time` turns a bunny and carries a light round it. Virtual point
lights alone and bundles alone have one bounce, the combination two: as in the paper, with the geometry term of Eq. 8 bounded,
and weighted instead, which leaves nothing out. Errors of one bounce are against `path` with one, of two against `path` with
two. A full run takes 4 minutes of one core, --quick 20 s.

    experiments/figures/tokuyoshi_07_two_bounce.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_figures import BUNDLES, View, with_options
from claims import Claims
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

FRAMES = (0, 140)
SAMPLES = with_options(paths=21, directions=21)
ONE = {"vpls": with_options(techniques="vpls"), "bundles": with_options(techniques="bundles"), "combined": {}}
TWO = {"two bounces, bounded": with_options(bound=1.0), "two bounces, weighted": {}}


def figure(mote, quick, output):
    claims, rows, panels = Claims(), [], []
    seeds = range(1, 5 if quick else 25)
    size = {"resx": 128, "resy": 80} if quick else {"resx": 320, "resy": 200}
    found = {}
    for time in FRAMES:
        for depth, methods in ((3, ONE), (4, TWO)):
            view = View(mote, "bunny_room", size | {"time": time}, 48 if quick else 96, f"time_{time}_{depth}", depth)
            for name, settings in methods.items():
                pictures = [view.render(name.replace(",", ""), BUNDLES | SAMPLES | settings, 1, s) for s in seeds]
                means = np.array([luminance(p[""]).mean() for p in pictures])
                found[time, name] = (view.error(pictures), view.bias(pictures), means)
                rows.append([time, name, found[time, name][0], *map(float, found[time, name][1])])
                panels.append((f"time {time}, {name}: {found[time, name][0]:.1%}", pictures[0][""], view))
    text = lambda *names: "; ".join(f"time {t}: " + ", ".join(f"{n} {found[t, n][0]:.1%}" for n in names) for t in FRAMES)
    claims.check("one bounce: combined, the error is below that of either in every frame", text(*ONE),
                 all(found[t, "combined"][0] < min(found[t, "vpls"][0], found[t, "bundles"][0]) for t in FRAMES))
    # Bounded and weighted, the pictures of a seed have the same samples: pairs show what the bound takes.
    taken = {}
    for t in FRAMES:
        bounded, weighted = (found[t, name][2] for name in TWO)
        pairs = bounded / weighted - 1
        taken[t] = (pairs.mean(), pairs.std(ddof=1) / len(pairs) ** 0.5)
    together = sum(m for m, _ in taken.values()) / len(taken), sum(e * e for _, e in taken.values()) ** 0.5 / len(taken)
    claims.check("two bounces: the paper's bound takes light", "in both frames together {:+.2%} +- {:.2%}; ".format(*together)
                 + ", ".join(f"{m:+.2%} +- {e:.2%}" for m, e in taken.values()), together[0] < (0 if quick else -3 * together[1]))
    kept = [found[t, "two bounces, weighted"][1] for t in FRAMES]
    claims.check("two bounces: weights keep it", ", ".join(f"{m:+.1%} +- {e:.1%}" for m, e in kept), all(abs(m) < 4 * e for m, e in kept))
    claims.check("two bounces cost no spikes: no more error than twice that of one bounce", text("combined", "two bounces, weighted"),
                 all(found[t, "two bounces, weighted"][0] < 2 * found[t, "combined"][0] for t in FRAMES))
    height, width = panels[0][1].shape[:2]
    canvas = Canvas(5 * (width + 10) + 10, 2 * (height + TITLE) + 10)
    exposure = 0.6 / np.percentile(luminance(panels[0][2].truth), 95)
    for k, (name, image, _) in enumerate(panels):
        show(canvas.panel(10 + k % 5 * (width + 10), TITLE + k // 5 * (height + TITLE), width, height), image, exposure, name)
    canvas.save(output.with_suffix(".png"))
    write_csv(output.with_suffix(".csv"), ["time", "method", "error", "bias", "bias_standard_error"], rows)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
