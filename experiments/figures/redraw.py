#!/usr/bin/python3
"""Draws studies of the gallery again from their tables, without rendering: PNG, with the origin that the table states, and SVG.

    experiments/figures/redraw.py
"""
import importlib
import sys

import denoiser_plot
from origin import ROOT, csv_text, write_png_text

sys.path.insert(0, str(ROOT / "experiments/studies"))
STUDIES = ["many_virtual_lights", "ray_lights"]

if __name__ == "__main__":
    for name in STUDIES:
        table = ROOT / f"docs/gallery/{name}.csv"
        for suffix in (".svg", ".png"):
            importlib.import_module(name).plot_table(table, table.with_suffix(suffix))
        write_png_text(table.with_suffix(".png"), csv_text(table))
    table = ROOT / "docs/gallery/denoiser_quality.csv"
    denoiser_plot.plot_table(table, table.with_suffix(".svg"))
