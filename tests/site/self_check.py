#!/usr/bin/env python3
"""Proves that the checks of the site can fail: plants one fault at a time in a small page and expects it to be found."""
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "docs/site"), str(Path(__file__).resolve().parent)]
import check_html  # noqa: E402
import run_commands  # noqa: E402

PAGE = '<html><body><h1 id="top">a</h1><a href="b.html#end">b</a><a href="https://x.org/">x</a><img src="p.png" alt="a room"></body></html>'
CASES = [  # what is replaced by what in the page, what is found ('' for nothing)
    ("", "", ""),
    ("b.html#end", "c.html", "there is no c.html"),
    ("#end", "#begin", "b.html#begin has no such place"),
    ('alt="a room"', 'alt=""', "the picture p.png has no text"),
    ("p.png", "https://x.org/p.png", "is loaded from elsewhere"),
]
BLOCKS = [  # a block, its commands
    ("mote info out/a.exr      channels\nmote plan SCENE\n", ["mote info out/a.exr"]),
    ("mote render scenes/x.xml -o out/x.exr --passes 4   # small\n", ["mote render scenes/x.xml -o out/x.exr --passes 4"]),
    ("mote trade scenes/x.xml \\\n    -o out/x\n", ["mote trade scenes/x.xml -o out/x"]),
    ("cmake --preset release\n", []),
]


def found(old, new):
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "a.html").write_text(PAGE.replace(old, new) if old else PAGE, encoding="utf-8")
        (root / "b.html").write_text('<p id="end">b</p>', encoding="utf-8")
        (root / "p.png").write_bytes(b"")
        return "\n".join(check_html.check(root.resolve()))


def main():
    failed = [f"{new!r}: expected '{expected}', found '{what}'" for old, new, expected in CASES
              for what in [found(old, new)] if ((expected not in what) if expected else what)]
    failed += [f"{block!r}: commands {list(run_commands.commands(f'```{chr(10)}{block}```{chr(10)}'))}" for block, expected in BLOCKS
               if list(run_commands.commands(f"```\n{block}```\n")) != expected]
    print("\n".join([*failed, f"{len(CASES) + len(BLOCKS)} cases, {len(failed)} not judged as they should be"]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
