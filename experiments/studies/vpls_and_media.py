#!/usr/bin/python3
"""How many virtual point lights does a medium need? Bias and spread of bounded VPLs and their compensations.

The last section of Engelhardt 2013, ch. 10, leaves the question open. A closed room with black walls full of a homogeneous medium is
rendered for optical depths, albedos and mean cosines; the bound is the automatic one, light paths / R^2, so the bounding
radius is r = R / sqrt(paths). For bounded VPLs, approximate compensation of one and two steps (the defaults), and exact
compensation the study measures the light that scatters more than once, the last time in the medium:
  bias    signed, of the picture's mean, against volpath: with its standard error over seeds
  spread  of passes: rms over pixels of their standard deviation, relative to the mean
and holds the light that is lost against beta^(k+1) / beta_all for k steps: beta is the integral of
sigma_s e^(-sigma_t t) (1 - b t^2) from 0 to r, one application of the residual transport to light that is the same all
around, and beta_all = albedo (1 - e^(-sigma_t D)) the same without a bound along the mean chord D (expected_loss.h).
Numbers: OUTPUT/vpls_and_media.csv, plot: OUTPUT/vpls_and_media.png. A full run takes three minutes.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
import plotting
from claims import Claims
from measure import series_error
from origin import tables_of
from renders import approximate, compensation, main, mean_and_error, write_csv

SCENE = Path(__file__).with_suffix(".xml")
EDGE, RADIUS = 2.0, 3 ** 0.5  # of the room [m]
CHORD = 4 * EDGE ** 3 / (6 * EDGE ** 2)
METHODS = {"bounded": {}, "1 step": approximate(1), "2 steps": approximate(2), "exact": compensation("exact")}


def media(quick):
    if quick:
        return [(3.0, 0.9, 0.0)]
    return [(0.3, 0.9, 0.0), (1.0, 0.9, 0.0), (3.0, 0.9, 0.0), (10.0, 0.9, 0.0), (3.0, 0.5, 0.0), (3.0, 0.9, 0.7)]


def measure(mote, name, settings, reference, passes, seeds):
    """Bias and its standard error; spread of passes."""
    pictures = [mote.render(SCENE, name, settings, passes, seed=s).multiple().mean(axis=2) for s in range(1, seeds + 1)]
    scale = reference[0]
    bias, error = mean_and_error([p.mean() / scale - 1 for p in pictures])
    spread = series_error(pictures, [np.mean(pictures, axis=0)])["noise"] * passes ** 0.5
    return bias, (error ** 2 + (reference[1] / scale) ** 2) ** 0.5, spread


def study(mote, quick):
    seeds, budget, size = (8, 512, 8) if quick else (8, 1024, 10)
    rows = []
    for depth, albedo, g in media(quick):
        medium = {"sigma_t": depth / EDGE, "albedo": albedo, "g": g, "size": size}
        tag = f"d{depth:g}_a{albedo:g}_g{g:g}"
        truth = [mote.render(SCENE, f"{tag}_volpath", {**medium, "integrator": "volpath"}, 400 if quick else 1500, seed=s)
                 .multiple().mean() for s in range(11, 15)]
        reference = mean_and_error(truth)
        for paths in ((32, 128) if quick else (32, 256)):
            beta = residual_fraction(depth / EDGE, albedo, RADIUS / paths ** 0.5)
            for method, settings in METHODS.items():
                result = measure(mote, f"{tag}_n{paths}_{method.replace(' ', '_')}", {**medium, "paths": paths, **settings},
                                 reference, max(1, budget // paths), seeds)
                rows.append([depth, albedo, g, paths, beta, method, *map(float, result)])
                print("depth {:g} albedo {:g} g {:g} paths {} beta {:.3f} {}: bias {:+.2%} +- {:.2%}, spread {:.0%}".format(*rows[-1]),
                      flush=True)
    return rows


def column(rows, method, index):
    return np.array([r[index] for r in rows if r[5] == method])


def residual_fraction(sigma_t, albedo, r):
    t = (np.arange(2000) + 0.5) * r / 2000
    return float((albedo * sigma_t * np.exp(-sigma_t * t) * (1 - (t / r) ** 2)).sum() * r / 2000)


def predicted(rows, method):
    """The loss that expected_loss.h expects."""
    depth, albedo, beta = (column(rows, method, i) for i in (0, 1, 4))
    steps = ["bounded", "1 step", "2 steps"].index(method)
    return beta ** (steps + 1) / (albedo * (1 - np.exp(-depth / EDGE * CHORD)))


def plot_table(table, path):
    """The light that is lost over the expected, and the noise of one pass by the optical depth of the room."""
    rows = [list(row.values()) for row in tables_of(table)[0]]
    made, (left, right) = plotting.figure(columns=2, height=440)
    for method, colour in zip(METHODS, (plotting.GREEN, plotting.BROWN, plotting.BLACK, plotting.INDIGO)):
        if method != "exact":
            left.errorbar(100 * predicted(rows, method), -100 * column(rows, method, 6), 100 * column(rows, method, 7), fmt="o",
                          ms=5, lw=0.8, color=colour, label=method)
        right.plot(column(rows, method, 0), 100 * column(rows, method, 8), "o", ms=5, color=colour, label=method)
    left.plot([0, 60], [0, 60], "k-", lw=0.6)
    left.set(xlabel="light lost, as expected from the bound [%]", ylabel="light lost [%]")
    right.set(xlabel="optical depth of the room", ylabel="noise of one pass [%]", xscale="log", yscale="log")
    for axis, ticks in ((right.xaxis, [0.3, 1, 3, 10]), (right.yaxis, [20, 30, 50, 100])):
        axis.set_major_locator(plotting.FixedLocator(ticks))
        axis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{v:g}"))
        axis.set_minor_locator(plotting.NullLocator())
    for axes in (left, right):
        axes.grid(color="#e4e4e4")
        axes.legend(fontsize=10)
    plotting.save(made, path)


def run(mote, quick, output):
    rows = study(mote, quick)
    expected = {method: iter(predicted(rows, method)) for method in METHODS if method != "exact"}
    write_csv(output.with_suffix(".csv"), ["optical_depth", "albedo", "g", "paths", "beta", "method", "bias", "error", "spread", "lost", "expected"],
              [[*row, -row[6], float(next(expected[row[5]])) if row[5] in expected else ""] for row in rows])
    plot_table(output.with_suffix(".csv"), output.with_suffix(".png"))
    claims = Claims()
    z = np.abs(column(rows, "exact", 6)) / column(rows, "exact", 7)
    # Student's t of 7 degrees of freedom: 6 is exceeded by one of 12 in one run of a hundred.
    claims.check("exact compensation has no bias", f"largest of {len(z)} t-scores {z.max():.1f}", z.max() < 6.0)
    for method in ("bounded", "1 step", "2 steps"):
        loss, error = -column(rows, method, 6), column(rows, method, 7)
        off = np.abs(loss - predicted(rows, method))
        # Tolerance of the estimate: near walls and below the lamp the light is not isotropic.
        claims.check(f"{method}: the loss is as expected to 8 points", f"off by {off.max():.1%} at most, {off.mean():.1%} on average",
                     bool((off < 0.08 + 4 * error).all()))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
