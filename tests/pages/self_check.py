#!/usr/bin/env python3
"""Proves that the checks of pages can fail: plants one fault at a time in a small tree and expects it to be found."""
import json
import struct
import sys
import tempfile
from pathlib import Path

import check_figures
import check_gifs
import check_length
import check_links
import check_names
import check_numbers
import check_words
import numpy as np
from PIL import Image

README = """# mote

Read [the page](docs/page.md#a-heading-with-code) and [the guide](docs/guide.md), [the design](docs/design.md), [formats](docs/scene-format.md), [other](docs/other.md).

`path`, by `mote render` with `--passes 8`.
"""
PAGE = """# Page

One sentence that says once what a reader can do after reading this page, and nothing else besides that.

## A heading with `code`

`core/ray.h` holds `make_ray()`; `mote_tests_core "[ray]"` and `mote_tests_core "rays are*"` test it.

| path | 8.9 ± 0.3 % | 12.5 |
|---|---|---|
| ≈ 33 | | |

<!-- docs/gallery/table.csv
8.9 ± 0.3 % | 12.5 = method: path, passes: 8; error; error_se; seconds
-->
<!-- docs/gallery/trade.html
≈ 33 = box / path; s to 5 %
-->
"""
SVG = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 960 560" font-size="13">
<g transform="translate(100 0)"><text x="600" y="100" font-weight="bold">layers</text><text x="600" y="120">ray lights</text></g>
<text style="font: 12px sans-serif; text-anchor: middle" transform="rotate(-90 18 270)" x="18" y="270">relative RMSE</text>
<text x="400" y="540" text-anchor="middle">wall time</text>
<g id="difference"/><g id="colour bar"><text x="900" y="300">bias [%]</text></g>
</svg>
"""


def png(shade):
    """A PNG file with one chunk of data, a letter a byte."""
    data = b"\x89PNG\r\n\x1a\n"
    for kind, content in ((b"IHDR", struct.pack(">II", 960, 560)), (b"IDAT", bytes([shade]))):
        data += struct.pack(">I", len(content)) + kind + content + bytes(4)
    return data.decode("latin-1")


def digest(text):
    with tempfile.NamedTemporaryFile() as file:
        Path(file.name).write_bytes(text.encode("latin-1"))
        return check_figures.pixels(file.name)


LAYOUT_FILE = "docs/gallery/drawn.figure.json"
LAYOUT = json.dumps({"size": [960, 560], "pixels": digest(png(1)), "axes": [{"x": "wall time", "y": "relative RMSE"}],
                    "labels": [{"text": "layers", "size": 13, "box": [800, 90, 880, 110]}, {"text": "ray lights", "size": 13, "box": [800, 120, 880, 140]}],
                    "differences": [{"box": [0, 0, 300, 300], "bar": "-5 % luminance / white +5 %"}]})
TREE = {
    "docs/gallery/plot.svg": SVG,
    "docs/gallery/drawn.png": png(1),
    "docs/gallery/drawn.figure.json": LAYOUT,
    "README.md": README,
    "docs/page.md": PAGE,
    "docs/guide.md": "# Guide\n",
    "docs/design.md": "# Design\n\n`math` is a floor of core.\n",
    "docs/scene-format.md": "# Formats\n\n## Integrators\n\n### `path`\n\n## Visibility\n\n### `traced`\n",
    "apps/command.cpp": 'app.add_subcommand(\n        "render", "Renders").add_option("--passes");\n',
    "core/math/ray_math.h": "Ray ray_math();\n",
    "docs/other.md": "# Other\n\n\u2248 33 s\n",
    "docs/other.checks": "# Other\n<!-- docs/gallery/trade.html\n\u2248 33 = box / path; s to 5 %\n-->\n",
    "docs/references.bib": "@book{Veach1997, title = {x}}\n@book{Keller1997, title = {y}}\n",
    "core/ray.h": "// Rays (docs/page.md,\n// \"A heading\").\nRay make_ray();\n",
    "tests/core/ray_test.cpp": 'TEST_CASE("rays are straight", "[ray]") {}\n',
    "docs/gallery/table.csv": "# Commit: 0123456789ab\nmethod,passes,error,error_se,seconds\npath,8,0.0888,0.0031,12.48\n",
    "docs/gallery/trade.html": "<h2>box</h2><table><tr><th>method</th><th>s to 5 %</th></tr><tr><td>path</td><td>\u2248 33 (\u2248 59)</td></tr></table>",
}
TWICE = " One sentence that says once what a reader can do after reading this page, and nothing else besides that."
ROW = "\n| a cell that is long enough | another | " + "words " * 20 + "{} |"

CASES = [  # check, file, what is replaced by what, what is found
    (check_links, "README.md", "docs/page.md#a-heading-with-code", "docs/pages.md", "there is no docs/pages.md"),
    (check_links, "README.md", "#a-heading-with-code", "#another", "has no heading '#another'"),
    (check_links, "README.md", "[the page](docs/page.md#a-heading-with-code)", "the page", "docs/page.md: neither"),
    (check_links, "core/ray.h", "A heading", "Another", "core/ray.h: docs/page.md has no heading 'Another'"),
    (check_names, "docs/page.md", "core/ray.h", "core/rays.h", "docs/page.md:7: there is no core/rays.h"),
    (check_names, "docs/page.md", "make_ray()", "make_rays()", "no source has the name make_rays()"),
    (check_names, "docs/page.md", "[ray]", "[rays]", "has the tag [rays]"),
    (check_names, "docs/page.md", "rays are*", "rays were*", "has no case 'rays were*'"),
    (check_names, "docs/page.md", "\n\n## A", "\n" + TWICE + "\n\n## A", "says twice: One sentence"),
    (check_names, "docs/page.md", "|---|---|---|", "|---|---|---|" + ROW.format(1) + ROW.format(2), "two rows of a table begin"),
    (check_names, "README.md", "--passes", "--pases", "no source has the option --pases"),
    (check_names, "README.md", "`path`", "path", "does not name the integrator path"),
    (check_names, "README.md", "`mote render`", "it", "does not name the command mote render"),
    (check_names, "docs/design.md", "`math`", "math", "no table of floors names core/math"),
    (check_names, "docs/references.bib", "Keller1997", "Veach1997", "Veach1997 comes twice"),
    (check_words, "docs/guide.md", "# Guide", "# Guide\n\nA light that is drawn knows its place.", "docs/guide.md:3: 'light that is drawn': sampled"),
    (check_words, "docs/guide.md", "# Guide", "# Guide\n\nA node asks its parent.", "docs/guide.md:3: 'asks'"),
    (check_numbers, "docs/gallery/table.csv", "0.0888", "0.0901", "the table has 0.0901"),
    (check_numbers, "docs/page.md", "| 12.5 |", "| 12.6 |", "'8.9 ± 0.3 % | 12.5' is not in the text"),
    (check_numbers, "docs/page.md", "passes: 8", "passes: 9", "no row method: path, passes: 9"),
    (check_numbers, "docs/gallery/trade.html", "33 ", "34 ", "the table has ≈ 34"),
    (check_numbers, "docs/page.md", "docs/gallery/table.csv", "docs/gallery/other.csv", "there is no docs/gallery/other.csv"),
    (check_numbers, "docs/page.md", "<!-- docs/gallery/table.csv", "<!--", "table.csv: no page compares"),
    (check_numbers, "docs/gallery/table.csv", "0123456789ab", "0123456789ab+", ""),
    (check_length, "docs/page.md", "# Page", "# Page\n" + "long " * check_length.MAX_WORDS, "the pages have 4"),
    (check_length, "docs/design.md", "# Design", "# Design\n" + "long " * check_length.MAX_INSIDE, "docs/design.md: 500"),
    (check_figures, "docs/gallery/plot.svg", ">layers<", ">layers with a far longer name than fits beside the axes<", "reaches out of the canvas"),
    (check_figures, "docs/gallery/plot.svg", "translate(100 0)", "translate(400 0)", "'layers' reaches out of the canvas"),
    (check_figures, "docs/gallery/plot.svg", "translate(100 0)", "translate(100 0) scale(0.8)", "'layers' has 7.8 points"),
    (check_figures, "docs/gallery/plot.svg", "font: 12px", "font: 11px", "'relative RMSE' has 8.2 points"),
    (check_figures, "docs/gallery/plot.svg", "relative RMSE", "error", "no vertical axis"),
    (check_figures, "docs/gallery/plot.svg", "rotate(-90 18 270)", "translate(100 0)", "no vertical axis"),
    (check_figures, "docs/gallery/plot.svg", "wall time", "abscissa", "no horizontal axis"),
    (check_figures, "docs/gallery/plot.svg", 'y="120"', 'y="105"', "'ray lights' lies on 'layers'"),
    (check_figures, "docs/gallery/plot.svg", 'id="colour bar"', "", "no colour bar"),
    (check_figures, "docs/gallery/plot.svg", "bias [%]", "0.5", "no colour bar"),
    (check_figures, LAYOUT_FILE, "880, 110", "961, 110", "'layers' reaches out of the canvas"),
    (check_figures, LAYOUT_FILE, "800, 90", "800, -1", "'layers' reaches out of the canvas"),
    (check_figures, LAYOUT_FILE, '"size": 13', '"size": 11', "'layers' has 8.2 points"),
    (check_figures, LAYOUT_FILE, "880, 110", "880, 130", "'ray lights' lies on 'layers'"),
    (check_figures, LAYOUT_FILE, "relative RMSE", "error", "a vertical axis"),
    (check_figures, LAYOUT_FILE, "wall time", "abscissa", "a horizontal axis"),
    (check_figures, LAYOUT_FILE, '"-5 % luminance / white +5 %"', "null", "drawn.png: a difference has no colour bar"),
    (check_figures, LAYOUT_FILE, "luminance / white", "", "drawn.png: a difference has no colour bar"),
    (check_figures, "docs/gallery/drawn.png", png(1), png(3), "drawn.figure.json is that of another picture"),
    (check_numbers, "docs/other.checks", "33 =", "34 =", "34' is not in the text"),
]
LINKED = "\n[table](gallery/table.csv)\n"


def found(check, edits, without=()):
    """Offences found in the tree with these edits, and without these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in TREE.items():
            if name in without:
                continue
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            for file, old, new in edits:
                text = text.replace(old, new) if file == name else text
            path.write_bytes(text.encode("latin-1" if name.endswith(".png") else "utf-8"))
        return "\n".join(check.check(Path(folder)))


