"""Plots of the gallery for a talk: one colour a method, letters of at least 9 points at 960 pixels, labels at the lines and inside the
canvas, the measure named on each axis, signed differences in blue and red with a colour bar.

tests/pages/check_figures.py checks these in docs/gallery: in SVG files, and in what save() writes beside each PNG (layout.py).
"""
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import layout
import matplotlib.pyplot as plt
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

WIDTH = 960  # pixels
DPI = 100
RMSE = "relative RMSE"
# By the beginning of a method's name: Okabe and Ito's colours, and Tol's where there are more.
BLUE, ORANGE_RED, GREEN, PINK, ORANGE, SKY, BLACK = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"
WINE, OLIVE, INDIGO, GREY, TEAL, MAROON, PURPLE, BROWN, ROSE = ("#882255", "#999933", "#332288", "#777777", "#44aa99", "#661100",
                                                               "#aa4499", "#8c510a", "#cc6677")
COLOURS = {
    "mote path tracer": BLUE, "path": BLUE, "volpath": BLUE, "volpath equi-angular": SKY, "volpath, equi-angular": SKY,
    "bidirectional": SKY, "mote layers": ORANGE_RED, "layers": ORANGE_RED, "layers, far light": ORANGE, "photon": ORANGE,
    "mote VPL": GREEN, "VPL": GREEN, "64 paths' VPLs": GREEN, "none": GREEN, "VPL unbounded": MAROON, "VPL, exact": INDIGO,
    "exact": INDIGO, "VPL, 1 step": BROWN, "VPL, 2 steps": BLACK, "approximate": BROWN, "screen space": OLIVE,
    "screen space + ABC": GREY, "VPLs, ABC": BROWN, "spherical": GREY, "ray lights": PINK, "beam lights": PURPLE,
    "lightcuts": INDIGO, "multidimensional": WINE, "stochastic": BLACK, "light tree": TEAL, "matrix": OLIVE, "resampling": SKY,
    "atlas": BROWN, "atlas, final": ROSE, "bundles from": WINE, "VPL and bundles": PURPLE,
    "mote_bdpt": SKY, "combined": ORANGE_RED, "bpt": OLIVE, "pp3d": GREEN, "pb2d": ORANGE, "bb1d": INDIGO,
    "every pixel": BLACK, "sub-sampled": GREY, "128 lines, 32": INDIGO, "128 lines, 8": SKY, "512 lines, 32": MAROON,
    "512 lines, 8": ROSE, "VPL maps 12": SKY, "VPL maps 24": BLUE, "VPL imperfect": ORANGE, "VPL volumetric maps 32": SKY,
    "VPL volumetric maps 64": BLUE, "Mitsuba": OLIVE, "Cycles": PURPLE, "Cycles, guided": BLACK}
OTHERS = [BLACK, OLIVE, GREY]


def colour(method):
    """Of the longest known beginning of the name; one of OTHERS for a name without any."""
    known = [name for name in COLOURS if method.startswith(name)]
    return COLOURS[max(known, key=len)] if known else OTHERS[sum(map(ord, method)) % len(OTHERS)]


def figure(columns=1, height=520, rows=1, **options):
    """A figure of 960 pixels, and its axes in a list; `options` as for plt.subplots."""
    plt.rcParams.update({"font.size": 10, "svg.fonttype": "none", "svg.hashsalt": "mote"})
    made, axes = plt.subplots(rows, columns, figsize=(WIDTH / DPI, height / DPI), dpi=DPI, layout="constrained", squeeze=False, **options)
    made.get_layout_engine().set(w_pad=0.1, h_pad=0.08)
    return made, list(axes.flat)


