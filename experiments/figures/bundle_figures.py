"""What the figures of Tokuyoshi and Ogaki 2012 share: pictures by seeds of one method, and their errors against two
references of `path`, whose noise cancels out of the squares."""
from pathlib import Path

import numpy as np
from renders import error_weight, luminance

SCENES = Path(__file__).resolve().parent / "scenes"
BUNDLES = {"integrator": "mote_vpl_ray_bundles"}


def with_options(**settings):
    return {f"integrator.{k}": v for k, v in settings.items()}


class View:
    """A scene from one camera: its references, and pictures by method."""

    def __init__(self, mote, scene, settings, passes, name, depth=None):
        self.mote, self.scene, self.settings, self.name = mote, SCENES / f"{scene}.xml", settings, name
        self.depth = {} if depth is None else with_options(max_depth=depth)
        self.references = [self.render("reference", {"integrator": "path"}, passes, seed) for seed in (91, 92)]
        self.truth = np.mean([r[""] for r in self.references], axis=0)
        self.weight = error_weight(luminance(self.truth))

    def render(self, name, settings, passes, seed=1):
        return self.mote.render(self.scene, f"{self.name}_{name}".replace(" ", "_"), self.settings | self.depth | settings, passes=passes, seed=seed)

    def squares(self, picture):
        """Of the relative error, by pixel, free of the references' noise in the mean."""
        p, a, b = (luminance(x[""] if not isinstance(x, np.ndarray) else x) for x in (picture, *self.references))
        return (p - a) * (p - b) * self.weight

    def error(self, pictures, region=None):
        """Root mean square of one picture, over pictures of several seeds, in a region (a mask of pixels)."""
        region = np.ones(self.truth.shape[:2], bool) if region is None else region
        return max(0.0, float(np.mean([self.squares(p)[region].mean() for p in pictures]))) ** 0.5

    def bias(self, pictures):
        """Of the picture's mean, relative, with its standard error over seeds."""
        means = np.array([luminance(p[""]).mean() for p in pictures]) / luminance(self.truth).mean() - 1
        return means.mean(), means.std(ddof=1) / len(means) ** 0.5
