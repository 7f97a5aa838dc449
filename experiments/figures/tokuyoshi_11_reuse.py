#!/usr/bin/python3
"""Several bounces along the directions of one pass: Tokuyoshi and Ogaki 2012, Figs. 11 and 12.

A path continues along another of the pass's own directions, in random order, each at most once: then it is as good as one of
fresh directions. Directions that are chosen again and again, as in the paper, bias the light by 0.6 over their number, for
one path of two bounces in M goes straight back to where it came from: measured at commit 05a8b1c, where that code last
stood (docs/gallery/tokuyoshi_11_reuse.md). Bundles are rays from the points themselves here, not grids that are kept. A full run takes 5
minutes, --quick 10 s.

    experiments/figures/tokuyoshi_11_reuse.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_figures import BUNDLES, View, with_options
from claims import Claims
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

BOUNCES = 4
COUNTS = (4, 8, 16, 55)


def figure(mote, quick, output):
    claims, rows, found = Claims(), [], {}
    size = {"resx": 64, "resy": 40} if quick else {"resx": 128, "resy": 80}
    view = View(mote, "bunny_room", size, 16 if quick else 64, "reuse", depth=BOUNCES + 2)
    base = BUNDLES | with_options(techniques="reused_bundles", paths=0)
    # Paths meet the bright spot too seldom to show a few per cent; virtual point lights weighted against bundles have their mean.
    exact = np.array([luminance(view.render("exact", BUNDLES | with_options(paths=256), 16 if quick else 64, s)["indirect"]).mean() for s in (11, 12, 13, 14)])
    light, doubt = exact.mean(), exact.std(ddof=1) / 2 / exact.mean()
    for n in COUNTS:
        total = 440 if quick else 3520
        pictures = [view.render(f"once {n}", base | with_options(directions=n), max(1, total // n // 4), s) for s in (1, 2, 3, 4)]
        means = np.array([luminance(p["indirect"]).mean() for p in pictures]) / light - 1
        error = float(np.hypot(means.std(ddof=1) / 2, doubt))
        found[n] = (means.mean(), error, pictures[0])
        rows.append([n, "once", float(means.mean()), error, float(np.mean([p.cpu for p in pictures]))])
        print(f"{n} directions: {means.mean():+.2%} +- {error:.2%}")
    claims.check("directions chosen each but once leave the light of four bounces as it is, within four standard errors",
                 ", ".join(f"{n}: {found[n][0]:+.1%} +- {found[n][1]:.1%}" for n in COUNTS), all(abs(found[n][0]) < 4 * found[n][1] for n in COUNTS))
    one = view.render("one bounce", base | with_options(directions=55, max_depth=3), 1)
    four = view.render("four bounces", base | with_options(directions=55), 1)
    cost = four.value("bundle_cpu_seconds") / one.value("bundle_cpu_seconds")
    claims.check("four bounces cost little more than one: at most 1.5 times", f"{cost:.2f} times the time of bundles", cost <= 1.5,
                 "the paper looks up bundles that it keeps; here each bounce traces its ray, which is as cheap as looking a kept one up, so that four cost between four and five times as much")
    write_csv(output.with_suffix(".csv"), ["directions", "chosen", "bias_of_indirect_light", "standard_error", "cpu_seconds"], rows)
    height, width = (3 * k for k in view.truth.shape[:2])
    canvas = Canvas(4 * (width + 10) + 10, height + TITLE + 10)
    exposure = 0.6 / np.percentile(luminance(view.truth), 95)
    for k, (name, image) in enumerate((("one bounce, 55 directions", one[""]), ("four bounces, 55 directions", four[""]),
                                       ("four, many passes of 55", found[55][2][""]), ("path, for comparison", view.truth))):
        show(canvas.panel(10 + k * (width + 10), TITLE, width, height), image, exposure, name)
    canvas.save(output.with_suffix(".png"))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
