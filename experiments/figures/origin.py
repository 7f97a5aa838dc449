"""Where a picture of the gallery and its table come from, written into both, so that no text has to be trusted.

A PNG holds it as text chunks, a CSV file as lines that begin with '# ': the script, whether the run was full, the commit of
the script and that of the program, what was rendered with which settings, and a digest of the table, which ties the two
together. tests/gallery compares them with each other and with docs/gallery/index.md.
"""
import csv
import hashlib
import json
import struct
import subprocess
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SIGNATURE = b"\x89PNG\r\n\x1a\n"


def commit():
    """Commit of the sources, with '+' if files were changed since, in the form of the program's own."""
    said = subprocess.run(["git", "describe", "--always", "--dirty=+", "--abbrev=12", "--exclude=*"], cwd=ROOT,
                          capture_output=True, text=True, check=False)
    return said.stdout.strip() or "unknown"


def word(value):
    """A setting, without the folders of this machine."""
    return Path(value).name if isinstance(value, Path) else str(value)


class Origin:
    """Facts about a run and its renders, which add() records."""

    def __init__(self, script, quick):
        self.facts = {"Script": str(Path(script).resolve().relative_to(ROOT)), "Run": "quick" if quick else "full",
                      "Commit": commit()}
        self.renders, self.programs = {}, set()

    def add(self, name, scene, settings, passes, seed, statistics):
        """One render; those that differ by their seeds alone make one line."""
        what = {"scene": Path(scene).stem, "passes": passes, **{k: word(v) for k, v in settings.items()}}
        self.renders.setdefault((name, json.dumps(what)), set()).add(seed)
        self.programs.add(statistics["git_hash"])

    def as_text(self):
        text = dict(self.facts)
        if self.programs:
            text["Program"] = " ".join(sorted(self.programs))
        for i, ((name, what), seeds) in enumerate(self.renders.items()):
            text[f"Render {i + 1}"] = f"{name}, seeds {' '.join(map(str, sorted(seeds)))}, {what}"
        return text

    def stamp(self, picture, table):
        """Writes itself into both files; a run that drew no picture has a table alone."""
        text = self.as_text()
        rows = table_of(table)
        text["Table"] = hashlib.sha256(rows.encode()).hexdigest()[:16]
        table.write_text("".join(f"# {k}: {v}\n" for k, v in text.items()) + rows, encoding="utf-8", newline="")
        if picture.is_file():
            write_png_text(picture, text)


def table_of(path):
    """The table of a CSV file without the lines that say where it comes from."""
    with open(path, newline="", encoding="utf-8") as file:
        return "".join(line for line in file if not line.startswith("# "))


def tables_of(path):
    """The tables above the claims, each a list of rows by column, with numbers as floats. A row without any number is a header."""
    tables = []
    for row in csv.reader(table_of(path).splitlines()):
        cells = [as_number(cell) for cell in row]
        if row[:2] == ["claim", "measured"]:
            break
        if not any(isinstance(cell, float) for cell in cells):
            header = row
            tables.append([])
        else:
            tables[-1].append(dict(zip(header, cells)))
    return tables


def as_number(cell):
    try:
        return float(cell)
    except ValueError:
        return cell


def csv_text(path):
    """Entries of the head of a CSV file, by name."""
    with open(path, newline="", encoding="utf-8") as file:
        lines = [line[2:].rstrip("\r\n") for line in file if line.startswith("# ")]
    return dict(line.split(": ", 1) for line in lines)


def chunks(data):
    """(type, data) of every chunk of a PNG file."""
    at = len(SIGNATURE)
    while at < len(data):
        size, = struct.unpack_from(">I", data, at)
        yield data[at + 4:at + 8], data[at + 8:at + 8 + size]
        at += 12 + size


def pixels(path):
    """A digest of what a PNG file shows, without its text."""
    return hashlib.sha256(b"".join(data for kind, data in chunks(Path(path).read_bytes()) if kind in (b"IHDR", b"IDAT"))).hexdigest()[:16]


def png_text(path):
    """Entries of the text chunks of a PNG file, by name."""
    text = {}
    for kind, data in chunks(Path(path).read_bytes()):
        if kind == b"tEXt":
            key, value = data.split(b"\0", 1)
            text[key.decode("latin-1")] = value.decode("latin-1")
        if kind == b"zTXt":
            key, value = data.split(b"\0", 1)
            text[key.decode("latin-1")] = zlib.decompress(value[1:]).decode("latin-1")
    return text


def write_png_text(path, text):
    """Replaces the text chunks of a PNG file; pixels stay as they are."""
    kept = [c for c in chunks(path.read_bytes()) if c[0] not in (b"tEXt", b"zTXt", b"iTXt")]
    new = [(b"zTXt", k.encode("latin-1") + b"\0\0" + zlib.compress(v.encode("latin-1", "replace"), 9)) if len(v) > 200 else
           (b"tEXt", k.encode("latin-1") + b"\0" + v.encode("latin-1", "replace")) for k, v in text.items()]
    data = SIGNATURE
    for kind, content in [kept[0], *new, *kept[1:]]:
        data += struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    path.write_bytes(data)
