"""Views of the figures of Tokuyoshi and Ogaki 2012: pictures by seeds of one method, and their relative RMSE (measure.py)
against two references of `path`."""
from pathlib import Path

import numpy as np
from measure import pixel_errors, series_error
from renders import luminance

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

    def render(self, name, settings, passes, seed=1):
        return self.mote.render(self.scene, f"{self.name}_{name}".replace(" ", "_"), self.settings | self.depth | settings, passes=passes, seed=seed)

    def squares(self, picture):
        """Squared relative errors by pixel, free of the references' noise in the mean."""
        return pixel_errors(picture[""], [r[""] for r in self.references])

    def error(self, pictures, region=None):
        """Relative RMSE of one picture, from pictures of several seeds, in a region (a mask of pixels)."""
        return series_error([p[""] for p in pictures], [r[""] for r in self.references], region)["error"]

    def bias(self, pictures):
        """Relative bias of the image's mean, with its standard error over seeds."""
        means = np.array([luminance(p[""]).mean() for p in pictures]) / luminance(self.truth).mean() - 1
        return means.mean(), means.std(ddof=1) / len(means) ** 0.5
