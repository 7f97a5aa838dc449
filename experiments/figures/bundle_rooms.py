"""The room of the figures of Hermes 2010, errors against a reference, and panels."""
from pathlib import Path

import numpy as np
import measure
from panels import TITLE, Canvas, show
from renders import luminance

ROOM = Path(__file__).resolve().parent / "scenes" / "sky_room.xml"
BUNDLES = {"integrator": "mote_ray_bundles", "integrator.eye_samples": 1}


def error(picture, reference, layer=""):
    """Relative RMSE, without the reference's own noise where it is the beauty, whose variance is known."""
    return measure.error(picture[layer], [reference[layer]], variances=[reference["Variance"]] if layer == "" else None)


def error_of_two(picture, references, layer=""):
    """Relative RMSE against two references of other seeds."""
    return measure.error(picture[layer], [r[layer] for r in references])


def bias(picture, reference, layer=""):
    return picture[layer].mean() / reference[layer].mean() - 1


def noise(pictures, layer=""):
    """Noise of one picture, relative as its RMSE is, from how independent ones differ."""
    stack = [p[layer] for p in pictures]
    return measure.series_error(stack, [np.mean(stack, axis=0)])["noise"]


def draw(path, panels, columns=2):
    """`panels`: title and picture, all with the exposure of the first."""
    exposure = 0.6 / np.percentile(luminance(panels[0][1]), 90)
    height, width = panels[0][1].shape[:2]
    wide = 1260 // columns
    high = round(wide * height / width)
    canvas = Canvas(columns * (wide + 10) - 10, -(-len(panels) // columns) * (TITLE + high + 10))
    for k, (text, picture) in enumerate(panels):
        show(canvas.panel(k % columns * (wide + 10), TITLE + k // columns * (TITLE + high + 10), wide, high), picture, exposure, text)
    canvas.save(path.with_suffix(".png"))
