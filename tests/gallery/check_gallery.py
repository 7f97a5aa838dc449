#!/usr/bin/env python3
"""Is every picture of the gallery the full run of the script beside it, and does the text say what its table says?

For each picture of docs/gallery in a page of docs (with the file PAGE.checks beside it): it names its script, which the section names too; its run was full; its commit is one
of this repository, without changes; its table lies beside it, with the same origin, and is the one that it was plotted from
(experiments/figures/origin.py), and it is wide enough. Each section ends with a comment, or has one in PAGE.checks, of lines such as

    1.58 ± 0.02 % = bunny; taken_by_the_bound; standard_error
    22.2 ± 0.3 % = claim: clamping darkens
    8.9 ± 0.3 % = method: mote layers, passes: 8; error; error_se

The words before '=' stand in the section or in its row of the index. Behind it: the first cells of a row of the CSV
file, or cells by the names of their columns, and the columns with the numbers, which must be those of the text as it rounds them; or the
beginning of a claim, whose measured value holds these numbers in this order. Each row of a table that is measured has such a line. Cells of the text are parted by '|', and each is per
cent or not. A picture that was not made anew since pictures carry their origin says
'Recorded: afterwards', and its section says so in the words NOT_ANEW, and may be as narrow as it was.

    tests/gallery/check_gallery.py ROOT
"""
import csv
import hashlib
import re
import struct
import subprocess
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent.parent.parent / "experiments" / "figures"), str(Path(__file__).resolve().parent.parent / "pages")]
import pages
from origin import csv_text, png_text, table_of

NOT_ANEW = "not made anew since pictures say where they come from"
WIDTH = 960  # pixels, at the least: a figure is to be read on a wall
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def sections(text):
    """By picture: the text of its section, and where it begins."""
    found = {}
    for part in re.split(r"^#{1,3} ", text, flags=re.MULTILINE)[1:]:
        picture = re.search(r"!\[[^\]]*\]\((?:[./]*gallery/)?(\w+)\.png\)", part)
        if picture:
            found[picture.group(1)] = part
    return found


def rows_of_index(text, name):
    """The rows of the table of figures that link to the page."""
    return "\n".join(line for line in text.split("\n") if re.match(rf"\| \[[^\]]*\]\({name}\.md\)", line))


def shown(number, value, percent):
    """Is `value` what the text shows as `number`, with so many digits?"""
    digits = len(number.partition(".")[2])
    value = 100 * value if percent else value
    return abs(value - float(number)) <= 0.5 * 10 ** -digits * (1 + 1e-6)


class Table:
    """Rows of a CSV file below their headers, and its claims."""

    def __init__(self, path):
        self.rows, self.claims, header = [], [], None
        for row in csv.reader(table_of(path).splitlines()):
            if row[:2] == ["claim", "measured"]:
                header = None
            elif header is None and not self.rows:
                header = row
            elif header is None:
                self.claims.append(row)
            elif not any(is_number(cell) for cell in row[1:]) and is_header(row):
                header = row  # a second table
            else:
                self.rows.append((header, row))

    def values(self, key, columns):
        for header, row in self.rows:
            if all(c in header for c in columns) and is_row(key, header, row):
                return [float(row[header.index(c)]) for c in columns]
        raise KeyError(f"no row {key} with {', '.join(columns)}")

    def measured(self, beginning):
        for row in self.claims:
            if row[0].startswith(beginning):
                return row[1]
        raise KeyError(f"no claim '{beginning}'")


def is_row(key, header, row):
    """Does the key, 'first / second' or 'column: cell, column: cell', mean this row?"""
    if key.split(": ")[0] in header:
        named = (part.split(": ", 1) for part in key.split(", "))
        return all(column in header and row[header.index(column)] == cell for column, cell in named)
    cells = [k.strip() for k in key.split("/")]
    return row[:len(cells)] == cells


def is_number(cell):
    try:
        float(cell)
        return True
    except ValueError:
        return False


def is_header(row):
    return all(re.fullmatch(r"\w+", cell) for cell in row)


def numbers_of(said):
    """(number, is it per cent) of each number in the words."""
    return [(number, "%" in cell) for cell in said.replace("−", "-").split("|") for number in NUMBER.findall(cell)]


def in_order(said, measured):
    """Does the text `measured` hold the numbers of `said`, in their order and as they are rounded?"""
    there, at = [float(n) for n in NUMBER.findall(measured)], 0
    for number, _ in numbers_of(said):
        while at < len(there) and not shown(number, there[at], False):
            at += 1
        if at == len(there):
            return False
        at += 1
    return True


