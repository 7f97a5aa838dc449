#!/usr/bin/python3
"""Three steps of screen-space bias compensation against exact compensation: Engelhardt 2013, Figs. 11.1 and 11.5.

A bunny and a pierced sculpture in a room represent the Buddha and the dragon, the atrium for Crytek Sponza. Exact
compensation (Kollig and Keller 2006) and screen space are given the same light paths. Differences are the relative RMSE
(measure.py) of blocks of 8 x 8 pixels of all light: 2 % is about the contrast that one begins to see. Times are compared at equal
error of pixels: exact compensation has no bias, and what it takes, at least, follows from its variance. The noise of the
exact pictures, known from seeds, is subtracted everywhere. Processor time. A full run takes about 6 minutes on two cores, --quick one.

    experiments/figures/engelhardt_11_05_ground_truth.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

import numpy as np
from claims import Claims
from measure import series_error
from occluders import sculpture
from panels import TITLE, Canvas, clean, enlarged, mark, show
from renders import compensation, luminance, main, mean_and_error, write_csv

SCENES = Path(__file__).resolve().parent / "scenes"
LAYER, BLOCK = "compensation_surface", 8
METHODS = {"exact": compensation("exact"), "screen space": compensation("screen_space", steps=3)}
PASSES = {"bunny": 32, "sculpture": 32, "atrium": 48}  # of the clean pictures
PIECES = {"bunny": (0.5, 0.5), "sculpture": (0.5, 0.5), "atrium": (0.7, 0.3)}  # where they begin, as shares of the width and height
# Most of what is missing in the atrium: docs/methods/compensation.md, Hidden surfaces.
HIDDEN = "backs of columns, balusters and leaves, and floors and leaves thinner than a pixel, are not in the picture"


def scenes(mote, quick):
    mesh = mote.folder / "sculpture.ply"
    sculpture(mesh, 60 if quick else 200)
    room = SCENES / "statue_room.xml"
    n = 2 if quick else 1
    size = {"resx": 320 // n, "resy": 240 // n}
    all_of_them = {"bunny": (room, {**size, "bound": 4}),
                   "sculpture": (room, {**size, "bound": 4, "format": "ply", "statue": mesh.resolve(), "size": 0.9, "height": 1.5}),
                   "atrium": ("atrium", {"resx": 320 // n, "resy": 200 // n, "extinction": 0, "bound": 1})}
    return {name: all_of_them[name] for name in (["bunny", "atrium"] if quick else all_of_them)}


def blocks(picture):
    height, width = (BLOCK * (n // BLOCK) for n in picture.shape[:2])
    return luminance(picture[:height, :width]).reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK).mean(axis=(1, 3))


def difference(found, exact, light):
    """Error of a layer in place of the exact one, relative to all light. The exact layer of each seed is taken out of the
    light in turn, so that what the seeds share is free of its noise, and their noise is that of one exact layer."""
    return series_error([light + found - e for e in exact], [light])


def measure(mote, name, scene, settings, quick):
    paths, passes, seeds = (32, 2, (1, 2)) if quick else (128, 4, (1, 2, 3))
    base = {"integrator": "mote_vpl", "integrator.paths": paths, **settings}
    pictures = {kind: [mote.render(scene, f"{name}_{kind}".replace(" ", "_"), {**base, **extra}, passes, seed=s) for s in seeds]
                for kind, extra in METHODS.items()}
    mean = lambda kind, layer: np.mean([p[layer] for p in pictures[kind]], axis=0)
    exact, truth, found = [p[LAYER] for p in pictures["exact"]], mean("exact", ""), mean("screen space", LAYER)
    taken, error = mean_and_error([e.mean() / truth.mean() for e in exact])
    light = blocks(truth)
    of_blocks = lambda picture: difference(blocks(picture), [blocks(e) for e in exact], light)["systematic"]
    pixels = difference(found, exact, truth)
    at_most = pixels["systematic"] + 2 * pixels["systematic_standard_error"]
    seconds = np.mean([p.value("compensation_thread_seconds") for p in pictures["exact"]])
    recovered = found.mean() / np.mean(exact)
    return {"mean": mean, "taken": taken, "taken_error": error, "recovered": recovered,
            "recovered_error": recovered * error / taken, "bounded": of_blocks(0 * found), "screen": of_blocks(found),
            "exact_seconds": seconds, "equal_seconds": seconds * (pixels["noise"] / at_most) ** 2,
            "screen_seconds": np.mean([p.value("ssbc_cpu_seconds") for p in pictures["screen space"]]),
            "vpl_seconds": np.mean([p.cpu for p in pictures["screen space"]])}


def draw(results, cleans, path):
    """A line for each scene: the clean picture and what is brought back. Below, the marked pieces of all three: the clean
    picture less what was measured to be missing."""
    heights = [round(421 * r["mean"]("exact", "").shape[0] / r["mean"]("exact", "").shape[1]) for r in results.values()]
    canvas = Canvas(1280, sum(heights) + (TITLE + 8) * len(results) + TITLE + 205)
    y, below = 0, sum(heights) + (TITLE + 8) * len(results) + TITLE
    for i, ((name, r), high) in enumerate(zip(results.items(), heights)):
        picture = cleans[name]
        height, width = picture.shape[:2]
        exposure = 0.6 / np.percentile(luminance(picture), 95)
        exact, found = r["mean"]("exact", LAYER), r["mean"]("screen space", LAYER)
        x, top = PIECES[name]
        piece = slice(int(top * height), int(top * height) + height * 3 // 8), slice(int(x * width), int(x * width) + height // 4)
        y += TITLE
        axes = canvas.panel(1, y, 421, high)
        show(axes, picture, exposure, f"{name}: all light, by mote_layers, filtered")
        mark(axes, piece)
        show(canvas.panel(430, y, 421, high), enlarged(exact, 2, high, 421), 4 * exposure,
             f"exact, x4, means over 2 x 2; equal error: {r['equal_seconds']:.0f} s")
        show(canvas.panel(859, y, 421, high), enlarged(found, 1, high, 421), 4 * exposure,
             f"three steps, x4: {r['recovered']:.0%}, {r['screen_seconds']:.2f} s")
        for k, (layer, title) in enumerate(((0 * exact, f"{name}: bounded"), (exact, "exact"), (found, "three steps"))):
            shown = picture + enlarged(layer - exact, 2, height, width)
            show(canvas.panel(1 + 429 * i + 142 * k, below, 137, 205), shown[piece], exposure, title)
        y += high + 8
    canvas.save(path.with_suffix(".png"))


def figure(mote, quick, output):
    claims, rows = Claims(), []
    results = {name: measure(mote, name, *scene, quick) for name, scene in scenes(mote, quick).items()}
    for name, r in results.items():
        ratio = r["screen_seconds"] / r["equal_seconds"]
        print(f"{name}: the bound took {r['taken']:.2%} +- {r['taken_error']:.2%} of the light; processor seconds: VPLs "
              f"{r['vpl_seconds']:.1f}, exact compensation {r['exact_seconds']:.2f}, screen space {r['screen_seconds']:.2f}; to equal error "
              f"exact compensation takes {r['equal_seconds']:.1f} or more")
        differs = HIDDEN if name == "atrium" else None
        claims.check(f"{name}: three steps bring back most of it", f"{r['recovered']:.1%} +- {r['recovered_error']:.1%}",
                     r["recovered"] > 0.5, differs)
        claims.check(f"{name}: the picture is nearly that of exact compensation: 2 % or less in blocks",
                     f"{r['screen']:.2%}, bounded {r['bounded']:.2%}", r["screen"] <= 0.02, differs)
        if not quick:  # there pictures are too noisy to decide
            claims.check(f"{name}: at a small fraction of its time, at equal error: a tenth at most", f"{ratio:.1%}", ratio <= 0.1,
                         differs and "screen space stays at an error there to which exact compensation comes down soon")
        rows.append([name, *(float(r[k]) for k in ("taken", "taken_error", "recovered", "recovered_error", "bounded", "screen",
                                                   "vpl_seconds", "exact_seconds", "equal_seconds", "screen_seconds"))])
    write_csv(output.with_suffix(".csv"), ["scene", "taken_by_the_bound", "standard_error", "recovered", "standard_error_recovered",
                                           "difference_bounded", "difference_screen_space", "seconds_vpls",
                                           "seconds_exact_compensation", "seconds_exact_to_equal_error",
                                           "seconds_screen_space"], rows)
    cleans = {name: clean(mote, scene, settings | ({} if quick else {"resx": 421, "resy": 421 * settings["resy"] // settings["resx"]}),
                          16 if quick else PASSES[name], f"clean_{name}")[""]
              for name, (scene, settings) in scenes(mote, quick).items()}
    draw(results, cleans, output)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
