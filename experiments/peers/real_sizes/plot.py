"""An SVG of errors against time, both in logarithms: a line for each method, whiskers of one standard error. One colour a
renderer; dashed: as the passes left it, without denoiser.

    plot.py PEERS.csv PEERS.svg TITLE        draws the table of an earlier run again
"""
import csv
import io
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "figures"))
import plotting  # noqa: E402


def svg(title, methods):
    """methods: (name, runs, without denoiser)."""
    methods = [(name, [r for r in runs if r["error"] > 0], raw) for name, runs, raw in methods]
    methods = [m for m in methods if m[1]]
    if not methods:
        return ""
    made, (axes,) = plotting.figure(height=560)
    plotting.log_axes(axes, "seconds of rendering, two cores", plotting.RMSE)
    ends = []
    for name, runs, raw in methods:
        colour = plotting.colour(name)
        x, y = [r["wall_s"] for r in runs], [r["error"] for r in runs]
        bars = [[min(r["error_se"], 0.9 * r["error"]) for r in runs], [r["error_se"] for r in runs]]
        axes.errorbar(x, y, bars, color=colour, linestyle="--" if raw else "-", marker="o", markersize=4, linewidth=1.6)
        ends.append((name, x[-1], y[-1], colour))
    axes.set_title(title, loc="left", fontsize=13)
    plotting.label_ends(axes, ends)
    text = io.StringIO()
    made.savefig(text, format="svg", dpi=plotting.DPI, metadata={"Date": None})
    return text.getvalue()


def of_table(path):
    """The methods of a CSV file that run.py wrote."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("# ")))
    names = list(dict.fromkeys(row["method"] for row in rows))
    numbers = lambda row: {key: float(row[key]) for key in ("wall_s", "error", "error_se")}
    return [(name, [numbers(row) for row in rows if row["method"] == name], not (name.endswith("+ OIDN") or name == "mote layers"))
            for name in names]


if __name__ == "__main__":
    Path(sys.argv[2]).write_text(svg(sys.argv[3], of_table(sys.argv[1])), encoding="utf-8")
