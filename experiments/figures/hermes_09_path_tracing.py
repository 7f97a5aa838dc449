#!/usr/bin/python3
"""Global ray-bundles against path tracing in a room under a sky: Hermes 2010, Fig. 9.

The paper has identical radiance after 178 s on a graphics card (4000 directions) and 27 minutes of path tracing, which is still
noisy. Here both run on the same processor, in seconds of its threads. Path tracing has no bias, so its time to an error follows
from the one that was measured; ray-bundles are rendered until they are there. A full run takes about 12 minutes on two quiet
cores, --quick one minute.

    experiments/figures/hermes_09_path_tracing.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_rooms import BUNDLES, ROOM, bias, draw, error_of_two
from claims import Claims
from renders import main, write_csv


def figure(mote, quick, output):
    claims, rows = Claims(), []
    n = 2 if quick else 1
    size = {"resx": 320 // n, "resy": 200 // n}
    aim = 0.06 if quick else 0.02
    references = [mote.render(ROOM, f"reference_{k}", size | {"integrator": "path"}, passes=150 if quick else 600, seed=8 + k) for k in (1, 2)]
    path = mote.render(ROOM, "path", size | {"integrator": "path"}, passes=32 if quick else 128)
    atlas = {"integrator.directions": 512 if quick else 2048, "integrator.texel_budget": 16384 if quick else 131072,
             "integrator.eye_samples": 4}
    bundles = mote.render(ROOM, "bundles", size | BUNDLES | atlas, passes=2 if quick else 8)
    for name, picture in {"path": path, "bundles": bundles}.items():
        light = picture[""].mean() / np.mean([r[""].mean() for r in references]) - 1
        rows.append([name, picture.passes, picture.cpu, error_of_two(picture, references), light])
        print(f"{name}: {picture.cpu:.1f} s, error {rows[-1][3]:.2%}, light {rows[-1][4]:+.2%}")
    to_aim = path.cpu * (rows[0][3] / aim) ** 2
    same = path.cpu * (rows[0][3] / rows[1][3]) ** 2
    claims.check("identical radiance: all light within 1 %", f"{rows[1][4]:+.2%}", abs(rows[1][4]) < 0.01)
    claims.check(f"ray-bundles come to an error of {aim:.0%}", f"{rows[1][3]:.2%}", rows[1][3] <= aim)
    claims.check("a third of path tracing's time to the same error, at most",
                 f"{bundles.cpu:.1f} s against {same:.0f} s: {bundles.cpu / same:.1%}", bundles.cpu <= same / 3)
    write_csv(output.with_suffix(".csv"), ["method", "passes", "processor_seconds", "error", "light"], rows)
    draw(output, [(f"ray-bundles, {bundles.cpu:.0f} s: error {rows[1][3]:.1%}", bundles[""]),
                  (f"path tracing, {path.cpu:.0f} s: error {rows[0][3]:.1%}; {to_aim:.0f} s to {aim:.0%}", path[""])])
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
