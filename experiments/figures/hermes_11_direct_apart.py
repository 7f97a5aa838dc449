#!/usr/bin/python3
"""Direct light by its own method, indirect light by ray-bundles: Hermes 2010, Fig. 11.

A small lamp in the room: few directions of a bundle meet it. The paper takes shadow maps for its direct light, here points of the
lamp are sampled, at pixels and at texels. Compared at the same number of directions. A full run takes about 4 minutes, --quick
less than one.

    experiments/figures/hermes_11_direct_apart.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

from bundle_rooms import BUNDLES, ROOM, bias, draw, error
from claims import Claims
from renders import main, write_csv


def figure(mote, quick, output):
    claims, rows = Claims(), []
    n = 2 if quick else 1
    room = {"resx": 320 // n, "resy": 200 // n, "sky": 0.0001, "spot": 60}
    reference = mote.render(ROOM, "reference", room | {"integrator": "path"}, passes=200 if quick else 1000, seed=9)
    settings = {"integrator.texel_budget": 16384 if quick else 65536, "integrator.directions": 512, "integrator.eye_samples": 8}
    found = {}
    for direct in ["bundles", "lights"]:
        p = mote.render(ROOM, direct, room | BUNDLES | settings | {"integrator.direct": direct}, passes=1 if quick else 4)
        found[direct] = p
        rows.append([direct, p.cpu, error(p, reference), bias(p, reference)])
        print(f"direct light by {direct}: {p.cpu:.1f} s, error {rows[-1][2]:.2%}, light {rows[-1][3]:+.2%}")
    claims.check("a small lamp by its own method: less than half the error with as many directions",
                 f"{rows[1][2]:.1%} against {rows[0][2]:.1%}", rows[1][2] < 0.5 * rows[0][2])
    claims.check("at no more than twice the time", f"{rows[1][1]:.1f} s against {rows[0][1]:.1f} s", rows[1][1] < 2 * rows[0][1])
    claims.check("with the same light: within 2 % of path tracing", f"{rows[1][3]:+.2%}", abs(rows[1][3]) < 0.02)
    write_csv(output.with_suffix(".csv"), ["direct_light", "processor_seconds", "error", "light"], rows)
    draw(output, [(f"direct light by bundles: error {rows[0][2]:.1%}", found["bundles"][""]),
                  (f"direct light apart: error {rows[1][2]:.1%}", found["lights"][""])])
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