def gif_offences(palette_of):
    """Offences found in four frames, the last one bright, with the palette of one of them."""
    with tempfile.TemporaryDirectory() as folder:
        gallery = Path(folder) / "docs" / "gallery"
        gallery.mkdir(parents=True)
        ramp = np.linspace(0, 1, 64)[None, :, None] * np.ones((48, 1, 3))
        frames = [Image.fromarray((255 * ramp * (i + 1) / 4).astype(np.uint8)) for i in range(4)]
        sheet = Image.new("RGB", (128, 96))
        for i, frame in enumerate(frames):
            sheet.paste(frame, (i % 2 * 64, i // 2 * 48))
        sheet.save(gallery / "film.png")
        palette = frames[palette_of].quantize(64)
        small = [f.quantize(palette=palette, dither=Image.Dither.NONE) for f in frames]
        small[0].save(gallery / "film.gif", save_all=True, append_images=small[1:])
        return "\n".join(check_gifs.check(Path(folder)))


def main():
    judged = [(f"{check.__name__}: a sound tree", found(check, []), "") for check in (check_figures, check_length, check_links, check_names, check_numbers, check_words)]
    judged += [(f"{check.__name__}: {new!r}", found(check, [(file, old, new)]), expected) for check, file, old, new, expected in CASES]
    judged.append(("a picture without labels", found(check_figures, [], [LAYOUT_FILE]), "drawn.png: no drawn.figure.json says what it shows"))
    dirty = ("docs/gallery/table.csv", "0123456789ab", "0123456789ab+")
    judged += [("a table with changes", found(check_numbers, [dirty, ("docs/page.md", "\n<!-- docs/gallery/table", LINKED + "\n<!-- docs/gallery/table")]),
                "has uncommitted changes, which the section does not say"),
               ("a bright palette", gif_offences(3), ""), ("a dark palette", gif_offences(0), "film.gif: frame 3 has a mean of")]
    failed = [f"{name}: expected '{expected}', found '{what}'" for name, what, expected in judged
              if ((expected not in what) if expected else what)]
    print("\n".join([*failed, f"{len(judged)} trees, {len(failed)} not judged as they should be"]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
