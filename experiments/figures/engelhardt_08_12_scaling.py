#!/usr/bin/python3
"""Cost of a gather by the number of points and by the distance of the receivers of one walk: Engelhardt 2013, Fig. 8.12.

The bunny's room, one bounce. Times are processor seconds of the gather alone: a run with one point is taken off. Lanes of
one walk are neighbouring pixels, or with upsampling pixels that are as far apart as its lattice, which represents the
thesis's receivers with and without a space-filling curve. A full run takes some 4 minutes of one core, --quick half of one.

    experiments/figures/engelhardt_08_12_scaling.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from claims import Claims
from micro_figures import BUNNY, micro
from renders import main, write_csv

BUFFER = 16


def figure(mote, quick, output):
    claims = Claims()
    size = {"resx": 64, "resy": 40} if quick else {"resx": 160, "resy": 100}
    powers = range(12, 17, 2) if quick else range(12, 21, 2)

    def gather(points, **more):
        settings = size | micro(light="direct", micro_buffer=BUFFER, points=points, max_depth=3, **more)
        picture = mote.render(BUNNY, "_".join(["points", str(points), *more]), settings, passes=1, threads=1)
        return picture.value("gather_cpu_seconds"), picture.value("light_cpu_seconds"), picture.value("receivers")

    empty = gather(1)[0]
    cost = {p: gather(2 ** p) for p in powers}
    each = {p: 1e6 * (seconds - empty) / receivers for p, (seconds, _, receivers) in cost.items()}
    points = np.array([2.0 ** p for p in powers])
    exponent = lambda values: float(np.polyfit(np.log(points), np.log(values), 1)[0])
    of_gather, of_light = exponent(list(each.values())), exponent([light for _, light, _ in cost.values()])
    claims.check("the cost of a gather is sub-linear in the number of points: an exponent of 0.4 at most", f"{of_gather:.2f} from 2^{powers[0]} to 2^{powers[-1]}", of_gather <= 0.4)
    claims.check("making and lighting the points is linear at most (the thesis: sub-linear)", f"an exponent of {of_light:.2f}", of_light < 1.1)
    # Receivers of before, with lanes `far_apart` pixels apart in both directions: a lattice of a pass's pixels over n^2 passes.
    far_apart = 8
    seconds, _, receivers = gather(2 ** powers[-1], upsampling=far_apart)
    apart = 1e6 * (seconds - empty) / receivers
    claims.check("receivers that are near each other are gathered faster (the thesis: by a space-filling curve)",
                 f"{each[powers[-1]]:.0f} us each, {apart:.0f} us where lanes are {far_apart} pixels apart or anywhere", each[powers[-1]] < apart)
    write_csv(output.with_suffix(".csv"), ["points", "us_each_gather", "light_cpu_seconds", "receivers"],
              [[2 ** p, each[p], cost[p][1], cost[p][2]] for p in powers])
    draw(points, each, cost, (of_gather, of_light), output)
    return claims.exit_code()


def draw(points, each, cost, exponents, output):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    for ax, values, title, exponent in ((axes[0], list(each.values()), f"a gather of {BUFFER} x {BUFFER} texels [us]", exponents[0]),
                                        (axes[1], [c[1] for c in cost.values()], "points and their light [s]", exponents[1])):
        ax.loglog(points, values, "o-")
        ax.loglog(points, values[0] * (points / points[0]) ** exponent, "--", label=f"exponent {exponent:.2f}")
        ax.set(xlabel="points", title=title)
        ax.legend()
        ax.grid(True, which="both", alpha=0.3)
    figure.tight_layout()
    figure.savefig(output.with_suffix(".png"), dpi=100)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