def check_number(line, visible, table):
    said, _, source = (part.strip() for part in line.partition(" = "))
    if said not in visible:
        return f"'{said}' is not in the text"
    try:
        if source.startswith("claim: "):
            measured = table.measured(source[len("claim: "):])
            return None if in_order(said, measured) else f"'{said}': the claim measured {measured}"
        key, *columns = (part.strip() for part in source.split(";"))
        values = table.values(key, columns)
    except KeyError as error:
        return f"'{said}': {error.args[0]}"
    numbers = numbers_of(said)
    if len(values) != len(numbers):
        return f"'{said}': {len(numbers)} numbers, {len(values)} columns"
    for (number, percent), value in zip(numbers, values):
        if not shown(number, value, percent):
            return f"'{said}': the table has {value:.6g}"
    return None


def visible_text(text):
    return " ".join(re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL).replace("**", "").split())


def lines_of(comments):
    return [line.strip() for comment in comments for line in comment.split("\n") if " = " in line]


def rows_without_check(section, lines):
    """Rows of tables, headers apart, that hold measured numbers and no words of a comment's line."""
    said = [line.partition(" = ")[0].strip() for line in lines]
    text = re.sub(r"<!--.*?-->", "", section, flags=re.DOTALL).replace("**", "").split("\n")
    for line, below in zip(text, [*text[1:], ""]):
        row = " ".join(line.split())
        cells = row.split("|")[2:]
        measured = any(re.search(r"\d\.\d|\d [%s]", cell) for cell in cells)
        if row.startswith("|") and measured and not below.startswith("|--") and not any(words in row for words in said):
            yield row[:80]


def is_commit(root, commit):
    """True if the commit is one of this repository, or if the history is missing or shallow."""
    git = lambda *words: subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=False)
    if git("rev-parse", "--is-shallow-repository").stdout.strip() != "false":
        return True
    return git("cat-file", "-e", f"{commit}^{{commit}}").returncode == 0


def width(picture):
    """Width of a PNG file [pixels]: the first number of its first chunk, which is IHDR."""
    return struct.unpack(">I", picture.read_bytes()[16:20])[0]


def check_picture(root, name, section, first_rows):
    picture, table = (root / "docs" / "gallery" / f"{name}{suffix}" for suffix in (".png", ".csv"))
    if not picture.is_file():
        return ["there is no such picture"]
    text = png_text(picture)
    missing = [key for key in ("Script", "Run", "Commit") if key not in text]
    if missing:
        return [f"the picture does not say: {', '.join(missing)}"]
    offences = []
    if not (root / text["Script"]).is_file() or text["Script"] not in section:
        offences.append(f"made by {text['Script']}, which the section does not name")
    if text["Run"] != "full":
        offences.append(f"the run was {text['Run']}")
    for commit in [text["Commit"], *text.get("Program", "").split()]:
        if commit.endswith("+") or not is_commit(root, commit):
            offences.append(f"commit {commit} is none of this repository")
    if text.get("Recorded") == "afterwards":
        return offences + ([] if NOT_ANEW in " ".join(section.split()) else [f"the section does not say: {NOT_ANEW}"])
    if width(picture) < WIDTH:
        offences.append(f"only {width(picture)} pixels wide, not {WIDTH}")
    if not table.is_file():
        return offences + ["no table lies beside it"]
    if csv_text(table) != text:
        offences.append("picture and table do not come from one run")
    if hashlib.sha256(table_of(table).encode()).hexdigest()[:16] != text.get("Table"):
        offences.append("the table is not the one that was written with the picture")
    lines = lines_of(c for c in re.findall(r"<!--(.*?)-->", section, flags=re.DOTALL) if not c.startswith(" docs/"))
    if not lines:
        offences.append("no number of the text is compared with the table")
    visible = visible_text(section + first_rows)
    numbers = Table(table)
    offences += [f"no number of this row is compared with the table: {row}" for row in rows_without_check(section, lines)]
    return offences + [o for o in (check_number(line, visible, numbers) for line in lines) if o]


def check(root):
    offences, seen = [], set()
    index = (root / "docs/gallery/index.md").read_text(encoding="utf-8")
    for page in sorted((root / "docs").rglob("*.md")):
        text = pages.read(root, str(page.relative_to(root)))
        for name, section in sections(text).items():
            seen.add(name)
            offences += [f"{name}: {o}" for o in check_picture(root, name, section, rows_of_index(index, name))]
    for path in sorted((root / "docs" / "gallery").glob("*.png")):
        if path.stem not in seen:
            offences.append(f"{path.stem}: no page shows it")
    return offences


if __name__ == "__main__":
    found = check(Path(sys.argv[1]))
    print("\n".join(found) if found else "every picture is a full run, and the text says what its table says")
    sys.exit(1 if found else 0)
