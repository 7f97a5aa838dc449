#!/usr/bin/python3
"""Bidirectional paths and paths from the eye at equal time, and what a sample costs: Sun 2020, Figs. 5.7 to 5.10, Sec. 5.2.1.

The thesis counts D^2 + 3 D rays for a sample of bidirectional paths of D edges from either end, 2 D for a path from the eye, and
tests every connection; here one of an eye vertex's connections is sampled (`all_connections` tests them all), and rays are counted.
Six scenes: error^2 times processor seconds, against two long bidirectional pictures. A full run takes about 12
minutes of one core, --quick a minute.

    experiments/figures/sun_05_equal_time.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
import plotting
from claims import Claims
from panels import TITLE, Canvas, letter, show
from renders import luminance, main, write_csv
from two_ways import BOTH, EYE, OTHERS, errors, render

NAMES = ["mirror wall", "water caustic", *OTHERS, "smoke room"]
FEWER = ("most paths leave the box or end before D edges, and only pairs that face each other are tested")
COSTLY = ("a sample has a light path as well, its connections, and the densities of all techniques; no function takes more than 5 %")


def equal_time(mote, name, r, seconds, size, seed=9):
    """A picture of either in so many seconds of one core."""
    pictures = {}
    for k in (BOTH, EYE):
        passes = max(1, round(seconds * r[k]["passes"] / r[k]["seconds"]))
        pictures[k] = (render(mote, name, k, size, passes, seed, "equal"), passes)
    return pictures


def draw(results, frames, path):
    canvas = Canvas(1280, 2 * (TITLE + 424) + TITLE + 300)
    for i, (name, pictures) in enumerate(frames.items()):
        reference = results[name]["reference"]
        exposure = 0.7 / np.quantile(luminance(reference), 0.97)
        y = i * (TITLE + 424) + TITLE
        show(canvas.panel(1, y, 420, 420), reference, exposure, f"{name}: reference")
        for j, (k, text) in enumerate(((BOTH, "from both ends"), (EYE, "from the eye"))):
            picture, passes = pictures[k]
            show(canvas.panel(430 + 429 * j, y, 420, 420), picture[""], exposure, f"{text}, {passes} samples, equal time")
    bars(canvas.panel(90, 2 * (TITLE + 424) + 10, 1180, 230), {name: r["gain"] for name, r in results.items()})
    canvas.save(path)


def bars(axes, gains):
    """Time of paths from the eye over that of bidirectional paths, to the same error, by scene."""
    axes.bar(range(len(gains)), list(gains.values()), color=[plotting.GREEN if g > 1 else plotting.ORANGE_RED for g in gains.values()])
    axes.axhline(1, color="black", linewidth=0.8)
    axes.set(yscale="log", ylabel="time from the eye / from\nboth ends, to equal error", xlabel="scene")
    axes.set_xticks(range(len(gains)), list(gains))
    axes.yaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{v:g}"))
    letter(axes)


def figure(mote, quick, output):
    size, references = (48, 40) if quick else (128, 250)
    passes = {EYE: 16, BOTH: 6} if quick else {EYE: 64, BOTH: 24}
    claims, rows, results = Claims(), [], {}
    for name in NAMES:
        r = results[name] = errors(mote, name, size, passes, (1, 2, 3), references)
        for k in (EYE, BOTH):
            r[k]["passes"] = passes[k]
        cost = [r[k]["seconds"] / passes[k] for k in (EYE, BOTH)]
        work = [r[k]["error"] * r[k]["seconds"] for k in (EYE, BOTH)]
        r["gain"], r["ratio"] = work[0] / work[1], cost[1] / cost[0]
        print(f"{name}: from the eye {r[EYE]['error'] ** 0.5:.1%} after {r[EYE]['seconds']:.1f} s, from both ends "
              f"{r[BOTH]['error'] ** 0.5:.1%} after {r[BOTH]['seconds']:.1f} s; a sample costs {r['ratio']:.2f} times as much, "
              f"{r[BOTH]['rays'] / r[EYE]['rays']:.2f} times the rays; equal error in 1 / {r['gain']:.2f} of the time")
        rows.append([name, *(float(r[k][v]) for k in (EYE, BOTH) for v in ("error", "sigma", "seconds")), r["ratio"],
                     r[BOTH]["rays"] / r[EYE]["rays"], r["gain"]])
    frames = {name: equal_time(mote, name, results[name], 2 if quick else 8, size) for name in ("mirror wall", "water caustic")}
    depth = 4
    counted = {k: render(mote, "mirror wall", k, size, 8, 1, f"rays_{depth}", max_depth=depth, **more)
               for k, more in ((EYE, {}), (BOTH, {"all_connections": True}))}
    all_rays = [sum(counted[k].statistics["rays"].values()) for k in (EYE, BOTH)]
    claims.check(f"a sample takes 0.5 D + 1.5 times the rays, 3.5 for D = {depth} (within a quarter)",
                 f"{all_rays[1] / all_rays[0]:.2f}, all connections tested", abs(all_rays[1] / all_rays[0] / 3.5 - 1) < 0.25, FEWER)
    caustic = results["water caustic"]
    claims.check("at equal time the caustic is clearer", f"equal error in 1 / {caustic['gain']:.1f} of the time", caustic["gain"] > 1)
    if not quick:
        claims.check("a third of the time to equal error in three scenes of six",
                     ", ".join(f"{n} {r['gain']:.1f}" for n, r in results.items()), sum(r["gain"] >= 3 for r in results.values()) >= 3)
        worst = max(results, key=lambda n: results[n]["ratio"])
        claims.check("a sample costs at most 2.5 times one from the eye", f"{results[worst]['ratio']:.2f} ({worst})",
                     results[worst]["ratio"] <= 2.5, COSTLY)
    write_csv(output.with_suffix(".csv"), ["scene", "error2_eye", "sigma_eye", "seconds_eye", "error2_both_ends", "sigma_both_ends",
                                           "seconds_both_ends", "cost_of_a_sample", "rays_of_a_sample", "times_faster"], rows)
    draw(results, frames, output.with_suffix(".png"))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
