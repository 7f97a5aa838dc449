#!/usr/bin/python3
"""Cost and use of octahedral maps: Engelhardt 2013, Table 7.1 and Fig. 7.6.

The program mote_surroundings casts depth maps in the layouts of the table, and blurs a mirrored environment by a
summed-area table over the whole sphere. The paper's numbers are frame rates of rasterization; rays need none of the
clipping that makes the difference there, and claims.py prints that claim as one that does not hold. Exit code 0: all is
as documented; 1: it is not; 2: wrong usage, or the program is missing. A full run takes 30 s, --quick 3 s.

    tools/build_release.sh mote_surroundings
    experiments/figures/engelhardt_07_octahedral.py [--quick] [--output FOLDER] [--bin FOLDER]
"""
import argparse
import csv
import io
import subprocess
import sys
from pathlib import Path

import numpy as np
import measure
from claims import Claims
from origin import ROOT, Origin
from panels import TITLE, Canvas, letters, show
from renders import finish

NAME = Path(__file__).stem
FOLDER = Path(__file__).resolve().parent
# Table 7.1, frames per second: planar square (S-Split), planar rectangle (XZ-Split), cube.
PAPER = {"square": 16, "rectangle": 34, "cube": 250}
PAPER_BUILD_MS = 3.3  # Fig. 7.6: a table of 512 * 512 on a GeForce 8800 GTX


def run(program, command, *options):
    scene = FOLDER / "scenes" / "bunnies.xml"
    arguments = [program, command, scene, *map(str, options)]
    output = subprocess.run(arguments, stdout=subprocess.PIPE, text=True, check=True).stdout
    return np.genfromtxt(io.StringIO(output), delimiter=",", names=True, dtype=None, encoding="utf-8")


def relative_error(r):
    """Relative RMSE of the means over boxes, against those over the lobe."""
    box, cone = (np.stack([[r[prefix + c]] for c in "rgb"], axis=2) for prefix in ("", "cone_"))
    return measure.error(box, [cone])


def check(layouts, views, build_ms):
    claims = Claims()
    seconds = {l["layout"]: l["seconds"] for l in layouts}
    ratio = {k: seconds[k] / seconds["cube"] for k in ("square", "rectangle")}
    paper = {k: PAPER["cube"] / PAPER[k] for k in ratio}
    for k in ratio:
        claims.check(f"a cube map is built {paper[k]:.1f} times as fast as an octahedral map, {k} layout",
                     f"{ratio[k]:.2f} times, {seconds[k] * 1e3:.0f} ms", ratio[k] > 0.8 * paper[k],
                     "the paper rasterizes and pays for splitting triangles at the octants; rays are cast here, texel "
                     "by texel, and there is nothing to split")
        claims.check(f"by rays, it costs what a cube map costs (within a factor of 1.5), {k} layout",
                     f"{ratio[k]:.2f} times", 1 / 1.5 < ratio[k] < 1.5)
    boxes, cones = ([1e6 * r[x][0] for r in views] for x in ("box_seconds", "cone_seconds"))
    claims.check("a summed-area table of the sphere gives any glossiness at the same cost",
                 f"{min(boxes):.2f} to {max(boxes):.2f} us, texel by texel {min(cones):.0f} us",
                 max(boxes) < 3 * min(boxes) and max(boxes) < 0.1 * min(cones))
    errors = [relative_error(r) for r in views]
    claims.check("a box represents a round lobe of the same solid angle (within 1/3 of the mean, root mean square)",
                 ", ".join(f"{100 * e:.0f} %" for e in errors), max(errors) < 1 / 3)
    print(f"                the table is built in {build_ms:.2f} ms (paper, 512 x 512: {PAPER_BUILD_MS} ms on a GPU)")
    return claims.exit_code()


def draw(views, pixels, path):
    """A mirror ball by boxes of the table and by round lobes, four lobes wide."""
    edge = 300
    canvas = Canvas(1280, TITLE + 2 * edge + 20)
    for column, r in enumerate(views):
        for row, (prefix, name) in enumerate((("", "summed areas"), ("cone_", "round lobes"))):
            image = np.ones((pixels, pixels, 3))
            image[r["row"], r["column"]] = np.stack([r[prefix + c] for c in "rgb"], axis=1)
            axes = canvas.panel(40 + 310 * column, TITLE + row * (edge + 10), edge, edge)
            show(axes, image, 1, None if row else f"{np.median(r['solid_angle']):.2g} sr")
            if column == 0:
                axes.set_ylabel(name, fontsize=letters(canvas.figure))
    canvas.save(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="small maps and pictures")
    parser.add_argument("--output", type=Path, default=ROOT / "out" / "figures")
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin", help="folder of the program")
    options = parser.parse_args()
    program = options.bin / "mote_surroundings"
    if not program.is_file():
        print(f"no {program}: build it first (tools/build_release.sh mote_surroundings)", file=sys.stderr)
        return 2
    measure.use(options.bin)
    size, pixels = (128, 48) if options.quick else (512, 120)
    layouts = run(program, "time", "--size", 512, "--repeat", 5 if options.quick else 15)
    reach = [max(size * x / 512, 2.0) for x in (2, 12, 40, 100)]  # less than a texel would be noise
    reflected = run(program, "reflect", "--size", size, "--pixels", pixels, "--reach", ",".join(map(str, reach)))
    views = [reflected[np.isclose(reflected["reach"], x)] for x in reach]
    build_ms = 1e3 * reflected["build_seconds"][0]

    options.output.mkdir(parents=True, exist_ok=True)
    output = options.output / (NAME + ("_quick" if options.quick else ""))
    with open(output.with_suffix(".csv"), "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["layout", "texels", "directions_ms", "ms", "paper_frames_per_second"])
        for l in layouts:
            table.writerow([l["layout"], l["texels"], f"{1e3 * l['directions_seconds']:.4g}",
                            f"{1e3 * l['seconds']:.4g}", PAPER[l["layout"]]])
        table.writerow(["reach_texels", "box_microseconds", "texel_by_texel_microseconds", "relative_rms", "build_ms"])
        for x, r in zip(reach, views):
            table.writerow([x, f"{1e6 * r['box_seconds'][0]:.3g}", f"{1e6 * r['cone_seconds'][0]:.4g}",
                            f"{relative_error(r):.4g}", f"{build_ms:.4g}"])
    draw(views, pixels, output.with_suffix(".png"))
    code = check(layouts, views, build_ms)
    finish(Origin(__file__, options.quick), output)
    return code


if __name__ == "__main__":
    sys.exit(main())
