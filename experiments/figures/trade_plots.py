#!/usr/bin/python3
"""The plots of trades in docs/gallery/trade, from the tables beside them: the mean over seeds, and their range as a band; also those
inside of the pages NAME.html.

    experiments/figures/trade_plots.py [NAME...]        all, or docs/gallery/trade/NAME.csv
"""
import csv
import re
import sys
from pathlib import Path

import plotting
from origin import ROOT, csv_text, table_of

FOLDER = ROOT / "docs/gallery/trade"
MARKERS = "os^Dv"
PEERS = {"Cornell box": "cornell_box", "smoke room": "smoke_room", "fog": "fog_grille", **{n: n for n in ("cloud", "atrium", "city")}}


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
    put_into(table.with_suffix(".html"), {None: table.with_suffix(".svg")})


def put_into(page, plots):
    """Replaces the plots of a page by these files: by the heading above a plot, or the only one (None); its table gets their colours."""
    if not page.is_file():
        return
    text = page.read_text(encoding="utf-8")
    parts = re.split(r"(<svg\b.*?</svg>)", text, flags=re.DOTALL)
    for i in range(1, len(parts), 2):
        heading = None if None in plots else re.findall(r"<h2>(.*?)</h2>", parts[i - 1])[-1]
        plot = plots[heading].read_text(encoding="utf-8")
        parts[i] = own_ids(plot[plot.index("<svg"):].rstrip(), plots[heading].stem)
    text = re.sub(r'(class="swatch" style="background:)[^"]*("></span>)([^<]+)',
                  lambda found: found[1] + plotting.colour(found[3]) + found[2] + found[3], "".join(parts))
    page.write_text(text, encoding="utf-8")


def own_ids(plot, name):
    """A page with several plots has each id once."""
    return re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}_", plot)


if __name__ == "__main__":
    for path in [FOLDER / f"{name}.csv" for name in sys.argv[1:]] or sorted(FOLDER.glob("*.csv")):
        draw(path)
    if not sys.argv[1:]:
        put_into(FOLDER / "peers.html", {heading: FOLDER / f"peers/{name}.svg" for heading, name in PEERS.items()})
