#!/usr/bin/python3
"""Interleaved transfer against one bounce at a time, with as many directions: Hermes 2010, Figs. 7 and 10.

One bounce at a time shares its directions out among the bounces (eight here, and light of more is missing); interleaved, each
direction carries light of all lengths. Indirect light of independent seeds: how they differ, and how far their mean is from that
of path tracing. The paper exchanges after every direction, here after every 16 (gathering/radiance_exchange). A full run takes
about 4 minutes, --quick less than one.

    experiments/figures/hermes_07_interleaved.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_rooms import BUNDLES, ROOM, bias, draw, noise
from claims import Claims
from renders import main, write_csv

TRANSFERS = ["one_bounce", "interleaved"]


def figure(mote, quick, output):
    claims, rows, panels = Claims(), [], []
    n = 2 if quick else 1
    size = {"resx": 320 // n, "resy": 200 // n}
    reference = mote.render(ROOM, "reference", size | {"integrator": "path"}, passes=200 if quick else 1000, seed=9)
    found = {}
    for directions in [256, 512] if quick else [256, 512, 1024, 2048, 4096]:
        for transfer in TRANSFERS:
            settings = {"integrator.directions": directions, "integrator.transfer": transfer,
                        "integrator.texel_budget": 16384 if quick else 65536}
            pictures = [mote.render(ROOM, f"{transfer}_{directions}", size | BUNDLES | settings, passes=1, seed=s)
                        for s in ((1, 2, 3) if quick else (1, 2, 3, 4, 5, 6))]
            mean = {"indirect": np.mean([p["indirect"] for p in pictures], axis=0)}
            found[transfer, directions] = noise(pictures, "indirect")
            rows.append([transfer, directions, found[transfer, directions], bias(mean, reference, "indirect")])
            print(f"{transfer}, {directions} directions: noise {rows[-1][2]:.2%}, indirect light {rows[-1][3]:+.2%}")
            if directions == 512:
                panels.append((f"{transfer}, 512 directions: indirect light, noise {rows[-1][2]:.1%}", pictures[0]["indirect"]))
    counts = sorted({d for _, d in found})
    ratios = [found["interleaved", d] / found["one_bounce", d] for d in counts]
    claims.check("interleaved transfer has less noise with as many directions", ", ".join(f"{r:.2f}" for r in ratios),
                 max(ratios) < 1)
    claims.check("with 256 directions it has less noise than one bounce at a time with 512",
                 f"{found['interleaved', 256]:.2%} against {found['one_bounce', 512]:.2%}",
                 found["interleaved", 256] < found["one_bounce", 512])
    last = {r[0]: r[3] for r in rows if r[1] == counts[-1]}
    claims.check("and it ends at path tracing's light: within 2 %", f"{last['interleaved']:+.2%}", abs(last["interleaved"]) < 0.02)
    write_csv(output.with_suffix(".csv"), ["transfer", "directions", "noise", "indirect_light"], rows)
    draw(output, panels)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
