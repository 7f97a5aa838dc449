#!/usr/bin/python3
"""Glossy surfaces that light others, against a glossy bounce towards the eye alone: Hermes 2010, Fig. 8.

With the next direction known, glossy texels send on what they received; without, they are dark to all but the eye, and the light
that they throw on floor, block and each other is missing. A full run takes about 6 minutes, --quick less than one.

    experiments/figures/hermes_08_glossy.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

from bundle_rooms import BUNDLES, bias, draw, error
from claims import Claims
from renders import main, write_csv

SCENE = Path(__file__).resolve().parent / "scenes" / "glossy_balls.xml"


def figure(mote, quick, output):
    claims, rows, found = Claims(), [], {}
    n = 2 if quick else 1
    size = {"resx": 320 // n, "resy": 200 // n}
    reference = mote.render(SCENE, "reference", size | {"integrator": "path"}, passes=300 if quick else 2000, seed=9)
    settings = {"integrator.texel_budget": 8192 if quick else 32768, "integrator.eye_samples": 16, "integrator.directions": 256}
    for glossy in [False, True]:
        p = mote.render(SCENE, f"glossy_{glossy}", size | BUNDLES | settings | {"integrator.glossy_transfer": glossy},
                        passes=2 if quick else 96)
        found[glossy] = p
        rows.append([glossy, p.cpu, error(p, reference), bias(p, reference, "indirect")])
        print(f"glossy transfer {glossy}: {p.cpu:.1f} s, error {rows[-1][2]:.2%}, indirect light {rows[-1][3]:+.2%}")
    claims.check("a final glossy bounce alone leaves indirect light out: 5 % or more", f"{rows[0][3]:+.1%}", rows[0][3] < -0.05)
    claims.check("glossy transfer holds it: within 3 % of path tracing", f"{rows[1][3]:+.1%}", abs(rows[1][3]) < 0.03)
    write_csv(output.with_suffix(".csv"), ["glossy_transfer", "processor_seconds", "error", "indirect_light"], rows)
    lost = found[True]["indirect"] - found[False]["indirect"]
    draw(output, [("several glossy bounces", found[True][""]), ("a final glossy bounce", found[False][""]),
                  ("path tracing", reference[""]), ("what glossy surfaces throw on others, x 3", 3 * lost.clip(min=0))])
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
