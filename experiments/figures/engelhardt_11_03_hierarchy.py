#!/usr/bin/python3
"""Samples of screen-space bias compensation against levels of the hierarchy, and its share of the time: Engelhardt 2013,
Fig. 11.3.

Pictures of 1024 x 768 pixels. (a) The bound is chosen so that the sum over pixels alone takes thousands of samples a pixel
where it takes most, as in the thesis; its radius is 0.3 times that of the scene. (b) Two steps with 6 levels beside direct
light and 1024 virtual point lights at every pixel, and with the bound that goes with 1024 light paths; processor time.
Pictures of the scenes are by `mote_layers`. A full run takes about 8 minutes of one core, --quick half a minute.

    experiments/figures/engelhardt_11_03_hierarchy.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import csv
import re
import sys
from pathlib import Path

import numpy as np
import plotting
from claims import Claims
from occluders import sculpture
from origin import table_of
from panels import TITLE, Canvas, clean, letter, show
from renders import luminance, main, write_csv

SCENES = Path(__file__).resolve().parent / "scenes"
LEVELS = [1, 2, 3, 4, 5, 6]
# Radius of all shapes [m], which the automatic bound goes by.
RADIUS = {"Cornell box": 4.8, "bunny": 4.6, "sculpture": 4.6, "atrium": 21.0}


def scenes(mote, quick):
    mesh = mote.folder / "sculpture.ply"
    sculpture(mesh, 60 if quick else 200)
    room = SCENES / "statue_room.xml"
    statue = {"format": "ply", "statue": mesh.resolve(), "size": 0.9, "height": 1.5}
    all_of_them = {"Cornell box": ("cornell_box", {}), "bunny": (room, {}), "sculpture": (room, statue),
                   "atrium": ("atrium", {"extinction": 0})}
    return {name: all_of_them[name] for name in (list(all_of_them)[:2] if quick else all_of_them)}


def ssbc(mote, source, *options):
    """Samples a gathered pixel, and processor seconds."""
    _, said, seconds = mote.ssbc(source, "ssbc", *options)
    return float(re.search(r"([\d.]+) samples each", said).group(1)), seconds


def measure(mote, name, scene, settings, size, paths):
    tag = name.replace(" ", "_")
    settings = {**settings, "resx": size[0], "resy": size[1], "integrator": "mote_vpl",
                "integrator.bound": paths / RADIUS[name] ** 2}
    direct = mote.render(scene, f"{tag}_direct", {**settings, "integrator.paths": 0}, passes=1, auxiliary=True)
    vpls = mote.render(scene, f"{tag}_vpls", {**settings, "integrator.paths": paths}, passes=1, auxiliary=True)
    source = mote.folder / f"{tag}_vpls_1.exr"
    wide = 11 / RADIUS[name] ** 2
    samples = [ssbc(mote, source, "--bound", wide, "--steps", 1, "--levels", level)[0] for level in LEVELS]
    # Time of two steps alone: the difference takes off reading, writing and the buffers.
    seconds = {}
    for kind, bound in (("wide", wide), ("automatic", 1024 / RADIUS[name] ** 2)):
        one, three = (ssbc(mote, source, "--bound", bound, "--steps", n)[1] for n in (1, 3))
        seconds[kind] = three - one  # two steps
    per_vpl = max(vpls.cpu - direct.cpu, 0) / max(vpls.vpls, 1)
    return {"samples": samples, "direct": direct.cpu, "vpls": 1024 * per_vpl, **seconds}


def draw(results, cleans, path):
    canvas = Canvas(1280, 2 * TITLE + 236 + 8 + 420)
    for i, (name, picture) in enumerate(cleans.items()):
        show(canvas.panel(1 + 321 * i, TITLE, 315, 236), picture, 0.6 / np.percentile(luminance(picture), 95), name)
    plots(canvas.panel(80, TITLE + 254, 540, 376), canvas.panel(710, TITLE + 254, 562, 376), results)
    canvas.save(path.with_suffix(".png"))


def plots(left, right, results):
    """Samples by the levels that are summed, and where the time goes."""
    for (name, r), colour in zip(results.items(), (plotting.BLUE, plotting.ORANGE, plotting.GREEN, plotting.ORANGE_RED)):
        left.semilogy(LEVELS, r["samples"], "o-", linewidth=2, label=name, color=colour)
    left.set(xlabel="levels that are summed (1: pixels alone)", ylabel="samples a gathered pixel")
    left.grid(alpha=0.3)
    left.legend()
    names = list(results)
    below = [0.0] * len(names)
    for key, label, colour in (("direct", "primary rays, direct light", plotting.SKY), ("vpls", "1024 VPLs", plotting.colour("mote VPL")),
                               ("wide", "two steps, wide bound", plotting.colour("VPL, 2 steps"))):
        total = [r["direct"] + r["vpls"] + r["wide"] for r in results.values()]
        share = [100 * r[key] / t for r, t in zip(results.values(), total)]
        right.bar(names, share, bottom=below, label=label, color=colour)
        below = [b + s for b, s in zip(below, share)]
    right.set(xlabel="scene", ylabel="share of the processor time [%]", ylim=(0, 130), yticks=range(0, 101, 20))
    right.legend(loc="upper center", ncols=2)
    letter(left), letter(right)


# The thesis does not say how fine its scenes are. These two have surfaces of a few pixels everywhere.
FINE = "nodes that span a discontinuity are refined, and where surfaces are a few pixels wide nearly all of them do"
KEYS = ["direct", "vpls", "wide", "automatic"]


def read(path):
    """The numbers of the last run."""
    table = [row for row in csv.reader(table_of(path).splitlines())]
    end = [row[0] for row in table].index("claim")
    rows = [[row[0], *map(float, row[1:])] for row in table[1:end]]
    return {row[0]: {"samples": row[1:1 + len(LEVELS)], **dict(zip(KEYS, row[1 + len(LEVELS):]))} for row in rows}


def figure(mote, quick, output):
    size, paths = ((384, 288), 16) if quick else ((1024, 768), 32)
    claims, rows = Claims(), []
    if mote.redraw:
        results = read(output.with_suffix(".csv"))
    else:
        results = {name: measure(mote, name, *scene, size, paths) for name, scene in scenes(mote, quick).items()}
    for name, r in results.items():
        print(f"{name}: {', '.join(f'{s:.0f}' for s in r['samples'])} samples with {LEVELS[0]} to {LEVELS[-1]} levels; direct "
              f"light {r['direct']:.1f} s, 1024 VPLs {r['vpls']:.1f} s, two steps {r['wide']:.2f} s and, automatic bound, "
              f"{r['automatic']:.2f} s")
        rows.append([name, *r["samples"], *(float(r[key]) for key in KEYS)])
        claims.check(f"{name}: samples a pixel fall with every level up to the fourth",
                     ", ".join(f"{s:.0f}" for s in r["samples"][:4]), all(a > b for a, b in zip(r["samples"], r["samples"][1:4])))
        fine = FINE if name in ("sculpture", "atrium") else None
        claims.check(f"{name}: four levels leave less than a {'half' if quick else 'fifth'} of the samples",
                     f"{r['samples'][3] / r['samples'][0]:.1%}", r["samples"][3] < r["samples"][0] / (2 if quick else 5), fine)
        if quick:
            continue
        claims.check(f"{name}: two steps take at most a tenth of the time of 1024 VPLs, with the bound that goes with them",
                     f"{r['automatic'] / r['vpls']:.1%}", r["automatic"] <= 0.1 * r["vpls"])
        claims.check(f"{name}: and a moderate part of it, less than half, with the wide one", f"{r['wide'] / r['vpls']:.1%}",
                     r["wide"] <= 0.5 * r["vpls"], fine)
    write_csv(output.with_suffix(".csv"), ["scene", *(f"samples_{n}_levels" for n in LEVELS), "seconds_direct", "seconds_1024_vpls",
                                           "seconds_two_steps", "seconds_two_steps_automatic_bound"], rows)
    size, passes = ({"resx": 80, "resy": 60}, 16) if quick else ({"resx": 315, "resy": 236}, 64)
    cleans = {name: clean(mote, scene, {**settings, **size}, passes, f"clean_{name.replace(' ', '_')}")[""]
              for name, (scene, settings) in scenes(mote, quick).items()}
    draw(results, cleans, output)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
