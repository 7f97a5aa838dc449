#!/usr/bin/env python3
"""Compares numbers in pages with the files of docs/gallery that they come from.

A comment in any page, or in the file PAGE.checks beside it below the section's heading, that begins with the name of a CSV file, or of a page of a trade, lists numbers of that section:

    <!-- docs/gallery/trade/peers/smoke_room.csv
    8.9 ± 0.3 % = method: mote layers, passes: 8; error; error_se
    -->
    <!-- docs/gallery/trade/peers.html
    ≈ 33 = smoke room / mote layers; s to 5 %
    -->

Rows of CSV files as in tests/gallery/check_gallery.py; of HTML tables by the heading above and the first cell. Every CSV file of
docs/gallery is compared somewhere (check_gallery.py: those beside a picture), and a section that shows what was measured with changes that no commit holds says so.

    tests/pages/check_numbers.py ROOT
"""
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

from pages import pages, read, run, sections

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "gallery"))
from check_gallery import Table, check_number, in_order, lines_of, visible_text

SOURCE = re.compile(r"<!-- (docs/gallery/\S+\.(?:csv|html))\n(.*?)-->", re.DOTALL)
UNCOMMITTED = "uncommitted changes"
DIRTY = re.compile(r"\b[0-9a-f]{7,40}\+")  # a commit, with changes


class HtmlTables(HTMLParser):
    """Rows of all tables as dictionaries, by (heading, first cell)."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.heading, self.header, self.row, self.inside = {}, "", [], [], None
        self.feed(text)
        self.end_row()

    def end_row(self):
        cells = [" ".join(c.split()) for c in self.row]
        if self.inside_header:
            self.header = cells
        elif cells:
            self.rows.setdefault((self.heading.strip(), cells[0]), dict(zip(self.header, cells)))
        self.row = []

    inside_header = False

    def handle_starttag(self, tag, attrs):
        if tag in ("tr", "table"):
            self.end_row()
            self.inside_header = False
        if tag in ("td", "th"):
            self.row.append("")
            self.inside_header = tag == "th"
        if tag in ("h1", "h2", "h3"):
            self.heading = ""
        if tag in ("td", "th", "h1", "h2", "h3"):
            self.inside = tag

    def handle_endtag(self, tag):
        if tag == self.inside:
            self.inside = None
        if tag == "table":
            self.end_row()
            self.inside_header = False

    def handle_data(self, data):
        if self.inside in ("td", "th"):
            self.row[-1] += " " + data
        elif self.inside:
            self.heading += data


def check_in_html(line, visible, tables):
    said, _, source = (part.strip() for part in line.partition(" = "))
    if said not in visible:
        return f"'{said}' is not in the text"
    key, *columns = (part.strip() for part in source.split(";"))
    row = tables.rows.get(tuple(part.strip() for part in key.split(" / ", 1)), {})
    if any(c not in row for c in columns):
        return f"'{said}': no row {key} with {', '.join(columns)}"
    measured = " ".join(row[c] for c in columns)
    return None if in_order(said, measured) else f"'{said}': the table has {measured}"


def check_section(root, text, files):
    visible = visible_text(text)
    for name, lines in SOURCE.findall(text):
        if not (root / name).is_file():
            yield f"there is no {name}"
            continue
        if name not in files:
            files[name] = HtmlTables((root / name).read_text(encoding="utf-8")) if name.endswith(".html") else Table(root / name)
        check = check_in_html if name.endswith(".html") else check_number
        yield from (o for o in (check(line, visible, files[name]) for line in lines_of([lines])) if o)


def dirty(root):
    """The pictures, tables and pages of docs/gallery that come from a tree with changes, without their suffixes."""
    files = [p for p in (root / "docs" / "gallery").rglob("*") if p.suffix in (".csv", ".html")]
    return sorted({str(p.relative_to(root / "docs").with_suffix("")) for p in files if DIRTY.search(p.read_text(encoding="utf-8"))})


def check(root):
    offences, files, compared = [], {}, set()
    changed = dirty(root)
    for page in pages(root):
        text = read(root, page)
        compared |= {name for name, _ in SOURCE.findall(text)} | ({f"gallery/{n}" for n in re.findall(r"!\[[^\]]*\]\((?:[./]*gallery/)?(\w+)\.png\)", text)})
        for line, section in sections(text):
            offences += [f"{page}:{line}: {o}" for o in check_section(root, section, files)]
            said = UNCOMMITTED in " ".join(section.split())
            offences += [f"{page}:{line}: {name} has {UNCOMMITTED}, which the section does not say" for name in changed
                         if re.search(rf"\]\([./]*(?:docs/)?{name}\.", section) and not said]
    for table in sorted((root / "docs" / "gallery").rglob("*.csv")):
        # Points that were read from a plot: pages compare their numbers with the table behind it.
        read_from_plot = table.read_text(encoding="utf-8").startswith("# Points: read from the plot")
        if not read_from_plot and not compared & {str(table.relative_to(root)), f"gallery/{table.stem}"}:
            offences.append(f"{table.relative_to(root)}: no page compares its numbers with it")
    return offences


if __name__ == "__main__":
    sys.exit(run(check, sys.argv[1], "numbers of pages are those of their tables"))
