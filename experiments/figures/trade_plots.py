#!/usr/bin/python3
"""The plots of trades in docs/gallery/trade, from the tables beside them: the mean over seeds, and their range as a band.

    experiments/figures/trade_plots.py [NAME...]        all, or docs/gallery/trade/NAME.csv
"""
import csv
import sys
from pathlib import Path

import plotting
from origin import ROOT, csv_text, table_of

FOLDER = ROOT / "docs/gallery/trade"
MARKERS = "os^Dv"


def draw(table):
    facts, rows = csv_text(table), list(csv.DictReader(table_of(table).splitlines()))
    made, (axes,) = plotting.figure(height=560)
    plotting.log_axes(axes, "wall time [s]", facts["Measure"])
    ends = []
    for i, name in enumerate(dict.fromkeys(row["method"] for row in rows)):
        own, colour = [row for row in rows if row["method"] == name], plotting.colour(name)
        x, y = ([float(row[key]) for row in own] for key in ("wall_s", "error"))
        if own[0]["lowest"] and len(own) > 1:
            axes.fill_between(x, *([float(row[key]) for row in own] for key in ("lowest", "highest")), color=colour, alpha=0.16, linewidth=0)
        axes.plot(x, y, color=colour, marker=MARKERS[i % len(MARKERS)], markersize=5, linewidth=1.6)
        ends.append((name, x[-1], y[-1], colour))
    if "Reference" in facts:
        floor = float(facts["Reference"].split()[-2]) / 100
        low, high = axes.get_ylim()
        if low < floor < high:
            axes.axhspan(low, floor, color="#f3f3f3", zorder=0)
            axes.text(0.01, floor * 0.97, "below: less than the reference judges", transform=axes.get_yaxis_transform(), va="top", fontsize=10,
                      color="#555555")
            axes.set_ylim(low, high)
    axes.set_title(f"{facts['Scene']}: mean over seeds, and their range", loc="left", fontsize=12)
    plotting.label_ends(axes, ends)
    plotting.save(made, table.with_suffix(".svg"))


if __name__ == "__main__":
    for path in [FOLDER / f"{name}.csv" for name in sys.argv[1:]] or sorted(FOLDER.glob("*.csv")):
        draw(path)
