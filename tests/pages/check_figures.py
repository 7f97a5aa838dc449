#!/usr/bin/env python3
"""Can the figures of docs be read on a wall? Checks each SVG of docs/gallery, and each PNG by what was written beside it when it was
plotted (NAME.figure.json, experiments/figures/layout.py):

- no label reaches out of the canvas, and none is smaller than 9 points where the figure is 960 pixels wide;
- axes are named by a measure (MEASURES): both of each plot of a PNG, two of an SVG;
- labels of two lines do not lie on each other;
- a signed difference (id "difference") has a colour bar (id "colour bar") whose label names a measure.

Widths of letters are those of DejaVu Sans, the widest of the fonts that browsers choose here.

    tests/pages/check_figures.py ROOT
"""
import json
import math
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "experiments" / "figures"))
from origin import pixels
from pages import run

MIN_POINTS, SHOWN_WIDTH = 9, 960
MEASURES = ("relative RMSE", "relMSE", "bias", "difference", "seconds", "time", "luminance", "radiance", "lights", "method", "scene",
            "rays", "points", "pixels", "texels", "angle", "items", "layers", "levels", "samples", "links", "splats", "optical depth", "light lost", "noise")
WIDE, NARROW = 0.636, {**dict.fromkeys("ijl.,:;'|!", 0.33), **dict.fromkeys("frt-()[] /", 0.40), **dict.fromkeys("mwMW%", 0.95)}
NO_BAR = "a difference has no colour bar that names its measure"
SVG = "{http://www.w3.org/2000/svg}"


class Label(NamedTuple):
    text: str
    size: float
    box: tuple  # left, top, right, bottom


def width_of(text, size, bold):
    return size * sum(NARROW.get(c, WIDE) for c in text) * (1.1 if bold else 1.0)


def style_of(element, inherited):
    """Font size, anchor and weight: those of the element, else inherited."""
    found = dict(inherited)
    for name in ("font-size", "text-anchor", "font-weight"):
        if element.get(name):
            found[name] = element.get(name)
    for entry in element.get("style", "").split(";"):
        name, _, value = entry.partition(":")
        found[name.strip()] = value.strip()
    font = re.search(r"((?:bold|\d{3})\s+)?([\d.]+)px", found.pop("font", ""))
    if font:
        found["font-size"], found["font-weight"] = font.group(2), font.group(1) or "normal"
    return {k: v for k, v in found.items() if k in ("font-size", "text-anchor", "font-weight")}


def matrix_of(transform):
    """(a, b, c, d, e, f) of translate, scale and rotate."""
    result = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    for name, words in re.findall(r"(\w+)\(([^)]*)\)", transform or ""):
        v = [float(w) for w in re.split(r"[\s,]+", words.strip())]
        if name == "translate":
            result = times(result, (1, 0, 0, 1, v[0], v[1] if len(v) > 1 else 0))
        elif name == "scale":
            result = times(result, (v[0], 0, 0, v[-1], 0, 0))
        elif name == "rotate":
            c, s = math.cos(math.radians(v[0])), math.sin(math.radians(v[0]))
            x, y = (v[1], v[2]) if len(v) == 3 else (0, 0)
            result = times(result, (c, s, -s, c, x - c * x + s * y, y - s * x - c * y))
    return result


def times(m, n):
    return (m[0] * n[0] + m[2] * n[1], m[1] * n[0] + m[3] * n[1], m[0] * n[2] + m[2] * n[3], m[1] * n[2] + m[3] * n[3],
            m[0] * n[4] + m[2] * n[5] + m[4], m[1] * n[4] + m[3] * n[5] + m[5])


