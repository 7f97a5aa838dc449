#!/usr/bin/python3
"""Cost of a gather by the number of points and by the distance of the receivers of one walk: Engelhardt 2013, Fig. 8.12.

The bunny's room, one bounce. Times are processor seconds of the gather alone: a run with one point is taken off. Lanes of
one walk are neighbouring pixels, or with upsampling pixels that are as far apart as its lattice, which represents the
thesis's receivers with and without a space-filling curve. A full run takes some 4 minutes of one core, --quick half of one.

    experiments/figures/engelhardt_08_12_scaling.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
import plotting
from claims import Claims
from micro_figures import BUNNY, micro
from origin import tables_of
from renders import main, write_csv

BUFFER = 16


def exponent(points, values):
    return float(np.polyfit(np.log(points), np.log(values), 1)[0])


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
    of_gather, of_light = exponent(points, list(each.values())), exponent(points, [light for _, light, _ in cost.values()])
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
    plot_table(output.with_suffix(".csv"), output.with_suffix(".png"))
    return claims.exit_code()


def plot_table(table, path):
    """Measured times by the number of points, and the power of it that fits them best."""
    rows, = tables_of(table)
    points = np.array([r["points"] for r in rows])
    made, axes = plotting.figure(columns=2, height=420)
    for ax, key, title, unit in ((axes[0], "us_each_gather", f"A gather of {BUFFER} x {BUFFER} texels", "processor time [us]"),
                                 (axes[1], "light_cpu_seconds", "Points and their light", "processor time [s]")):
        values = np.array([r[key] for r in rows])
        power = exponent(points, values)
        ax.plot(points, values, "o-", color=plotting.BLUE, label="measured")
        ax.plot(points, np.exp(np.log(values).mean() + power * (np.log(points) - np.log(points).mean())), "--", color=plotting.GREY, label=f"points^{power:.2f}")
        plotting.log_axes(ax, "points", unit, percent=False)
        ax.xaxis.set_major_locator(plotting.LogLocator())
        ax.xaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{v:,.0f}"))
        ax.set_title(title, loc="left", fontsize=12)
        ax.legend(fontsize=10)
    plotting.save(made, path)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
