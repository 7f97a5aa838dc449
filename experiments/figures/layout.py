"""What a figure shows, in numbers that a test can read: NAME.figure.json beside NAME.png.

{"size": [width, height],                                 pixels
 "labels": [{"text", "size", "box"}],                     size: pixels; box: left, top, right, bottom in pixels from the upper left corner
 "differences": [{"box", "bar"}],                         the words at its colour bar, own or of the same norm; null without any
 "axes": [{"x", "y"}],                                    names of the axes of plots, own or of shared ones; "" without any
 "pixels": digest}                                        of the PNG file whose labels these are

tests/pages/check_figures.py checks them.
"""
import json
from pathlib import Path

from matplotlib.image import AxesImage
from matplotlib.text import Text
from origin import pixels

DIVERGING = {"RdBu", "RdYlGn", "RdYlBu", "PiYG", "PRGn", "BrBG", "PuOr", "RdGy", "coolwarm", "bwr", "seismic", "Spectral"}


def ticks(axis):
    """Ticks inside of the axis. matplotlib keeps some beyond, which it does not draw."""
    low, high = sorted(axis.get_view_interval())
    slack = 1e-9 * (high - low)
    return [t for t in [*axis.get_major_ticks(), *axis.get_minor_ticks()] if low - slack <= t.get_loc() <= high + slack]


def visible(figure):
    """The texts that can be seen."""
    hidden = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            own = set(axis.findobj(Text))
            shown = {text for t in ticks(axis) for text in t.findobj(Text)} | {axis.label, axis.get_offset_text()}
            hidden |= own - shown if axes.axison and axis.get_visible() else own
    return [t for t in figure.findobj(Text) if t not in hidden and t.get_visible() and t.get_text().strip()]


def words(axes):
    """All that stands at a colour bar."""
    return " ".join(t.get_text() for t in visible(axes.figure) if t in set(axes.findobj(Text)))


def signed(image):
    """Is this a signed difference? Either it says so, or its colours do."""
    return image.get_gid() == "difference" or image.get_array().ndim == 2 and image.get_cmap().name.removesuffix("_r") in DIVERGING


def bar_of(image):
    """The axes of its colour bar, or of one that panels of the same norm share; None without any."""
    same = [image, *(i for i in image.figure.findobj(AxesImage) if i.norm is image.norm and i.cmap == image.cmap)]
    return next((i.colorbar.ax for i in same if i.colorbar), None)


def name(axes, side):
    """The name of an axis; of a shared one, the name that stands at any of the plots."""
    siblings = getattr(axes, f"get_shared_{side}_axes")().get_siblings(axes)
    return next((text for text in (getattr(a, f"get_{side}label")() for a in [axes, *siblings]) if text), "")


def describe(figure, width, height):
    """The figure after it was plotted with so many pixels."""
    renderer = figure.canvas.get_renderer()

    def box(artist):  # of an annotation without its arrow
        b = Text.get_window_extent(artist, renderer) if isinstance(artist, Text) else artist.get_window_extent(renderer)
        return [round(float(v), 1) for v in (b.x0, height - b.y1, b.x1, height - b.y0)]

    bars = {a for a in figure.axes if a.get_gid() == "colour bar"} | {i.colorbar.ax for i in figure.findobj(AxesImage) if i.colorbar}
    plots = [a for a in figure.axes if a not in bars and a.axison and any(t.label1.get_text() for k in (a.xaxis, a.yaxis) for t in ticks(k))]
    return {"size": [width, height],
            "labels": [{"text": t.get_text(), "size": round(t.get_fontsize() * figure.dpi / 72, 2), "box": box(t)} for t in visible(figure)],
            "differences": [{"box": box(i.axes), "bar": words(bar_of(i)) if bar_of(i) else None}
                            for i in figure.findobj(AxesImage) if signed(i) and i.axes not in bars],
            "axes": [{side: name(a, side) for side in "xy"} for a in plots]}


def write(figure, png):
    """Beside the PNG file that the figure was just saved to with its own dots per inch."""
    width, height = (int(round(float(v))) for v in figure.canvas.get_width_height())
    text = json.dumps({**describe(figure, width, height), "pixels": pixels(png)}, indent=1, ensure_ascii=False)
    Path(png).with_suffix(".figure.json").write_text(text + "\n", encoding="utf-8")
