"""What the figures of Hermes 2010 share: the room, errors against a reference, and panels."""
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from renders import around, luminance, show

ROOM = Path(__file__).resolve().parent / "scenes" / "sky_room.xml"
BUNDLES = {"integrator": "mote_ray_bundles", "integrator.eye_samples": 1}


def error(picture, reference, layer=""):
    """docs/testing.md, Eq. (2), without the reference's own noise where it is the beauty, whose variance is known."""
    x, r = picture[layer], reference[layer]
    square = (r ** 2).mean(axis=2)
    weight = 1 / (square + (np.median(r[r > 0]) / 10) ** 2)
    variance = reference["Variance"].mean(axis=2) if layer == "" else 0
    return max(0.0, (weight * (((x - r) ** 2).mean(axis=2) - variance)).sum() / (weight * square).sum()) ** 0.5


def error_of_two(picture, references, layer=""):
    """The same against two references of other seeds: free of the noise of both, which neither weighs nor counts."""
    x, a, b = (p[layer] for p in (picture, *references))
    light = ((a + b) ** 2).mean(axis=2) / 4
    mean = around(light).mean(axis=0)
    weight = 1 / (mean + np.median(mean[mean > 0]) / 100)
    return max(0.0, (weight * ((x - a) * (x - b)).mean(axis=2)).sum() / (weight * light).sum()) ** 0.5


def bias(picture, reference, layer=""):
    return picture[layer].mean() / reference[layer].mean() - 1


def noise(pictures, layer=""):
    """Of one picture, from how independent ones differ."""
    stack = np.array([p[layer] for p in pictures])
    mean = stack.mean(axis=0)
    square = (mean ** 2).mean(axis=2)
    weight = 1 / (square + (np.median(mean[mean > 0]) / 10) ** 2)
    return ((weight * stack.var(axis=0, ddof=1).mean(axis=2)).sum() / (weight * square).sum()) ** 0.5


def draw(path, panels, columns=2):
    """`panels`: title and picture, all with the exposure of the first."""
    exposure = 0.6 / np.percentile(luminance(panels[0][1]), 90)
    rows = -(-len(panels) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(6.4 * columns, 4.3 * rows), squeeze=False)
    for axes in grid.flat:
        axes.axis("off")
    for axes, (text, picture) in zip(grid.flat, panels):
        show(axes, picture, exposure, text)
    figure.tight_layout()
    figure.savefig(path.with_suffix(".png"), dpi=80)
    plt.close(figure)
