#!/usr/bin/python3
"""Against path tracing, and where the time goes: Tokuyoshi and Ogaki 2012, Fig. 9 and Table 1.

A copper bunny, moving with its light, represents the paper's scene of 174 thousand triangles. The paper's ratio is that of a
GPU's rasterizer to a path tracer on a processor; here both trace rays on the same processor, and what is compared is the
time to equal error, from a few passes each (squares fall as one over the passes). Table 1 as shares of processor time.
A full run takes 2 minutes of one core, --quick 20 s.

    experiments/figures/tokuyoshi_09_path_tracing.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_figures import BUNDLES, View, with_options
from claims import Claims
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

METHODS = {"path": ({"integrator": "path"}, 8), "combined": (BUNDLES, 4),
           "combined, roughness clamping": (BUNDLES | with_options(glossy="clamping"), 4)}
SHARES = {"light paths": "light_path_cpu_seconds", "eye paths and direct light": "eye_path_cpu_seconds",
          "gathering virtual point lights": "vpl_cpu_seconds", "bundles": "bundle_cpu_seconds"}


def figure(mote, quick, output):
    claims, rows, found = Claims(), [], {}
    seeds = range(1, 5 if quick else 9)
    size = {"resx": 128, "resy": 80} if quick else {"resx": 320, "resy": 200}
    view = View(mote, "bunny_room", size | {"material": "metal"}, 64 if quick else 128, "room", depth=4)
    start = {name: view.render(name.replace(",", "") + " start", settings | with_options(max_depth=1), 1).cpu for name, (settings, _) in METHODS.items()}
    for name, (settings, passes) in METHODS.items():
        pictures = [view.render(name.replace(",", ""), settings, passes, s) for s in seeds]
        seconds = max(0.01, float(np.mean([p.cpu for p in pictures])) - start[name])
        found[name] = {"error": view.error(pictures), "bias": view.bias(pictures), "seconds": seconds, "picture": pictures[0]}
        found[name]["work"] = found[name]["error"] ** 2 * seconds
        rows.append([name, passes, found[name]["error"], *map(float, found[name]["bias"]), seconds, found[name]["work"]])
        print(f"{name}: {passes} passes, error {found[name]['error']:.1%}, bias {found[name]['bias'][0]:+.2%} +- {found[name]['bias'][1]:.2%}, {seconds:.2f} s")
    ratio = found["path"]["work"] / found["combined"]["work"]
    claims.check("over 6000 times as fast as path tracing", f"{ratio:.2f} times at equal error", ratio > 6000,
                 "6000 is a GPU's rasterizer against a processor's path tracer, at unequal error; here both trace rays on one processor")
    claims.check("it sufficiently approximates path tracing: two bounces, the mean within four standard errors",
                 f"{found['combined']['bias'][0]:+.2%} +- {found['combined']['bias'][1]:.2%}", abs(found["combined"]["bias"][0]) < 4 * found["combined"]["bias"][1])
    values = {k: float(np.sum([found["combined"]["picture"].value(v)])) for k, v in SHARES.items()}
    total = sum(values.values())
    shares = {k: v / total for k, v in values.items()}
    visibility = shares["gathering virtual point lights"] + shares["bundles"]
    claims.check("visibility dominates: virtual point lights and bundles take most of the time (58 % in Table 1)",
                 ", ".join(f"{k} {v:.0%}" for k, v in shares.items()), visibility > 0.5)
    write_csv(output.with_suffix(".csv"), ["method", "passes", "error", "bias", "bias_standard_error", "cpu_seconds", "error_squared_times_seconds"],
              rows + [[f"share: {k}", "", v] for k, v in shares.items()])
    height, width = view.truth.shape[:2]
    canvas = Canvas(4 * (width + 10) + 10, height + TITLE + 10)
    exposure = 0.6 / np.percentile(luminance(view.truth), 95)
    for k, (name, image) in enumerate([*((f"{n}: {f['error']:.1%}, {f['seconds']:.1f} s", f["picture"][""]) for n, f in found.items()), ("path, for comparison", view.truth)]):
        show(canvas.panel(10 + k * (width + 10), TITLE, width, height), image, exposure, name)
    canvas.save(output.with_suffix(".png"))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
