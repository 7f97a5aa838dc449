#!/usr/bin/python3
"""Virtual ray lights and beam lights against virtual point lights, photons and paths: processor seconds to 5 % of error.

Two scenes, 48 x 30: a small room full of fog (micro_fog.xml) and the smoke room. Every method is rendered twice with some
processor seconds, starting taken off (a render of one pass tells it); errors are root mean squares over pixels of all light with
the weights of `mote compare`, against two references, one of volpath and one of long ray lights, whose noise is taken off. The time
to 5 % is that of an error that falls with the root of the time, above the bias, which is the part that both seeds share: where
that alone is above 5 %, there is none ("never"). `--quick`: a few seconds, numbers without a meaning.
"""
import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from renders import approximate, error_weight, luminance, main, write_csv

FOG = Path(__file__).resolve().parent / "micro_fog.xml"
TARGET = 0.05
METHODS = {
    "ray lights": {"integrator": "mote_ray_lights"},
    "ray lights, 4 each": {"integrator": "mote_ray_lights", "integrator.share": 4},
    "beam lights, 0.1 m": {"integrator": "mote_ray_lights", "integrator.width": 0.1},
    "VPLs bounded": {"integrator": "mote_vpl", "integrator.paths": 64},
    "VPLs, ABC, 1 step": {"integrator": "mote_vpl", "integrator.paths": 64, **approximate(1)},
    "VPLs, ABC, 2 steps": {"integrator": "mote_vpl", "integrator.paths": 64, **approximate(2)},
    "VPLs, ABC, 3 steps": {"integrator": "mote_vpl", "integrator.paths": 64, **approximate(3)},
    "photon map": {"integrator": "mote_photon_map", "integrator.photon_paths": 20000},
    "volpath": {"integrator": "volpath"},
}
# The smoke room's own settings would go to mote_vpl: those of its methods are named by its parameters.
OWN_NAMES = {"integrator.paths": "paths"}


def errors_of(pictures, references):
    """Squared error of one picture and the part that two of them share, over the square of the light."""
    first, second = references
    weight = error_weight(0.5 * (first + second))
    norm = np.sum(weight * first * second)
    alone = np.mean([np.sum(weight * (x - first) * (x - second)) / norm for x in pictures])
    shared = np.sum(weight * (pictures[0] - first) * (pictures[1] - second)) / norm
    return float(alone), max(0.0, float(shared))


def seconds_to_target(seconds, alone, shared):
    """Variance falls with the time, the bias stays."""
    left = TARGET**2 - shared
    return seconds * max(alone - shared, 0.0) / left if left > 0 else math.inf


def run(mote, quick, output):
    seconds, size = (0.3, {"resx": 16, "resy": 10}) if quick else (3, {"resx": 48, "resy": 30})
    rows = []

    def render(scene, tag, settings, cpu, seed):
        """As many passes as take so long; the picture and its processor seconds without those of the start."""
        named = settings if isinstance(scene, Path) or settings["integrator"] != "mote_vpl" else {
            OWN_NAMES.get(key, key): value for key, value in settings.items()}
        tag = f"{tag}_{Path(str(scene)).stem}".replace(" ", "_").replace(",", "")
        once = mote.render(scene, f"{tag}_once", {**size, **named}, 1, seed=99)
        some = mote.render(scene, f"{tag}_some", {**size, **named}, 5, seed=99)
        each = max(1e-4, (some.cpu - once.cpu) / 4)
        start = max(0.0, once.cpu - each)
        picture = mote.render(scene, f"{tag}_{seed}", {**size, **named}, max(2, round(cpu / each)), seed=seed)
        return luminance(picture[""]), max(picture.cpu - start, 1e-3), picture.passes

    for scene, label in ((FOG, "foggy room"), ("smoke_room", "smoke room")):
        references = [render(scene, "reference_paths", METHODS["volpath"], 4 * seconds, 11)[0],
                      render(scene, "reference_rays", METHODS["ray lights"], 4 * seconds, 12)[0]]
        for name, settings in METHODS.items():
            renders = [render(scene, name, settings, seconds, seed) for seed in (1, 2)]
            alone, shared = errors_of([light for light, _, _ in renders], references)
            cpu = float(np.mean([r[1] for r in renders]))
            bias = np.mean([light.mean() for light, _, _ in renders]) / np.mean([r.mean() for r in references]) - 1
            needed = seconds_to_target(cpu, alone, shared)
            rows.append([label, name, cpu, renders[0][2], math.sqrt(max(alone, 0.0)), math.sqrt(shared), bias, needed])
            print("{:11} {:20} {:5.1f} s {:5d} passes  error {:6.1%}, shared by both {:5.1%}, mean {:+.1%}  to 5 %: {:6.1f} s"
                  .format(*rows[-1]), flush=True)
    write_csv(output.with_suffix(".csv"), ["scene", "method", "seconds", "passes", "error", "shared error", "bias",
                                           "seconds to 5 %"], rows)
    return 0


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
