#!/usr/bin/python3
"""Compensation that does not look for surfaces: Engelhardt 2013, Fig. 10.8.

Two steps of compensation with and without local visibility, all else the same and exact, down to the VPLs: in the smoke
room, and beside a thin wall in thin fog with light on one side only, where light should bleed through if anywhere. What
is left out works both ways: surfaces hide light, and they reflect it. The clean pictures, by `mote_layers`, are for
the eye alone. Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes 6
minutes of one core, --quick 40 s.

    experiments/figures/engelhardt_10_08_visibility.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

import numpy as np
from claims import Claims
from panels import BAR, TITLE, Canvas, clean, enlarged, show, show_difference
from renders import RECOVERED, approximate, luminance, main, mean_and_error, write_csv

WALL = Path(__file__).resolve().parent / "scenes" / "thin_wall.xml"
SCALE = 512  # of the paper's difference
VISIBLE = 0.02  # of the brightness: about the step that an eye distinguishes
STRIPS = 12  # of the wall's picture, upright: the wall is between the sixth and the seventh
LIT, SHADED = 5, 6


def render(mote, quick):
    """By scene, pairs of pictures with and without visibility, for independent sets of VPLs."""
    seeds = {"room": 3, "dark wall": 3, "light wall": 3 if quick else 6}  # the noise of its far strips decides the last claim
    cases = {"room": ("smoke_room", {"resx": 48, "resy": 32} if quick else {"resx": 72, "resy": 48},
                      {"paths": 60, "integrator.eye_samples": 32}, 1 if quick else 2),
             "dark wall": (WALL, {"resx": 48, "resy": 16} if quick else {"resx": 96, "resy": 64},
                           {"paths": 40, "wall": 0.05, "integrator.eye_samples": 8}, 16 if quick else 8),
             "light wall": (WALL, {"resx": 48, "resy": 16} if quick else {"resx": 96, "resy": 64},
                            {"paths": 40, "wall": 0.8, "integrator.eye_samples": 8}, 4)}
    return {case: [[mote.render(scene, f"{case.replace(' ', '_')}_{looks}".lower(),
                                size | settings | approximate(2, transmittance="exact", local_visibility=looks),
                                passes=passes, seed=s) for looks in (True, False)] for s in range(seeds[case])]
            for case, (scene, size, settings, passes) in cases.items()}


def strips(image):
    l = luminance(image).mean(axis=0)
    return l.reshape(STRIPS, len(l) // STRIPS).mean(axis=1)


def check(pairs):
    """The claims; rows of the table."""
    claims, rows = Claims(), []
    biases = {}
    for case, pictures in pairs.items():
        total = np.mean([luminance(a[""]).mean() for a, _ in pictures])
        recovered = np.mean([luminance(a[RECOVERED]).mean() for a, _ in pictures]) / total
        biases[case] = mean_and_error([luminance(b[""] - a[""]).mean() / total for a, b in pictures])
        rows.append([case, "whole picture", *biases[case], recovered])
    bias, error = biases["room"]
    claims.check("omitting local visibility does not show: room, less than 0.4 % of the brightness",
                 f"bias {100 * bias:+.3f} +- {100 * error:.3f} %", abs(bias) + 3 * error < 0.004)
    claims.check(f"it shows when it is scaled by {SCALE}", f"{SCALE * abs(bias):.2f} of the brightness",
                 SCALE * (abs(bias) - 3 * error) > VISIBLE)
    local = {}
    for case in ("dark wall", "light wall"):
        brightness = np.mean([strips(a[""]) for a, _ in pairs[case]], axis=0)
        local[case] = mean_and_error([strips(b[""] - a[""]) / brightness for a, b in pairs[case]])
        rows += [[case, f"strip {i}", *map(float, (local[case][0][i], local[case][1][i])), ""] for i in range(STRIPS)]

    def text(case, strip):
        return f"{100 * local[case][0][strip]:+.1f} +- {100 * local[case][1][strip]:.1f} %"

    leak, leak_error = (x[SHADED] for x in local["dark wall"])
    claims.check("no artefact shows beside a thin dark wall either (its shaded side)", text("dark wall", SHADED),
                 leak + 3 * leak_error < VISIBLE,
                 "within the bounding radius (0.5 m, a strip is 0.39 m wide) lies light that is five times as strong: the "
                 "unfavourable case that the paper describes and did not meet")
    claims.check("what bleeds through makes it brighter", text("dark wall", SHADED), leak > 3 * leak_error)
    loss, loss_error = (x[LIT] for x in local["light wall"])
    claims.check("no artefact shows in front of a light wall", text("light wall", LIT), abs(loss) < VISIBLE,
                 "surfaces also reflect: the light that a wall sends over a short distance into the fog is not found "
                 "when nothing looks for the wall; the paper speaks of occlusion alone")
    far = [i for i in range(STRIPS) if abs(i - 5.5) > 2]
    farthest = max(abs(x[0][i]) + 3 * x[1][i] for x in local.values() for i in far)
    claims.check("farther away than the bounding radius it does not matter (less than 0.5 %)",
                 f"at most {100 * farthest:.2f} %, three standard errors included", farthest < 0.005)
    return claims.exit_code(), rows


def draw(pairs, cleans, path):
    """A line for each case: a clean picture, without visibility (where that shows), and differences. The room is by
    mote_layers; of the fog beside the walls, what scatters more than once is the mean of the VPLs' pictures."""
    canvas = Canvas(1280, 3 * (TITLE + BAR) + 263 + 2 * 281 + 16)
    y = 0
    for case, pictures in pairs.items():
        picture = cleans[case]
        height, width = picture[""].shape[:2]
        difference = np.mean([blind[""] - looks[""] for looks, blind in pictures], axis=0)
        if case == "room":
            picture = picture[""]
        else:  # fog alone is as smooth as a coarse picture of it
            multiple = np.mean([looks.multiple() for looks, _ in pictures], axis=0)
            picture = picture[""] - picture.multiple() + enlarged(multiple, 2, height, width)
        exposure = 0.8 / np.quantile(luminance(picture), 0.97)
        y += TITLE
        high = 263 if case == "room" else 281
        column = [canvas.panel(429 * i + 1, y, 421, high) for i in range(3)]
        show(column[0], picture, exposure, f"{case}: with local visibility")
        if case != "room":
            show(column[1], picture + enlarged(difference, 2, height, width), exposure, "without")
        for axes, scale in zip(column[1 if case == "room" else 2:], (16, SCALE)):
            n = 4 if case == "room" else 2
            show_difference(axes, enlarged(difference, n, height, width), exposure, scale,
                            f"difference, means over {n} x {n} pixels")
        y += high + BAR + 8
    canvas.save(path)


def figure(mote, quick, output):
    pairs = render(mote, quick)
    room, wall = ({"resx": 160, "resy": 100}, {"resx": 150, "resy": 100}) if quick else (
        {"resx": 640, "resy": 400}, {"resx": 421, "resy": 281})
    cleans = {"room": clean(mote, "smoke_room", room, passes=32),
              "dark wall": clean(mote, WALL, wall | {"wall": 0.05}, 160, "clean_dark"),
              "light wall": clean(mote, WALL, wall | {"wall": 0.8}, 160, "clean_light")}
    draw(pairs, cleans, output.with_suffix(".png"))
    code, rows = check(pairs)
    write_csv(output.with_suffix(".csv"), ["scene", "where", "relative_bias", "standard_error", "recovered_share"], rows)
    return code


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
