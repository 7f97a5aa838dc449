#!/usr/bin/python3
"""Bidirectional paths against paths from the eye in three Cornell boxes: Sun 2020, Figs. 5.1 to 5.6.

Two mirroring spheres; a mirror as the back wall; waves that throw the light of a lamp onto the walls. Equal numbers of samples,
as in the thesis. Errors are the relative RMSE (measure.py) of all but the brightest 0.1 % of the pixels, against two long
bidirectional pictures. A full run takes about 5 minutes of one core, --quick half a minute.

    experiments/figures/sun_05_cornell.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from claims import Claims
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv
from two_ways import BOTH, EYE, SUN, errors


def draw(results, path):
    canvas = Canvas(1280, 3 * (TITLE + 424))
    for i, (name, r) in enumerate(results.items()):
        exposure = 0.7 / np.quantile(luminance(r["reference"]), 0.97)
        y = i * (TITLE + 424) + TITLE
        pictures = [(r["reference"], f"{name}: reference")] + [
            (r[k]["pictures"][0][""], f"{title}, {r[k]['error'] ** 0.5:.0%}")
            for k, title in ((BOTH, "from both ends"), (EYE, "from the eye"))]
        for j, (picture, title) in enumerate(pictures):
            show(canvas.panel(1 + 429 * j, y, 420, 420), picture, exposure, title)
    canvas.save(path)


def figure(mote, quick, output):
    size, passes, references = (64, 4, 40) if quick else (210, 16, 250)
    claims, rows = Claims(), []
    results = {name: errors(mote, name, size, {EYE: passes, BOTH: passes}, (1, 2, 3), references) for name in SUN}
    for name, r in results.items():
        both, eye = r[BOTH], r[EYE]
        claims.check(f"{name}: less noise from both ends with as many samples",
                     f"{both['error'] ** 0.5:.1%} instead of {eye['error'] ** 0.5:.1%}", both["error"] < eye["error"])
        rows.append([name, float(both["error"] ** 0.5), float(eye["error"] ** 0.5), float(both["seconds"]), float(eye["seconds"])])
    ratio = results["water caustic"][EYE]["error"] / results["water caustic"][BOTH]["error"]
    claims.check("the caustic on the walls gains most: its variance falls to a tenth and less", f"1 : {ratio:.0f}", ratio > 10)
    write_csv(output.with_suffix(".csv"), ["scene", "error_both_ends", "error_eye", "seconds_both_ends", "seconds_eye"], rows)
    draw(results, output.with_suffix(".png"))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
