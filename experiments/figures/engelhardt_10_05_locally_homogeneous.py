#!/usr/bin/python3
"""The medium taken for homogeneous inside the bounding region: Engelhardt 2013, Fig. 10.5.

The smoke room with two steps of compensation, with the exact transmittance inside the bounding region and with that of
the mean extinction; all else is the same, down to the VPLs. The difference, times 16, and its mean over several sets of
VPLs. The clean picture, by `mote_layers`, is for the eye alone. Exit code 0: all is as documented; 1: it is not; 2:
wrong usage, or mote is missing. A full run takes 3 minutes of one core, --quick 20 s.

    experiments/figures/engelhardt_10_05_locally_homogeneous.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
import panels
from claims import Claims
from measure import series_error
from panels import BAR, TITLE, Canvas, clean, enlarged, mark, show, show_difference
from renders import RECOVERED, approximate, luminance, main, mean_and_error, write_csv

VISIBLE = 0.02  # of the brightness: about the step that an eye distinguishes
BLOCK = 8  # pixels to a side, over which differences are averaged


def render(mote, quick):
    """By transmittance, the pictures of independent sets of VPLs."""
    common = {"resx": 48 if quick else 96, "resy": 32 if quick else 64, "paths": 60 if quick else 150,
              "integrator.eye_samples": 16 if quick else 32}
    return {which: [mote.render("smoke_room", which, common | approximate(
        2, transmittance=which, local_visibility=True, strategy="1-to-1-homogeneous"), passes=1 if quick else 3, seed=s)
        for s in range(3 if quick else 8)] for which in ("exact", "mean")}


def blocks(image):
    """The luminance of blocks of pixels."""
    return luminance(panels.blocks(image, BLOCK))


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
    # Pairs share their VPLs: the mean picture plus a pair's difference has the noise of that difference alone.
    brightness = np.mean([blocks(e[""]) for e in pictures["exact"]], axis=0)
    apart = [blocks(m[""] - e[""]) for e, m in pairs]
    rms = series_error([brightness + d for d in apart], [brightness])["systematic"]
    worst = np.abs(np.mean(apart, axis=0) / brightness).max()
    claims.check(f"nowhere does it show (blocks of {BLOCK} x {BLOCK} pixels, relative RMSE without noise)",
                 f"{100 * rms:.2f} %; the worst block, with noise, {100 * worst:.1f} %", rms < VISIBLE)
    claims.check("it shows when it is scaled by 16 (the worst block differs by over a tenth of its brightness then)",
                 f"{1600 * worst:.0f} %", 16 * worst > 0.1)
    rows = [["bias_of_all_light", bias, error], ["bias_of_recovered_light", share, share_error],
            ["relative_rmse_of_blocks", rms, ""], ["worst_block", worst, ""]]
    return claims.exit_code(), rows


def draw(pictures, clean, path):
    """The clean picture, and what was measured to differ with the mean extinction in it."""
    difference = np.mean([m[""] - e[""] for e, m in zip(pictures["exact"], pictures["mean"])], axis=0)
    height, width = clean.shape[:2]
    difference = enlarged(difference, 4, height, width)
    exposure = 0.8 / np.quantile(luminance(clean), 0.985)
    plume = slice(int(0.08 * height), int(0.83 * height)), slice(int(0.527 * width), int(0.767 * width))
    canvas = Canvas(1280, 858 + BAR)
    axes = canvas.panel(0, TITLE, 640, 400)
    show(axes, clean, exposure, "all light, by mote_layers, filtered; the frame is enlarged")
    mark(axes, plume)
    for i, (times, text) in enumerate(((0, "exact"), (1, "mean extinction"), (16, "16 times the difference"))):
        show(canvas.panel(648 + 213 * i, TITLE, 205, 400), (clean + times * difference)[plume], exposure, text)
    show_difference(canvas.panel(0, 2 * TITLE + 408, 636, 398), difference, exposure, 16, "difference, means over 4 x 4 pixels")
    show(canvas.panel(644, 2 * TITLE + 408, 636, 398), clean + 16 * difference, exposure,
         "the picture if the difference were 16 times as large")
    canvas.save(path)


def figure(mote, quick, output):
    pictures = render(mote, quick)
    picture = clean(mote, "smoke_room", {"resx": 160, "resy": 100} if quick else {"resx": 640, "resy": 400}, passes=32)
    draw(pictures, picture[""], output.with_suffix(".png"))
    code, rows = check(pictures)
    write_csv(output.with_suffix(".csv"), ["quantity", "value", "standard_error"], rows)
    return code


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
