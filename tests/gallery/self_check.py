#!/usr/bin/env python3
"""Proves that check_gallery.py can fail: plants errors in a gallery of one picture and expects each to be found."""
import struct
import sys
import tempfile
import zlib
from pathlib import Path

import check_gallery
from origin import SIGNATURE, Origin, write_png_text

INDEX = "# Gallery\n\n| figure | here |\n|---|---|\n| [A figure](figure.md) | 12 ± 1 % of the light |\n"
SECTION = """# A figure

![A figure](figure.png)

    experiments/figures/figure.py

It takes 3.5 s, and {loss} % are lost.

| scene | seconds |
|---|---|
| bunny | 3.5 s |{row}

<!--
12 ± 1 % = bunny; share; share_error
3.5 s = bunny; seconds
3.5 s = scene: bunny; seconds
-->
"""
CHECKS = "<!--\n{loss} % = claim: the bound\n-->\n"
TABLE = "scene,share,share_error,seconds\nbunny,0.123,0.0096,3.52\nclaim,measured,holds\nthe bound takes light,4.2 +- 0.1 %,holds\n"


def plant(root, loss="4.2", row="", table=TABLE, after=None, width=960, **facts):
    for folder in ("docs/gallery", "experiments/figures"):
        (root / folder).mkdir(parents=True, exist_ok=True)
    (root / "experiments/figures/figure.py").write_text("")
    (root / "docs/gallery/index.md").write_text(INDEX, encoding="utf-8")
    (root / "docs/gallery/figure.md").write_text(SECTION.format(loss=loss, row=row), encoding="utf-8")
    (root / "docs/gallery/figure.checks").write_text(CHECKS.format(loss=loss), encoding="utf-8")
    picture, csv = root / "docs/gallery/figure.png", root / "docs/gallery/figure.csv"
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    picture.write_bytes(SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", width, 1, 8, 0, 0, 0, 0)) +
                        chunk(b"IDAT", zlib.compress(bytes(1 + width))) + chunk(b"IEND", b""))
    csv.write_text(table)
    origin = Origin.__new__(Origin)
    origin.facts = {"Script": "experiments/figures/figure.py", "Run": "full", "Commit": "0123456789ab", **facts}
    origin.renders, origin.programs = {}, set()
    origin.stamp(picture, csv)
    if after:
        after(picture, csv)


def edit(csv, old, new):
    csv.write_text(csv.read_text().replace(old, new))


CASES = [  # what is planted, what is found ('' for nothing)
    ({}, ""),
    ({"Run": "quick"}, "the run was quick"),
    ({"Commit": "0123456789ab+"}, "is none of this repository"),
    ({"Script": "experiments/figures/other.py"}, "which the section does not name"),
    ({"loss": "4.3"}, "the claim measured 4.2"),
    ({"row": "\n| dragon | 7.5 s |"}, "no number of this row is compared with the table: | dragon"),
    ({"table": TABLE.replace("0.123", "0.1271")}, "the table has 0.1271"),
    ({"table": TABLE.replace("3.52", "3.56")}, "the table has 3.56"),
    ({"table": TABLE.replace("bunny,", "dragon,")}, "no row bunny"),
    ({"after": lambda picture, csv: edit(csv, "3.52", "3.51")}, "not the one that was written with the picture"),
    ({"after": lambda picture, csv: edit(csv, "Run: full", "Run: quick")}, "do not come from one run"),
    ({"after": lambda picture, csv: csv.unlink()}, "no table lies beside it"),
    ({"after": lambda picture, csv: write_png_text(picture, {})}, "does not say: Script, Run, Commit"),
    ({"width": 959}, "only 959 pixels wide"),
    ({"Recorded": "afterwards"}, "the section does not say"),
]


def main():
    failed = 0
    for facts, expected in CASES:
        with tempfile.TemporaryDirectory() as folder:
            plant(Path(folder), **facts)
            found = "\n".join(check_gallery.check(Path(folder)))
        if (expected not in found) if expected else found:
            print(f"{list(facts)}: expected '{expected}', found '{found}'")
            failed += 1
    print(f"{len(CASES)} galleries, {failed} not judged as they should be")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
