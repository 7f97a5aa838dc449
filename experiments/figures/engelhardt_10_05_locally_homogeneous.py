#!/usr/bin/python3
"""The medium taken for homogeneous inside the bounding region: Engelhardt 2013, Fig. 10.5.

The smoke room with two steps of compensation, with the exact transmittance inside the bounding region and with that of
the mean extinction; all else is the same, down to the VPLs. The difference, times 16, and its mean over several sets of
VPLs. Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes 2 minutes of
one core, --quick 15 s.

    experiments/figures/engelhardt_10_05_locally_homogeneous.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from claims import Claims
from renders import (RECOVERED, approximate, luminance, main, mean_and_error, show, show_difference, write_csv)

VISIBLE = 0.02  # of the brightness: about the step that an eye tells apart
BLOCK = 8  # pixels to a side, over which differences are averaged


def render(mote, quick):
    """By transmittance, the pictures of independent sets of VPLs."""
    common = {"resx": 48 if quick else 96, "resy": 32 if quick else 64, "paths": 60 if quick else 150,
              "integrator.eye_samples": 16 if quick else 32}
    return {which: [mote.render("smoke_room", which, common | approximate(
        2, transmittance=which, local_visibility=True, strategy="1-to-1-homogeneous"), passes=1 if quick else 3, seed=s)
        for s in range(4)] for which in ("exact", "mean")}


def blocks(image):
    """The luminance of blocks of pixels."""
    height, width = (n // BLOCK for n in image.shape[:2])
    l = luminance(image)[:height * BLOCK, :width * BLOCK]
    return l.reshape(height, BLOCK, width, BLOCK).mean(axis=(1, 3))


def check(pictures):
    """The claims; rows of the table."""
    claims = Claims()
    pairs = list(zip(pictures["exact"], pictures["mean"]))
    total = np.mean([luminance(e[""]).mean() for e in pictures["exact"]])
    bias, error = mean_and_error([luminance(m[""] - e[""]).mean() / total for e, m in pairs])
    recovered = np.mean([luminance(e[RECOVERED]).mean() for e in pictures["exact"]])
    share, share_error = mean_and_error([luminance(m[RECOVERED] - e[RECOVERED]).mean() / recovered for e, m in pairs])
    claims.check(f"the error of the mean extinction is invisible: less than {100 * VISIBLE:.0f} % of the brightness",
                 f"bias {100 * bias:+.2f} +- {100 * error:.2f} %, of the recovered light {100 * share:+.1f} +- "
                 f"{100 * share_error:.1f} %", abs(bias) + 3 * error < VISIBLE)
    difference, noise = mean_and_error([blocks(m[""] - e[""]) for e, m in pairs])
    brightness = np.mean([blocks(e[""]) for e in pictures["exact"]], axis=0)
    # What is left of the differences' square without the noise in it.
    square = np.mean(((difference ** 2 - noise ** 2) / brightness ** 2))
    rms = max(square, 0.0) ** 0.5
    worst = np.abs(difference / brightness).max()
    claims.check(f"nowhere does it show (blocks of {BLOCK} x {BLOCK} pixels, root mean square, without noise)",
                 f"{100 * rms:.2f} %; the worst block, with noise, {100 * worst:.1f} %", rms < VISIBLE)
    claims.check("it shows when it is scaled by 16 (the worst block differs by over a tenth of its brightness then)",
                 f"{1600 * worst:.0f} %", 16 * worst > 0.1)
    rows = [["bias_of_all_light", bias, error], ["bias_of_recovered_light", share, share_error],
            ["rms_of_blocks", rms, ""], ["worst_block", worst, ""]]
    return claims.exit_code(), rows


def draw(pictures, path):
    exact, mean = (np.mean([p[""] for p in pictures[which]], axis=0) for which in ("exact", "mean"))
    figure, panels = plt.subplots(1, 3, figsize=(13, 3.3))
    exposure = 1 / np.quantile(luminance(exact), 0.98)
    show(panels[0], exact, exposure, "exact transmittance")
    show(panels[1], mean, exposure, "mean extinction")
    show_difference(panels[2], mean - exact, 16 * exposure, "difference x16 (green: too dark, red: too bright)")
    figure.tight_layout()
    figure.savefig(path, dpi=80)
    plt.close(figure)


def figure(mote, quick, output):
    pictures = render(mote, quick)
    draw(pictures, output.with_suffix(".png"))
    code, rows = check(pictures)
    write_csv(output.with_suffix(".csv"), ["quantity", "value", "standard_error"], rows)
    return code


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
