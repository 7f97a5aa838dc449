"""A trade as a figure for a paper: python -m mote.plot out/trade figure.pdf [--style style.json]

From trade.csv and every *.peer.csv of a folder of `mote trade`: error against time, the mean over seeds with error bars.
Files that end in .tex hold pgfplots (\\usepackage{pgfplots}, \\input{figure.tex}); .pdf, .svg and .png need matplotlib.

The style file says what the paper calls things; all is optional:

    {"methods": {"VPL bounded": {"label": "VPLs, b = 4", "color": "#0072b2", "marker": "s"}, "probe": {"hide": true}},
     "order": ["VPL bounded", "path"], "width": 3.4, "height": 2.6, "font": 8, "title": "Cornell box",
     "seconds": [0.1, 100], "errors": [0.005, 1], "bars": "interval"}

width and height in inches. bars: "interval", 95 % of the mean over seeds (Student's t) together with the reference's noise;
"range" over seeds; or "none". One seed has no bars but those of the reference. A bar that reaches zero leaves the axis. Colours
follow "order", then the methods file, so that a method keeps its colour over scenes.
"""
from __future__ import annotations

import argparse
import csv
import json
import math
import statistics
import sys
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Union

# Okabe and Ito's colours without the yellow, as in trade.svg.
_COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]
_MARKERS = ["o", "s", "^", "D", "v", "P", "X"]
_PGF_MARKERS = {"o": "*", "s": "square*", "^": "triangle*", "D": "diamond*", "v": "pentagon*", "P": "+", "X": "x"}
_STUDENT = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228]  # 97.5 % of 1, 2, ... degrees of freedom
_STYLE = {"methods", "order", "width", "height", "font", "title", "seconds", "errors", "bars"}
_METHOD = {"label", "color", "marker", "hide"}


def student(freedom: int) -> float:
    """97.5 % point of Student's t: half of an interval of 95 %, in standard errors."""
    return _STUDENT[freedom - 1] if freedom <= len(_STUDENT) else 1.96 + 2.8 / (freedom + 1)


class Point(NamedTuple):
    """Several seeds after the same number of passes, or all at their end: means, and the ends of the error bar."""
    seconds: float
    error: float
    lower: float
    upper: float
    seeds: int


def _bar(errors: List[float], noise: float, bars: str) -> tuple:
    n, mean = len(errors), sum(errors) / len(errors)
    if bars == "range":
        return min(errors), max(errors)
    if bars == "none":
        return mean, mean
    spread = 0.0
    if n > 1:
        spread = student(n - 1) * statistics.stdev(errors) / math.sqrt(n)
    half = math.hypot(spread, 1.96 * noise)
    return mean - half, mean + half


def curves(folder: Union[str, Path], bars: str = "interval") -> Dict[str, List[Point]]:
    """The points of every method in order of time."""
    rows: List[Mapping[str, str]] = []
    for file in [Path(folder) / "trade.csv", *sorted(Path(folder).glob("*.peer.csv"))]:
        with file.open(encoding="utf-8", newline="") as stream:
            rows += list(csv.DictReader(stream))
    groups: Dict[str, Dict[str, List[Mapping[str, str]]]] = {}
    for row in rows:
        if row.get("below_reference") != "1" and float(row["error"] or "nan") > 0:
            end = "end" if row.get("final") == "1" else row["passes"]
            groups.setdefault(row["method"], {}).setdefault(end, []).append(row)
    found: Dict[str, List[Point]] = {}
    for method, by_passes in groups.items():
        most = max(len(same) for same in by_passes.values())
        points = []
        for same in by_passes.values():
            if len(same) < most:
                continue  # not all seeds came so far
            errors = [float(row["error"]) for row in same]
            noise = [float(row["error_se"]) for row in same if row.get("error_se")]
            noise = [x for x in noise if math.isfinite(x)]
            low, high = _bar(errors, sum(noise) / len(noise) if noise else 0.0, bars)
            seconds = sum(float(row["wall_s"]) for row in same) / len(same)
            points.append(Point(seconds, sum(errors) / len(errors), low, high, len(same)))
        found[method] = sorted(points)
    return found


def _places(folder: Union[str, Path], style: Mapping[str, Any], found: Mapping[str, Any]) -> List[str]:
    """Names of all methods in order: of the style, of the methods file (also those without points), of other renderers."""
    names = list(style.get("order", []))
    facts = Path(folder) / "trade.json"
    if facts.exists():
        names += [method["name"] for method in json.loads(facts.read_text(encoding="utf-8"))["facts"]["methods"]]
    return list(dict.fromkeys([*names, *found]))


def _lowest(lines: List[tuple]) -> float:
    """Lower end of the axis: bars are inside of it as far down as a third of their means."""
    return 0.9 * min(max(p.lower, p.error / 3) for _, _, points in lines for p in points)


def _error_axis(style: Mapping[str, Any]) -> str:
    return "relative RMSE [%]" + {"interval": ", bars 95 %", "range": ", bars range of seeds", "none": ""}[style.get("bars", "interval")]


def _minus(point: Point) -> float:
    """Length of the lower half of a bar [%]: what reaches zero or less ends far below the axis, which is logarithmic."""
    return 100 * min(point.error - point.lower, (1 - 1e-6) * point.error)


def _checked(style: Mapping[str, Any], methods: List[str]) -> None:
    for key in style:
        if key not in _STYLE:
            raise ValueError(f"style: unknown '{key}'; known are {', '.join(sorted(_STYLE))}")
    for name, of in style.get("methods", {}).items():
        if name not in methods:
            raise ValueError(f"style: the trade has no method '{name}'; it has {', '.join(methods)}")
        for key in of:
            if key not in _METHOD:
                raise ValueError(f"style: unknown '{key}' of '{name}'; known are {', '.join(sorted(_METHOD))}")
    if style.get("bars", "interval") not in ("interval", "range", "none"):
        raise ValueError("style: bars is \"interval\", \"range\" or \"none\"")


