#!/usr/bin/env python3
"""The tables of docs/measurements/peers.md and of the README, and the lines that check them, from the page and the CSV files
of a full run.

    experiments/peers/real_sizes/tables.py [FOLDER]      docs/gallery/trade: peers.html and peers/*.csv
"""
import csv
import re
import sys
from html import unescape
from pathlib import Path

SCENES = ("smoke_room", "smoke room"), ("cornell_box", "Cornell box"), ("fog_grille", "fog"), ("cloud", "cloud"), ("atrium", "atrium"), ("city", "city")
TIMED = {"mote layers": "`mote_layers`", "mote path tracer + OIDN": "path tracer", "Mitsuba + OIDN": "Mitsuba",
         "Cycles + OIDN": "Cycles", "Cycles, guided + OIDN": "guided", "mote path tracer": "path tracer, not denoised"}
README = {"mote layers": "`mote_layers`", "mote path tracer + OIDN": "`volpath` and OpenImageDenoise", "mote path tracer": "`volpath`",
          "mote VPL": "`mote_vpl`, bounded", "Mitsuba + OIDN": "Mitsuba 3 and OpenImageDenoise",
          "Cycles + OIDN": "Cycles and OpenImageDenoise"}


def runs_of(file):
    """{method: its runs}; numbers as numbers."""
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    found = {}
    for row in csv.DictReader(lines):
        run = {k: float(row[k]) for k in ("wall_s", "error", "error_se", "bias", "bias_se")}
        found.setdefault(row["method"], []).append({**run, "seed": row["seed"]})
    return found


def percent(value, error, sign=""):
    return f"{100 * value:{sign}.1f} ± {100 * error:.1f} %"


def seconds_of(page):
    """{title of a scene: {method: {"5": text, "2.5": text}}} of peers.html, without processor seconds."""
    found = {}
    for title, table in re.findall(r"<h2>(.*?)</h2>.*?<table>(.*?)</table>", page, re.S):
        rows = [[unescape(c) for c in re.findall(r"<t[hd]>(.*?)</t[hd]>", row)] for row in re.findall(r"<tr>(.*?)</tr>", table, re.S)]
        columns = {head[5:-2]: i for i, head in enumerate(rows[0]) if head.startswith("s to ")}
        found[unescape(title)] = {row[0]: {t: row[i].split(" (")[0] for t, i in columns.items()} for row in rows[1:]}
    return found


def times(seconds, target):
    checks = ["<!-- docs/gallery/trade/peers.html"]
    print(f"| seconds to {target} % |", " | ".join(TIMED.values()), "| plot |")
    print("|---" * (len(TIMED) + 2) + "|")
    for name, title in SCENES:
        cells = [seconds[title][method][target] for method in TIMED]
        print(f"| {title} |", " | ".join(cells), f"| [svg](../gallery/trade/peers/{name}.svg) |")
        checks += [f"{cell} = {title} / {method}; s to {target} %" for cell, method in zip(cells, TIMED)]
    print("\n".join([*checks, "-->"]))


def readme(runs):
    checks = []
    for method, label in README.items():
        last = runs[method][-1]
        cells = f"{last['wall_s']:.1f} | {percent(last['error'], last['error_se'])} | {percent(last['bias'], last['bias_se'], '+')}"
        print(f"| {label} | {cells} |")
        checks.append(f"{cells} = method: {method}, seed: {last['seed']}; wall_s; error; error_se; bias; bias_se")
    print("\n".join(checks))


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery/trade")
    seconds = seconds_of((folder / "peers.html").read_text(encoding="utf-8"))
    for target in ("5", "2.5"):
        if target in seconds["cloud"]["mote layers"]:
            times(seconds, target)
    readme(runs_of(folder / "peers" / "smoke_room.csv"))


if __name__ == "__main__":
    main()
