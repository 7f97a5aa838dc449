"""Error against processor time of the qualities of OpenImageDenoise, from the table of experiments/studies/denoiser_quality.py."""
import csv

import plotting
from origin import table_of

QUALITIES = {("high", "high"): ("both high", plotting.BLUE), ("balanced", "high"): ("features balanced", plotting.ORANGE_RED),
             ("balanced", "balanced"): ("both balanced", plotting.GREEN), ("fast", "fast"): ("both fast", plotting.PURPLE)}


def plot_table(table, picture):
    """A line for each scene and number of samples, a mark for each choice of qualities."""
    rows = list(csv.DictReader(table_of(table).splitlines()))
    made, (axes,) = plotting.figure(height=560)
    plotting.log_axes(axes, "processor time of the denoiser [s]", plotting.RMSE)
    of_row = lambda row: (row["scene"], row["passes"])
    highest = of_row(max(rows, key=lambda row: float(row["error"])))
    ends = []
    for key in dict.fromkeys(map(of_row, rows)):
        own = [row for row in rows if of_row(row) == key]
        x, y = ([float(row[name]) for row in own] for name in ("cpu_s", "error"))
        axes.plot(x, y, color=plotting.GREY, linewidth=1.2, linestyle="-" if key[1] == "1" else "--", zorder=1)
        for row, *at in zip(own, x, y):
            label, colour = QUALITIES[row["features"], row["colour"]]
            axes.scatter(*at, color=colour, s=40, zorder=2)
            if key == highest:
                axes.annotate(label, at, xytext=(0, 12), textcoords="offset points", ha="center", color=colour, fontweight="bold")
        ends.append((f"{key[0].replace('_', ' ')}, {key[1]} sample{'s' * (key[1] != '1')}", x[0], y[0], plotting.GREY))
    axes.set(xlim=(0.75, 2.6), ylim=(0.027, 0.25))
    axes.set_title("OpenImageDenoise by qualities, 640 x 400 pixels", loc="left", fontsize=12)
    plotting.label_ends(axes, ends)
    plotting.save(made, picture)
