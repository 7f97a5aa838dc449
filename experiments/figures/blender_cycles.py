#!/usr/bin/python3
"""Scenes of Blender rendered by Cycles and, through the add-on, by mote, side by side: means and time to equal error.

Three scenes that both can hold, and one with what users do (glass, a picture as a texture, smoke of a .vdb file). A full run takes
about 5 minutes, --quick half a minute. It needs the program `blender`.

    experiments/figures/blender_cycles.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import json
import subprocess
import sys

import numpy as np
from blender_runs import PATH, SCENES, agreement, blender, log_of, run
from claims import Claims
from origin import ROOT
from panels import BAR, Canvas, blocks, show, show_difference
from renders import luminance, main, write_csv

WIDTH, HEIGHT, BLOCK, SCALE = 416, 234, 8, 20  # of a panel [pixels]; of the means in the last column; and its factor


def version(words):
    said = subprocess.run([words[0], "--version"], capture_output=True, text=True, check=True, env={"PATH": PATH})
    return said.stdout.split("\n")[0]


def figure(mote, quick, output):
    words = blender()
    if words is None:
        print("blender_cycles.py: no program 'blender' on the path", file=sys.stderr)
        return 2
    width, samples, seeds = (96, 16, 3) if quick else (192, 64, 4)
    if mote.redraw and all((mote.folder / f"{scene}.json").is_file() for scene in SCENES):
        found = {scene: log_of(mote.folder, scene) for scene in SCENES}
    else:
        found = run(words, mote.program, mote.folder, width, samples, seeds)
    claims, rows, program = Claims(), [], program_of(mote)
    for scene, log in found.items():
        for seed in range(1, seeds + 1):
            mote.origin.add(scene, f"{scene}.blend", {"engines": f"{version(words)} Cycles, volpath", "width": width}, samples, seed,
                            program)
        a = agreement(log)
        rows.append([scene, *a.values()])
        holds = abs(a["difference"]) < 0.01 + (4 * a["standard_error"] if quick else 0)
        claims.check(f"{scene}: means within 1 %", f"{a['difference']:+.2%} +- {a['standard_error']:.2%}", holds)
    write_csv(output.with_suffix(".csv"), ["scene", *a], rows)
    draw(output.with_suffix(".png"), found)
    return claims.exit_code()


def program_of(mote):
    """The commit of the program: the statistics of any picture have it."""
    path = mote.folder / "program.exr"
    subprocess.run([mote.program, "render", ROOT / "scenes" / "cornell_box.xml", "-o", path, "--passes", "1", "-D", "resx=16",
                    "-D", "resy=16", "--quiet", "--stats", path.with_suffix(".json")], check=True)
    return {"git_hash": json.loads(path.with_suffix(".json").read_text())["git_hash"]}


def draw(path, found):
    step = HEIGHT + 34 + BAR
    canvas = Canvas(3 * WIDTH + 40, len(found) * step + 10)
    for row, (scene, log) in enumerate(found.items()):
        pictures = {name: log[name]["pictures"].mean(axis=0) for name in ("Cycles", "mote")}
        exposure = 0.7 / np.percentile(luminance(pictures["Cycles"]), 90)
        panel = lambda column: canvas.panel(10 + column * (WIDTH + 10), row * step + 28, WIDTH, HEIGHT)
        show(panel(0), pictures["Cycles"], exposure, f"Cycles: {SCENES[scene]}")
        show(panel(1), pictures["mote"], exposure, "mote")
        apart = blocks(padded(pictures["mote"] - pictures["Cycles"]), BLOCK)
        show_difference(panel(2), apart, exposure, SCALE, f"difference, means of {BLOCK} x {BLOCK} pixels")
    canvas.save(path)


def padded(image):
    return np.pad(image, [(0, -image.shape[0] % BLOCK), (0, -image.shape[1] % BLOCK), (0, 0)], mode="edge")


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
