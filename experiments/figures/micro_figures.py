"""Indirect light by `mote_micro_rendering`, for the figures of Engelhardt 2013, Ch. 8, and its relative RMSE (measure.py)
against two references of `path`."""
from pathlib import Path

import numpy as np
from bundle_figures import SCENES, with_options
from measure import error, pixel_errors
from renders import around, luminance

MICRO = {"integrator": "mote_micro_rendering"}
CORNELL = SCENES.parents[2] / "scenes" / "cornell_box.xml"
BUNNY = SCENES / "bunny_room.xml"
GLOSSY = SCENES / "glossy_box.xml"


def zoom(width):
    """How often pixels of a small picture are repeated, so that titles fit above it."""
    return max(1, -(-300 // width))


def micro(**settings):
    return MICRO | with_options(**settings)


class IndirectView:
    """Indirect light of a scene, seen by one camera: its references, and the errors of pictures (arrays or renders).

    Errors are those of `smooth` pixels, whose neighbours are as bright within a half: what edges look like in a picture
    of a pass or two is decided by where its eye rays fell, whatever the method."""

    def __init__(self, mote, scene, size, passes, name, depth=None):
        self.mote, self.scene, self.name = mote, Path(scene), name
        self.settings = dict(size) | ({} if depth is None else with_options(max_depth=depth))
        self.references = [self.light(self.render("reference", {"integrator": "path"}, passes, seed)) for seed in (91, 92)]
        self.truth = np.mean(self.references, axis=0)
        nearby = around(luminance(self.truth), 1)
        self.smooth = nearby.max(axis=0) < 1.5 * nearby.min(axis=0)

    @staticmethod
    def light(picture):
        """A layer that a bound has renamed is indirect light all the same."""
        return picture if isinstance(picture, np.ndarray) else sum(picture[k] for k in picture.layers if k.startswith("indirect"))

    def render(self, name, settings, passes, seed=1, **more):
        return self.mote.render(self.scene, f"{self.name}_{name}".replace(" ", "_"), self.settings | settings, passes=passes, seed=seed, **more)

    def error(self, picture, region=None):
        """Relative RMSE of the smooth pixels, or in a region (a mask of pixels)."""
        return error(self.light(picture), self.references, self.smooth if region is None else region)

    def worst(self, picture, share=0.99):
        """The relative error that so many of the pixels do not exceed."""
        squares = pixel_errors(self.light(picture), self.references, self.smooth)[self.smooth]
        return float(np.quantile(np.maximum(squares, 0), share)) ** 0.5

    def ratio(self, picture, region=None):
        """Ratio of the mean luminance to that of the reference."""
        p, r = luminance(self.light(picture)), luminance(self.truth)
        return float(p.mean() / r.mean() if region is None else p[region].mean() / r[region].mean())
