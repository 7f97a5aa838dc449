#!/usr/bin/python3
"""Draws plots of the gallery again from their tables, without rendering: PNG, with the origin that the table states, and SVG of those
that have one.

    experiments/figures/redraw.py [NAME...]
"""
import importlib
import sys

import denoiser_plot
from origin import ROOT, csv_text, write_png_text

sys.path.insert(0, str(ROOT / "experiments/studies"))
PLOTS = {"many_virtual_lights": (".svg", ".png"), "ray_lights": (".svg", ".png"), "engelhardt_06_queries": (".png",),
         "engelhardt_08_12_scaling": (".png",), "hermes_table_1": (".png",), "tokuyoshi_b_imperfect": (".png",)}

if __name__ == "__main__":
    for name in sys.argv[1:] or PLOTS:
        table = ROOT / f"docs/gallery/{name}.csv"
        for suffix in PLOTS[name]:
            importlib.import_module(name).plot_table(table, table.with_suffix(suffix))
        write_png_text(table.with_suffix(".png"), csv_text(table))
    if not sys.argv[1:]:
        table = ROOT / "docs/gallery/denoiser_quality.csv"
        denoiser_plot.plot_table(table, table.with_suffix(".svg"))
