#!/usr/bin/python3
"""Bias compensation in anisotropic media: Engelhardt 2013, Fig. 10.12.

The statue in a homogeneous medium with the paper's sigma_s = 0.075 and sigma_a = 0.001, scattering backward, evenly and
forward, with 4320 virtual point lights in three independent sets and two steps of approximate compensation; exact
compensation with the same VPLs is what it is judged by. The clean pictures, by `mote_layers`, are for the eye alone.
Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes 8 minutes of one
core, --quick 30 s.

    experiments/figures/engelhardt_10_12_anisotropic.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from claims import Claims
from measure import series_error
from panels import TITLE, Canvas, blocks, cleanest, enlarged, show
from renders import RECOVERED, approximate, compensation, luminance, main, mean_and_error, write_csv

VPLS, SETS = 4320, 3
MORE_SETS = 3  # with approximate compensation alone, to measure how much sets differ
ANISOTROPIES = {-0.6: "backward", 0.0: "isotropic", 0.6: "forward"}
FOG = {"sigma_s": 0.075, "sigma_a": 0.001}
PAPER_MILLISECONDS, PAPER_PIXELS = 16, 1024 ** 2  # for one VPL, on a GeForce GTX 580


def render(mote, quick):
    """By g, pairs of pictures with approximate and with exact compensation, one for each set of VPLs; by g, pictures with
    approximate compensation of more sets; and the seconds that a VPL takes a pixel on one core, with approximate compensation."""
    size = 25 if quick else 70
    common = {"resx": size, "resy": size, **FOG, "integrator.eye_samples": 32 if quick else 20}
    pilot = mote.render("statue", "pilot", common | {"resx": 4, "resy": 4, "paths": 500}, passes=1)
    paths = round((600 if quick else VPLS) / SETS * 500 / pilot.vpls)
    kinds = {"approximate": approximate(2), "exact": compensation("exact", strategy="1-to-1-homogeneous")}
    one = lambda kind, g, s: mote.render("statue", f"{kind}_{ANISOTROPIES[g]}", common | kinds[kind] | {"g": g, "paths": paths},
                                         passes=1, seed=s)
    pairs = {g: [[one(kind, g, s) for kind in kinds] for s in range(1, SETS + 1)] for g in ANISOTROPIES}
    more = {g: [one("approximate", g, SETS + 1 + s) for s in range(0 if quick else MORE_SETS)] for g in ANISOTROPIES}
    cost = np.mean([(a.cpu - pilot.cpu) / a.vpls for g in pairs for a, _ in pairs[g]]) / size ** 2
    return pairs, more, cost


def spread(pictures):
    """Noise of one set of VPLs, from how sets differ. Pixels are blocks of 5 x 5, so that it is the VPLs that differ rather
    than the samples along an eye ray."""
    pictures = [blocks(p.multiple(), 5) for p in pictures]
    return series_error(pictures, [np.mean(pictures, axis=0)])["noise"]


def check(pairs, more, cost):
    """The claims; rows of the table."""
    claims, rows = Claims(), []
    mean = lambda image: luminance(image).mean()
    for g, word in ANISOTROPIES.items():
        gaps = mean_and_error([mean(a[""]) / mean(e[""]) - 1 for a, e in pairs[g]])
        shares = mean_and_error([mean(a[RECOVERED]) / mean(e[RECOVERED]) for a, e in pairs[g]])
        lost = mean_and_error([mean(e[RECOVERED]) / mean(e[""]) for _, e in pairs[g]])
        rows.append([g, *map(float, (*gaps, *shares, *lost, spread([a for a, _ in pairs[g]] + more[g])))])
        claims.check(f"two steps match exact compensation, {word} (all light within 2 %)",
                     f"{100 * gaps[0]:+.2f} +- {100 * gaps[1]:.2f} %; {100 * shares[0]:.0f} +- {100 * shares[1]:.0f} % of "
                     f"what the bound took, which is {100 * lost[0]:.1f} %", abs(gaps[0]) + 2 * gaps[1] < 0.02)
    noise = {row[0]: row[-1] for row in rows}
    claims.check("anisotropic scattering requests more VPLs (sets differ more than in the isotropic medium)",
                 ", ".join(f"g = {g}: {100 * x:.0f} %" for g, x in noise.items()),
                 min(noise[-0.6], noise[0.6]) > noise[0.0])
    paper = 1e6 * PAPER_MILLISECONDS / PAPER_PIXELS
    print(f"                shading a VPL takes {1e9 * cost:.0f} ns a pixel on one core; the paper's GPU {paper:.0f} ns "
          f"({PAPER_MILLISECONDS} ms a VPL)")
    return claims.exit_code(), rows


def draw(pairs, more, cleans, path):
    canvas = Canvas(1280, 2 * (TITLE + 421) + 8)
    for column, (g, pictures) in enumerate(pairs.items()):
        picture = cleans[g]
        exposure = 0.6 / np.quantile(luminance(picture), 0.9)
        x = 429 * column + 1
        show(canvas.panel(x, TITLE, 421, 421), picture, exposure, f"{ANISOTROPIES[g]}, g = {g}: all light, by mote_layers")
        recovered = np.mean([a[RECOVERED] for a in [a for a, _ in pictures] + more[g]], axis=0)
        show(canvas.panel(x, 2 * TITLE + 429, 421, 421), enlarged(recovered, 3, *picture.shape[:2]), 4 * exposure,
             "what two steps bring back, x4, 3 x 3 pixels")
    canvas.save(path)


def figure(mote, quick, output):
    pairs, more, cost = render(mote, quick)
    size = {"resx": 100, "resy": 100} if quick else {"resx": 421, "resy": 421}
    cleans = {g: cleanest(mote, "statue", FOG | size | {"g": g}, 16 if quick else 48, f"clean_{word}")
              for g, word in ANISOTROPIES.items()}
    draw(pairs, more, cleans, output.with_suffix(".png"))
    code, rows = check(pairs, more, cost)
    write_csv(output.with_suffix(".csv"), ["g", "gap", "gap_error", "recovered", "recovered_error", "lost", "lost_error",
                                           "spread_of_sets"], rows)
    return code


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