def _tex(text: str) -> str:
    return "".join({"%": r"\%", "&": r"\&", "_": r"\_", "#": r"\#", "$": r"\$"}.get(c, c) for c in text)


def _pgfplots(lines: List[tuple], style: Mapping[str, Any]) -> str:
    axis = ["xlabel={wall time [s]}", f"ylabel={{{_tex(_error_axis(style))}}}", f"width={style.get('width', 3.4)}in",
            f"height={style.get('height', 2.6)}in", "grid=both", "legend pos=outer north east", "legend cell align=left"]
    axis += [f"title={{{_tex(style['title'])}}}"] if style.get("title") else []
    axis += [] if style.get("errors") else [f"ymin={100 * _lowest(lines):.3g}"]
    for key, name, scale in (("seconds", "x", 1.0), ("errors", "y", 100.0)):
        if style.get(key):
            axis += [f"{name}min={scale * style[key][0]:g}", f"{name}max={scale * style[key][1]:g}"]
    text = "% Written by mote.plot.\n\\begin{tikzpicture}\n"
    for i, (_, of, _) in enumerate(lines):
        text += f"\\definecolor{{mote{i}}}{{HTML}}{{{of['color'].lstrip('#').upper()}}}\n"
    text += "\\begin{loglogaxis}[" + ", ".join(axis) + "]\n"
    for i, (label, of, points) in enumerate(lines):
        mark = _PGF_MARKERS.get(of["marker"], "*")
        text += f"\\addplot[color=mote{i}, mark={mark}, mark size=1.2pt, error bars/.cd, y dir=both, y explicit]\n"
        text += "  table[x=t, y=e, y error plus=p, y error minus=m] {\n  t e p m\n"
        text += "".join(f"  {p.seconds:.6g} {100 * p.error:.6g} {100 * (p.upper - p.error):.6g} {_minus(p):.8g}\n" for p in points)
        text += f"  }};\n\\addlegendentry{{{_tex(label)}}}\n"
    return text + "\\end{loglogaxis}\n\\end{tikzpicture}\n"


def _draw(lines: List[tuple], style: Mapping[str, Any], output: Path) -> None:
    try:
        import matplotlib
    except ImportError as problem:
        raise ImportError(f"{output.suffix} needs matplotlib (pip install matplotlib); .tex does not") from problem
    matplotlib.use("Agg")
    from matplotlib import pyplot, ticker
    settings = {"font.size": style.get("font", 8), "pdf.fonttype": 42, "svg.hashsalt": "mote", "axes.linewidth": 0.6}
    with matplotlib.rc_context(settings):
        figure, axes = pyplot.subplots(figsize=(style.get("width", 3.4), style.get("height", 2.6)), layout="constrained")
        for label, of, points in lines:
            x, y = [p.seconds for p in points], [100 * p.error for p in points]
            bars = [[_minus(p) for p in points], [100 * (p.upper - p.error) for p in points]]
            axes.errorbar(x, y, bars, color=of["color"], marker=of["marker"], markersize=3, linewidth=1, elinewidth=0.6,
                          capsize=1.5, label=label)
        axes.set(xscale="log", yscale="log", xlabel="wall time [s]", ylabel=_error_axis(style), title=style.get("title", ""))
        if style.get("seconds"):
            axes.set_xlim(style["seconds"])
        axes.set_ylim([100 * e for e in style["errors"]] if style.get("errors") else (100 * _lowest(lines), None))
        for axis in (axes.xaxis, axes.yaxis):  # 1, 2, 5, 10, not powers of ten: ranges are often less than one
            axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter(ticker.FormatStrFormatter("%g"))
            axis.set_minor_locator(ticker.NullLocator())
        axes.grid(True, which="major", linewidth=0.4, color="#d4d4d4")
        axes.legend(frameon=False)
        dates = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(output.suffix.lower())
        figure.savefig(output, metadata=dates, dpi=300)
        pyplot.close(figure)


def plot(folder: Union[str, Path], output: Union[str, Path], style: Optional[Mapping[str, Any]] = None) -> None:
    """Draws the trade in `folder` into a .tex, .pdf, .svg or .png file. Raises ValueError for a style that does not fit."""
    style, output = style or {}, Path(output)
    found = curves(folder, style.get("bars", "interval"))
    _checked(style, _places(folder, {}, found))
    lines = []
    for i, name in enumerate(_places(folder, style, found)):
        of = {"color": _COLOURS[i % len(_COLOURS)], "marker": _MARKERS[i % len(_MARKERS)], **style.get("methods", {}).get(name, {})}
        if found.get(name) and not of.get("hide"):
            lines.append((of.get("label", name), of, found[name]))
    if not lines:
        raise ValueError(f"nothing to draw in {folder}: no method has points, or all are hidden")
    if output.suffix.lower() == ".tex":
        output.write_text(_pgfplots(lines, style), encoding="utf-8")
    else:
        _draw(lines, style, output)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m mote.plot", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="the folder of a trade")
    parser.add_argument("output", help="a .tex, .pdf, .svg or .png file")
    parser.add_argument("--style", help="a JSON file")
    arguments = parser.parse_args()
    try:
        style = json.loads(Path(arguments.style).read_text(encoding="utf-8")) if arguments.style else None
        plot(arguments.folder, arguments.output, style)
    except (OSError, ValueError, ImportError) as error:
        sys.exit(f"mote.plot: {error}")


if __name__ == "__main__":
    main()