def log_axes(axes, x, y, percent=True):
    """Both axes in logarithms with ticks at 1, 2 and 5; x and y: measures with their units. percent: y is a fraction."""
    axes.set(xscale="log", yscale="log", xlabel=x, ylabel=y)
    for axis, scale, unit in ((axes.xaxis, 1, ""), (axes.yaxis, 100 if percent else 1, " %" if percent else "")):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda v, _, s=scale, u=unit: f"{s * v:g}{u}"))
        axis.set_minor_locator(NullLocator())
    axes.grid(True, color="#e4e4e4", linewidth=0.8)
    axes.set_axisbelow(True)


def scene_rows(scenes, measure, height, ticks):
    """A row for each scene, the first on top, with errors along it in logarithms, in per cent: the figure, its axes, and
    height_of(scene, share of the row from its top)."""
    made, (axes,) = figure(height=height)
    for i in range(1, len(scenes)):
        axes.axhline(i, color="#c8c8c8", lw=0.8)
    axes.set(ylabel="scene", ylim=(0, len(scenes)), yticks=[i + 0.5 for i in range(len(scenes))])
    axes.set_yticklabels(scene.replace("_", " ") for scene in reversed(scenes))
    axes.set(xscale="log", xlabel=measure)
    axes.xaxis.set_major_locator(LogLocator(subs=ticks, numticks=12))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{100 * v:g} %"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.grid(True, axis="x", color="#e4e4e4", linewidth=0.8)
    return made, axes, lambda scene, share: len(scenes) - scenes.index(scene) - share


def legend_above(axes):
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.12), ncols=4, fontsize=10, frameon=False)


def label_ends(axes, ends, gap=15, size=10):
    """Names right of the axes, beside the points (name, x, y, colour), pushed apart where they would overlap; the layout makes room
    for them."""
    axes.figure.canvas.draw()
    placed, last = [], -1e9
    for name, x, y, own in sorted(ends, key=lambda end: end[2]):
        at = max(axes.transData.transform((x, y))[1], last + gap)
        placed.append((name, x, y, own, at))
        last = at
    top = axes.transAxes.transform((0, 1))[1]
    for i in reversed(range(len(placed))):
        name, x, y, own, at = placed[i]
        at = min(at, top - gap * (len(placed) - 1 - i))
        shown = axes.transAxes.inverted().transform((0, at))[1]
        axes.annotate(name, (x, y), xytext=(1.03, shown), textcoords="axes fraction", va="center", fontsize=size, color=own,
                      fontweight="bold", arrowprops={"arrowstyle": "-", "color": own, "linewidth": 0.7, "shrinkA": 0, "shrinkB": 3, "relpos": (0, 0.5)})


def difference(axes, values, scale, measure, below=None):
    """A signed difference: blue too dark, red too bright, full colour at `scale`; the colour bar names the measure. It stands right of
    the axes, or lies in the axes `below`, with the measure between its ends."""
    shown = axes.imshow(values, cmap="RdBu_r", vmin=-scale, vmax=scale, interpolation="nearest")
    shown.set_gid("difference")
    if below is None:
        bar = axes.figure.colorbar(shown, ax=axes, shrink=0.9)
        bar.set_label(measure)
    else:
        bar = axes.figure.colorbar(shown, cax=below, orientation="horizontal", ticks=[-scale, 0, scale])
        below.set_xticklabels([f"-{100 * scale:.3g} %", measure, f"+{100 * scale:.3g} %"])
        for label, anchor in zip(below.get_xticklabels(), ("left", "center", "right")):
            label.set_horizontalalignment(anchor)
    bar.ax.set_gid("colour bar")
    axes.set(xticks=[], yticks=[])


def save(made, path):
    """As PNG with its labels beside it (layout.py), or SVG by the suffix; without the date."""
    metadata = {"Date": None} if str(path).endswith(".svg") else {}
    made.savefig(path, dpi=DPI, metadata=metadata)
    if not metadata:
        layout.write(made, path)
    plt.close(made)
    if metadata:  # matplotlib leaves spaces at the ends of lines
        text = Path(path).read_text(encoding="utf-8")
        Path(path).write_text("".join(line.rstrip() + "\n" for line in text.splitlines()), encoding="utf-8")
