#!/usr/bin/python3
"""Strategies of bias compensation at equal time: Engelhardt 2013, Figs. 10.6 and 10.7.

Light that the smoke scatters more than once, by the four strategies of Sec. 10.2.3, each with as many passes as fit the
same processor time. Where every vertex of an eye path meets all VPLs, a pass takes one eye path a pixel; the 1-to-1
strategies share the VPLs out among 64. The error is the root mean square of the difference to `volpath` over the
pixels. Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes 2.5
minutes of one core, --quick 45 s.

    experiments/figures/engelhardt_10_07_strategies.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from claims import Claims
from renders import RECOVERED, approximate, compensation, luminance, main, mean_and_error, show, write_csv

SHARED = {"integrator.eye_samples": 64}
STRATEGIES = {"1-to-N": compensation("exact", strategy="1-to-n"),
              "N-to-1": compensation("exact", strategy="n-to-1"),
              "1-to-1": compensation("exact", strategy="1-to-1") | SHARED,
              "1-to-1 loc. hom.": approximate(3, strategy="1-to-1-homogeneous") | SHARED}


class EqualTime:
    """Renders of a strategy with as many passes as fit the time; getting started does not count."""

    def __init__(self, mote, common, seconds):
        self.mote, self.common, self.seconds = mote, common, seconds
        self.start = {name: self.render(name, "_start", 1, 1, {"paths": 0}).cpu for name in STRATEGIES}
        pilot = 8
        self.passes = {}
        for name in STRATEGIES:
            cpu = self.render(name, "_pilot", pilot, 1).cpu - self.start[name]
            self.passes[name] = min(max(1, round(self.seconds * pilot / max(cpu, 0.01))), 20 * pilot)

    def render(self, name, suffix, passes, seed, settings={}):
        return self.mote.render("smoke_room", name.replace(" ", "_").replace(".", "") + suffix,
                                self.common | STRATEGIES[name] | settings, passes=passes, seed=seed)


def render(mote, quick):
    size = {"resx": 24, "resy": 16} if quick else {"resx": 36, "resy": 24}
    reference = mote.render("smoke_room", "reference", size | {"integrator": "volpath"}, seed=99,
                            passes=1000 if quick else 3000)
    equal = EqualTime(mote, size | {"paths": 100 if quick else 400}, 1.5 if quick else 4)
    pictures = {name: [equal.render(name, "", equal.passes[name], seed) for seed in range(2, 5)] for name in STRATEGIES}
    return reference, pictures, equal


def error_of(picture, reference):
    """Root mean square over the pixels, relative to the mean of the reference."""
    difference = luminance(picture.multiple() - reference.multiple())
    return np.mean(difference ** 2) ** 0.5 / luminance(reference.multiple()).mean()


def spread_of_a_pass(pictures):
    """Of what compensation brings back: the standard deviation over seeds, for one pass, relative to the mean."""
    values = np.stack([luminance(p[RECOVERED]) for p in pictures])
    return (values.var(axis=0, ddof=1).mean() * pictures[0].passes) ** 0.5 / values.mean()


def check(rmse, pictures):
    claims = Claims()
    mean = {name: mean_and_error(errors) for name, errors in rmse.items()}
    text = lambda *names: ", ".join(f"{n} {100 * mean[n][0]:.1f} +- {100 * mean[n][1]:.1f} %" for n in names)
    for name in ("1-to-1", "1-to-1 loc. hom."):
        claims.check(f"{name} clearly beats 1-to-N and N-to-1 at equal time (by a factor of 1.3 and more)",
                     text(name, "1-to-N", "N-to-1"),
                     all(mean[o][0] - 2 * mean[o][1] > 1.3 * (mean[name][0] + 2 * mean[name][1]) or
                         mean[o][0] > 1.6 * mean[name][0] for o in ("1-to-N", "N-to-1")))
    claims.check("N-to-1 has less noise than 1-to-N at equal time (by a tenth and more)", text("N-to-1", "1-to-N"),
                 mean["N-to-1"][0] < 0.9 * mean["1-to-N"][0],
                 "with one eye path a pass, where it ends makes most of the noise of both, and N-to-1 takes longer a pass: "
                 "here one vertex joined to all VPLs costs a twentieth of the pass, vertices for each a fifth")
    spread = {name: spread_of_a_pass(pictures[name]) for name in ("N-to-1", "1-to-N")}
    claims.check("N-to-1 has less noise than 1-to-N, pass by pass, in what compensation brings back",
                 ", ".join(f"{name} {100 * x:.0f} %" for name, x in spread.items()), spread["N-to-1"] < spread["1-to-N"])
    return claims.exit_code()


def draw(reference, pictures, rmse, equal, path):
    figure = plt.figure(figsize=(13, 5.4))
    grid = figure.add_gridspec(2, 5, height_ratios=[1, 1.1], left=0.06, right=0.99, top=0.94, bottom=0.1, hspace=0.25)
    exposure = 1 / np.quantile(luminance(reference.multiple()), 0.98)
    for column, (name, ps) in enumerate(pictures.items()):
        axes = figure.add_subplot(grid[0, column])
        show(axes, ps[0].multiple(), exposure, f"{name}, {ps[0].passes} passes")
    show(figure.add_subplot(grid[0, 4]), reference.multiple(), exposure, "volpath")
    axes = figure.add_subplot(grid[1, :])
    for x, (name, errors) in enumerate(rmse.items()):
        mean, error = mean_and_error(errors)
        axes.bar(x, 100 * mean, yerr=100 * error, color=["0.6", "0.6", "tab:blue", "tab:green"][x], width=0.6)
    axes.set_xticks(range(len(rmse)))
    axes.set_xticklabels(rmse.keys())
    axes.set_ylabel("RMSE, % of the mean")
    axes.set_title(f"after {equal.seconds} s of processor time", fontsize=10)
    figure.savefig(path, dpi=75)
    plt.close(figure)


def figure(mote, quick, output):
    reference, pictures, equal = render(mote, quick)
    rmse = {name: [error_of(p, reference) for p in ps] for name, ps in pictures.items()}
    rows = [[name, *map(float, mean_and_error(rmse[name])), ps[0].passes, float(np.mean([p.cpu for p in ps]) - equal.start[name])]
            for name, ps in pictures.items()]
    write_csv(output.with_suffix(".csv"), ["strategy", "rmse", "standard_error", "passes", "cpu_seconds"], rows)
    for row in rows:
        print(f"                {row[0]}: {row[3]} passes, {row[4]:.1f} s")
    draw(reference, pictures, rmse, equal, output.with_suffix(".png"))
    return check(rmse, pictures)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