def labels_below(element, matrix, inherited):
    matrix, style = times(matrix, matrix_of(element.get("transform"))), style_of(element, inherited)
    if element.tag == SVG + "text":
        text, bold = " ".join("".join(element.itertext()).split()), style.get("font-weight", "normal") in ("bold", "700")
        size = float(re.match(r"[\d.]+", style.get("font-size", "16")).group())
        wide, x, y = width_of(text, size, bold), float(element.get("x", 0)), float(element.get("y", 0))
        x -= {"middle": 0.5, "end": 1.0}.get(style.get("text-anchor"), 0.0) * wide
        ends = [(matrix[0] * u + matrix[2] * v + matrix[4], matrix[1] * u + matrix[3] * v + matrix[5])
                for u in (x, x + wide) for v in (y - 0.75 * size, y + 0.2 * size)]
        xs, ys = zip(*ends)
        if text:
            yield Label(text, size * math.hypot(matrix[0], matrix[1]), (min(xs), min(ys), max(xs), max(ys)))
    for child in element:
        yield from labels_below(child, matrix, style)


def overlap(a, b):
    """Share of the smaller height and width that two boxes have in common, the lesser of both."""
    return min((min(a[i + 2], b[i + 2]) - max(a[i], b[i])) / max(1e-9, min(a[i + 2] - a[i], b[i + 2] - b[i])) for i in (0, 1))


def label_faults(labels, width):
    for label in labels:
        points = label.size * SHOWN_WIDTH / width * 72 / 96
        if points < MIN_POINTS - 0.01:
            yield f"'{label.text}' has {points:.1f} points at {SHOWN_WIDTH} pixels, less than {MIN_POINTS}"
    words = [label for label in labels if re.search(r"[A-Za-z]{3}", label.text)]
    for i, a in enumerate(words):
        for b in words[:i]:
            if overlap(a.box, b.box) > 0.3:
                yield f"'{a.text}' lies on '{b.text}'"


def outside(labels, width, height):
    for label in labels:
        left, top, right, bottom = label.box
        if left < 0 or top < 0 or right > width or bottom > height:
            yield f"'{label.text}' reaches out of the canvas"


def names_measure(text):
    return any(measure in text for measure in MEASURES)


def svg_faults(text):
    root = ElementTree.fromstring(text)
    _, _, width, height = map(float, root.get("viewBox").split())
    labels = list(labels_below(root, (1, 0, 0, 1, 0, 0), {}))
    yield from outside(labels, width, height)
    yield from label_faults(labels, width)
    named = [label for label in labels if names_measure(label.text)]
    if not any(label.box[3] - label.box[1] > label.box[2] - label.box[0] for label in named):
        yield "no vertical axis is named by a measure"
    if not any(label.box[3] > 0.6 * height for label in named):
        yield "no horizontal axis is named by a measure"
    ids = {element.get("id"): element for element in root.iter() if element.get("id")}
    if "difference" in ids:
        bar = ids.get("colour bar")
        if not names_measure(" ".join(bar.itertext()) if bar is not None else ""):
            yield NO_BAR


def png_faults(path, beside):
    layout = json.loads(beside.read_text(encoding="utf-8"))
    if layout["pixels"] != pixels(path):
        yield f"{beside.name} is that of another picture"
    labels = [Label(label["text"], label["size"], tuple(label["box"])) for label in layout["labels"]]
    yield from outside(labels, *layout["size"])
    yield from label_faults(labels, layout["size"][0])
    for axes in layout["axes"]:
        for side, name in (("y", "vertical"), ("x", "horizontal")):
            if not names_measure(axes[side]):
                yield f"a {name} axis is named by no measure: '{axes[side]}'"
    if any(not names_measure(difference["bar"] or "") for difference in layout["differences"]):
        yield NO_BAR


def check_pngs(root):
    for path in sorted((root / "docs/gallery").rglob("*.png")):
        name, beside = str(path.relative_to(root)), path.with_suffix(".figure.json")
        if beside.is_file():
            yield from (f"{name}: {fault}" for fault in dict.fromkeys(png_faults(path, beside)))
        else:
            yield f"{name}: no {beside.name} says what it shows"


def check(root):
    for path in sorted((root / "docs/gallery").rglob("*.svg")):
        for fault in dict.fromkeys(svg_faults(path.read_text(encoding="utf-8"))):
            yield f"{path.relative_to(root)}: {fault}"
    yield from check_pngs(root)


if __name__ == "__main__":
    sys.exit(run(lambda root: list(check(root)), sys.argv[1], "figures can be read on a wall"))
