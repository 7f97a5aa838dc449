#!/usr/bin/python3
"""Imperfect ray-bundles against exact ones, their time and their error: Tokuyoshi & Ogaki 2012b (poster), Fig. 1.

The poster has 128 x 128 rays and 16384 points a direction on a GPU, where imperfect bundles are about 6 times as fast. Exact
ones here are the faster of two forms, on one core; errors are shares of links (front to front or back, both sides send): of
the exact bundle's, those that the imperfect one misses, and of its own those that are not there. Stand-ins for the animated
scene, which is not public: atrium (263,000 triangles) and city (825,000). Exit code 0: all is as documented; 1: it is not;
2: wrong usage, or the program is missing. A full run takes three minutes, --quick 40 s.

    tools/build_release.sh mote_study_ray_bundles
    experiments/figures/tokuyoshi_b_imperfect.py [--quick] [--output FOLDER] [--bin FOLDER]
"""
import sys

import plotting
from bundle_times import main, write_table
from claims import Claims
from origin import ROOT, tables_of

SCENES = ("atrium", "city")
# Rays across the scene's diagonal, and points. 176: about 128 x 128 rays, as in the poster.
SIZES = ((32, 1024), (64, 4096), (128, 8192), (176, 16384), (256, 16384))
SPLATS = (0.7, 1.0, 1.4, 2.0)
POINTS = (1024, 4096, 16384, 65536)


def measure(times, scene, side, points, splat, directions):
    """A row with the time of both and the error."""
    exact, imperfect = times.rows(ROOT / "scenes" / f"{scene}.xml", ["automatic", "imperfect"], [side], directions,
                                  "--points", points, "--splat", splat, "--two-sided")
    return {"scene": scene, "side": side, "rays": exact["rays"], "points": points, "splat": splat,
            "exact_ms": exact["ms_per_direction"], "imperfect_ms": imperfect["ms_per_direction"],
            "ratio": exact["ms_per_direction"] / imperfect["ms_per_direction"], "missing": imperfect["missing"],
            "wrong": imperfect["wrong"]}


def figure(times, quick, output):
    directions = 8 if quick else 192
    sizes = SIZES[1:4:2] if quick else SIZES
    rows = []
    for scene in SCENES:
        rows += [measure(times, scene, side, points, 1.0, directions) for side, points in sizes]
        rows += [measure(times, scene, 64, 4096, splat, directions) for splat in SPLATS if splat != 1.0]
        rows += [measure(times, scene, 64, points, 1.0, directions) for points in POINTS if points != 4096]
    write_table(output.with_name(output.name + ".csv"), rows)
    plot_table(output.with_name(output.name + ".csv"), output.with_name(output.name + ".png"))
    return check(rows)


def select(rows, scene, **values):
    return [r for r in rows if r["scene"] == scene and all(r[k] == v for k, v in values.items())]


def check(rows):
    claims = Claims()
    for scene in SCENES:
        coarse, = select(rows, scene, side=64, points=4096, splat=1.0)
        claims.check(f"{scene}: imperfect bundles are several times as fast, at least four",
                     f"{coarse['ratio']:.1f} times, {coarse['rays']:.0f} rays and 4096 points; "
                     f"{100 * coarse['missing']:.0f} % of the links missing, {100 * coarse['wrong']:.0f} % of those found wrong",
                     coarse["ratio"] >= 4.0)
        poster, = select(rows, scene, side=176, points=16384, splat=1.0)
        claims.check(f"{scene}: about 6 times as fast with 128 x 128 rays and 16384 points",
                     f"{poster['ratio']:.1f} times", poster["ratio"] >= 4.0,
                     None if scene == "city" else "the exact scan takes less than 100 ns a hit where triangles are larger "
                     "than rays are apart; it is where they are many more that points pay")
        splats = sorted(select(rows, scene, side=64, points=4096), key=lambda r: r["splat"])
        claims.check(f"{scene}: larger splats close holes", ", ".join(f"{100 * r['missing']:.0f} %" for r in splats) +
                     " missing at sizes " + ", ".join(f"{r['splat']:g}" for r in splats),
                     all(a["missing"] > b["missing"] for a, b in zip(splats, splats[1:])))
        claims.check(f"{scene}: at the expense of redundant nodes",
                     ", ".join(f"{r['imperfect_ms']:.2f} ms" for r in splats) + "; wrong links " +
                     ", ".join(f"{100 * r['wrong']:.0f} %" for r in splats), splats[-1]["imperfect_ms"] > splats[0]["imperfect_ms"])
        points = sorted(select(rows, scene, side=64, splat=1.0), key=lambda r: r["points"])
        claims.check(f"{scene}: more points are nearer to the exact bundle",
                     ", ".join(f"{100 * r['missing']:.0f} and {100 * r['wrong']:.0f} %" for r in points) +
                     " missing and wrong with " + ", ".join(str(r["points"]) for r in points),
                     points[-1]["missing"] < points[0]["missing"] and points[-1]["wrong"] < points[0]["wrong"])
    return claims.exit_code()


def plot_table(table, path):
    """Speed by the number of rays, and links that are missing and wrong, by the size of splats and by the number of points."""
    rows, = tables_of(table)
    made, (speed, splat, points) = plotting.figure(columns=3, height=400)
    for scene, colour in zip(SCENES, (plotting.BLUE, plotting.ORANGE_RED)):
        by_size = [r for r in select(rows, scene, splat=1.0) if (r["side"], r["points"]) in SIZES]
        speed.plot([r["rays"] for r in by_size], [r["ratio"] for r in by_size], "o-", color=colour, label=scene)
        for axes, key, chosen in ((splat, "splat", select(rows, scene, side=64, points=4096)),
                                  (points, "points", select(rows, scene, side=64, splat=1.0))):
            chosen = sorted(chosen, key=lambda r: r[key])
            for share, style in (("missing", "o-"), ("wrong", "o--")):
                axes.plot([r[key] for r in chosen], [100 * r[share] for r in chosen], style, color=colour, label=f"{scene}, {share}")
    speed.axhline(4, color="0.7", zorder=0)
    speed.set(xscale="log", xlabel="rays", ylabel="time of exact bundles / of imperfect", ylim=(0, None))
    splat.set(xlabel="size of splats", ylabel="share of links [%]", ylim=(0, 100), title="4096 points")
    points.set(xscale="log", xlabel="points", ylabel="share of links [%]", ylim=(0, 100), title="size of splats 1")
    for axes in (speed, splat):
        axes.legend(fontsize=10)
    plotting.save(made, path)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
