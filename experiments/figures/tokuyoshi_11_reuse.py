#!/usr/bin/python3
"""Several bounces along the directions of one pass: Tokuyoshi and Ogaki 2012, Figs. 11 and 12.

A path goes on along another of the pass's own directions, chosen at random. What the bundles of few directions do to the
mean: chosen again and again as in the paper, one path of two bounces in M goes straight back to where it came from; chosen
each but once, a path is as good as one of fresh directions. Bundles are rays from the points themselves here, not grids
that are kept, so that the paper's claim of time is about visibility tests and not measured. A full run takes 10 minutes,
--quick 20 s.

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
    base = BUNDLES | with_options(techniques="bundles", paths=0, joined=0, bounces=BOUNCES)
    # Paths meet the bright spot too seldom to tell a few per cent; virtual point lights weighed against bundles have their mean.
    exact = np.array([luminance(view.render("exact", BUNDLES | with_options(paths=256), 16 if quick else 64, s)["indirect"]).mean() for s in (11, 12, 13, 14)])
    light, doubt = exact.mean(), exact.std(ddof=1) / 2 / exact.mean()
    for repeats in (True, False):
        for n in COUNTS:
            total = 440 if quick else 3520
            pictures = [view.render(f"{'again' if repeats else 'once'} {n}", base | with_options(directions=n, repeats=repeats), max(1, total // n // 4), s) for s in (1, 2, 3, 4)]
            means = np.array([luminance(p["indirect"]).mean() for p in pictures]) / light - 1
            error = float(np.hypot(means.std(ddof=1) / 2, doubt))
            found[repeats, n] = (means.mean(), error, pictures[0], means)
            rows.append([n, "again" if repeats else "once", float(means.mean()), error, float(np.mean([p.cpu for p in pictures]))])
            print(f"{n} directions, {'again' if repeats else 'each once'}: {means.mean():+.2%} +- {error:.2%}")
    text = lambda repeats: ", ".join(f"{n}: {found[repeats, n][0]:+.1%} +- {found[repeats, n][1]:.1%}" for n in COUNTS)
    # Sets of one seed are the same lines, cut into passes of n: differences of pairs are the effect of choosing again.
    pairs = {n: found[True, n][3] - found[False, n][3] for n in COUNTS}
    bias = {n: (d.mean(), d.std(ddof=1) / 2) for n, d in pairs.items()}
    claims.check("directions chosen again bias the light of four bounces by about one over their number",
                 ", ".join(f"{n}: {b:+.2%} +- {e:.2%}, times {n}: {n * b:.2f}" for n, (b, e) in bias.items()),
                 all(0.4 < n * b < 0.9 for n, (b, _) in bias.items()) and bias[COUNTS[0]][0] > 4 * bias[COUNTS[0]][1])
    claims.check("each chosen but once they do not, within four standard errors", text(False),
                 all(abs(found[False, n][0]) < 4 * found[False, n][1] for n in COUNTS))
    one = view.render("one bounce", BUNDLES | with_options(techniques="bundles", paths=0, joined=0, bounces=1, directions=55), 1)
    four = view.render("four bounces", base | with_options(directions=55), 1)
    cost = four.value("bundle_cpu_seconds") / one.value("bundle_cpu_seconds")
    claims.check("four bounces cost little more than one: at most 1.5 times", f"{cost:.2f} times the time of bundles", cost <= 1.5,
                 "the paper looks up bundles that it keeps; here each bounce traces its ray, which is as cheap as looking a kept one up, so that four cost between four and five times as much")
    write_csv(output.with_suffix(".csv"), ["directions", "chosen", "bias_of_indirect_light", "standard_error", "cpu_seconds"], rows)
    height, width = (3 * k for k in view.truth.shape[:2])
    canvas = Canvas(4 * (width + 10) + 10, height + TITLE + 10)
    exposure = 0.6 / np.percentile(luminance(view.truth), 95)
    for k, (name, image) in enumerate((("one bounce, 55 directions", one[""]), ("four bounces, 55 directions", four[""]),
                                       ("four, many passes of 55", found[False, 55][2][""]), ("path, for comparison", view.truth))):
        show(canvas.panel(10 + k * (width + 10), TITLE, width, height), image, exposure, name)
    canvas.save(output.with_suffix(".png"))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
