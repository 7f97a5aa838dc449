#!/usr/bin/python3
"""Micro-buffers in media against virtual point lights with approximate bias compensation, photons and paths.

Two scenes: a small room full of fog (micro_fog.xml) and the smoke room, 96 x 60, micro-buffers with
8 x 8 texels, 8192 points on surfaces and 4096 in the fog. Every method takes about the same processor
seconds, two seeds; errors are the relative RMSE (measure.py) of all light and of the light that micro-buffers gather (indirect,
multiple_scattering), against two references of volpath.
Biases are of the picture's mean, with the spread of the two seeds. A full run takes about
seven minutes of processor time.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from measure import series_error
from renders import approximate, luminance, main, write_csv

FOG = Path(__file__).resolve().parent / "micro_fog.xml"
METHODS = {
    "volpath": {"integrator": "volpath"},
    "VPLs, ABC": {"integrator": "mote_vpl", "integrator.paths": 64, **approximate(2)},
    "photon map": {"integrator": "mote_photon_map"},
    "micro-buffers": {"integrator": "mote_micro_rendering", "integrator.points": 8192, "integrator.volume_points": 4096,
                      "integrator.bounces": 12, "integrator.micro_buffer": 8},
}
GATHERED = ("indirect", "multiple_scattering")


def light_of(picture, layers):
    """All of it, or the sum of those layers, by whatever suffix a method gives them."""
    if layers is None:
        return luminance(picture[""])
    return luminance(sum(light for name, light in picture.layers.items() if name.startswith((*layers, "compensation"))))


def error_of(pictures, references):
    """Relative RMSE of a picture, bias of its mean, and half the difference of two seeds in it."""
    truth = np.mean(references)
    biases = [x.mean() / truth - 1 for x in pictures]
    return series_error(pictures, references)["error"], np.mean(biases), abs(biases[0] - biases[1]) / 2


def run(mote, quick, output):
    seconds, size = (2, {"resx": 32, "resy": 20}) if quick else (10, {"resx": 96, "resy": 60})
    rows = []

    def render(scene, name, settings, cpu, seed):
        """As many passes as take so long."""
        tag = f"{name}_{Path(str(scene)).stem}".replace(" ", "_").replace(",", "")
        once = mote.render(scene, f"{tag}_once", {**size, **settings}, 1, seed=99)
        passes = max(1, round(cpu / once.cpu))  # a first guess, whose own time tells how many more
        if passes > 4:
            some = mote.render(scene, f"{tag}_some", {**size, **settings}, 1 + passes // 4, seed=99)
            each = max(1e-3, (some.cpu - once.cpu) / (passes // 4))
            passes = max(1, round((cpu - (once.cpu - each)) / each))
        return mote.render(scene, f"{tag}_{cpu}", {**size, **settings}, passes, seed=seed)

    for scene, label, longer in ((FOG, "foggy room", 4), ("smoke_room", "smoke room", 10)):
        references = [render(scene, "reference", METHODS["volpath"], longer * seconds, seed) for seed in (11, 12)]
        for name, settings in METHODS.items():
            pictures = [render(scene, name, settings, seconds, seed) for seed in (1, 2)]
            row = [label, name, np.mean([p.cpu for p in pictures]), pictures[0].passes]
            for layers in (None, GATHERED):
                row += error_of([light_of(p, layers) for p in pictures], [light_of(r, layers) for r in references])
            rows.append(row)
            print("{:11} {:20} {:6.1f} s {:5d} passes  all {:6.1%} bias {:+.1%} +- {:.1%}  gathered {:6.1%} bias {:+.1%} +- "
                  "{:.1%}".format(*row), flush=True)
    write_csv(output.with_suffix(".csv"), ["scene", "method", "seconds", "passes", "error", "bias", "bias spread",
                                           "gathered error", "gathered bias", "gathered bias spread"], rows)
    return 0


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
