"""Drawing a figure to be shown in a talk: panels laid out in pixels, clean pictures of a scene, and coarse ones over them.

What is measured is rendered with few pixels, since means over the picture need samples and not pixels. `clean` makes the
picture that the eye wants beside it, by `mote_layers`, whose filter in image space takes the grain; nothing is measured in
it. `enlarged` shows a coarse difference at its size, with its noise taken down by means over blocks; titles say so.
"""
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import plotting
from renders import luminance

DPI = 100
TITLE = 26  # pixels above a panel that its title takes
BAR = 44  # pixels below a signed difference that its colour bar takes


class Canvas:
    """A figure laid out in pixels from its upper left corner; `panel` places axes, the title stands above them."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.figure = plt.figure(figsize=(width / DPI, height / DPI), dpi=DPI)

    def panel(self, x, y, width, height):
        return self.figure.add_axes([x / self.width, 1 - (y + height) / self.height, width / self.width, height / self.height])

    def save(self, path):
        plotting.save(self.figure, path)


def clean(mote, scene, settings, passes, name="clean"):
    """A picture without grain, for the eye alone: biased by its filter."""
    return mote.render(scene, name, settings | {"integrator": "mote_layers"}, passes=passes)


def cleanest(mote, scene, settings, passes, name="clean", seeds=3):
    """All light, pixel by pixel the median of clean pictures: rare bright paths, which the filter would smear, are in one of
    them only."""
    return np.median([mote.render(scene, name, settings | {"integrator": "mote_layers"}, passes=passes, seed=s)[""]
                      for s in range(1, seeds + 1)], axis=0)


def letters(figure):
    """Size [points] that is at least 9 points where the figure is shown 960 pixels wide, 10 inches of a screen."""
    return max(11, 0.91 * figure.get_figwidth())


def title(axes, text, color="black"):
    axes.set_title(text, fontsize=letters(axes.figure), pad=5, color=color)


def letter(axes):
    """Sizes of the words at a plot's axes and in its legend, which are there already."""
    size = letters(axes.figure)
    axes.tick_params(labelsize=size)
    for text in (axes.xaxis.label, axes.yaxis.label, *(axes.get_legend().get_texts() if axes.get_legend() else ())):
        text.set_fontsize(size)


def show(axes, image, exposure, text=None):
    """Fills the axes; pixels stay visible where they are large."""
    axes.imshow(np.clip(image * exposure, 0, 1) ** (1 / 2.2), interpolation="nearest", aspect="auto")
    axes.set(xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_visible(False)
    if text:
        title(axes, text)


def show_difference(axes, difference, exposure, times, text=None):
    """Luminance of a signed difference as a fraction of the white of pictures with this exposure, `times` as strong: blue too dark, red
    too bright, full colour at 1 / times. The colour bar takes BAR pixels below the axes."""
    box, figure = axes.get_position(), axes.figure
    pixel = 1 / (DPI * figure.get_figheight())
    bar = figure.add_axes([box.x0, box.y0 - 15 * pixel, box.width, 10 * pixel])
    room = box.width * DPI * figure.get_figwidth() / (0.62 * letters(figure) * DPI / 72)  # of letters
    words = next(w for w in ("luminance difference / white", "difference / white", "difference") if len(w) + 16 < room or w == "difference")
    plotting.difference(axes, exposure * luminance(difference), 1 / times, words, bar)
    bar.tick_params(labelsize=letters(figure), length=3, pad=2)
    axes.set_aspect("auto")
    if text:
        title(axes, text)


def mark(axes, piece, color="white"):
    """The frame of a piece (rows and columns as slices) in the picture that it is cut out of."""
    rows, columns = piece
    axes.add_patch(plt.Rectangle((columns.start, rows.start), columns.stop - columns.start, rows.stop - rows.start,
                                 fill=False, edgecolor=color, linewidth=1.5))


def blocks(image, n):
    """Means over blocks of n x n pixels, of which there is a whole number."""
    height, width = (k // n for k in image.shape[:2])
    return image.reshape(height, n, width, n, -1).mean(axis=(1, 3))


def along(image, where, axis):
    """`image` at fractional places along an axis; the border continues."""
    where = np.clip(where, 0, image.shape[axis] - 1)
    low = np.minimum(where.astype(int), image.shape[axis] - 2)
    share = (where - low).reshape([-1 if i == axis else 1 for i in range(image.ndim)])
    return np.take(image, low, axis) * (1 - share) + np.take(image, low + 1, axis) * share


def enlarged(image, n, height, width):
    """Means of a coarse and noisy image over blocks of n x n pixels, interpolated linearly between their middles. Fills the
    width, and of the height as much as fits, about the middle, since a camera's field of view spans the width."""
    h, w = image.shape[:2]
    means = blocks(np.pad(image, [(0, -h % n), (0, -w % n), (0, 0)], mode="edge"), n)
    rows = ((np.arange(height) + 0.5 - height / 2) * w / width + h / 2) / n - 0.5
    columns = (np.arange(width) + 0.5) * w / width / n - 0.5
    return along(along(means, rows, 0), columns, 1)
