#!/usr/bin/env python3
"""Every paper that a comment cites has an entry in docs/references.bib.

Usage: check_references.py ROOT
A citation is names and a year: "Veach 1997", "Kollig & Keller 2006", "Raab et al. 2008". Its key is a name without
accents, hyphens and apostrophes, and the year: Veach1997. Any of the names will do, for a comment may begin a
list with a word that only looks like a name.
"""
import re
import sys
import unicodedata
from pathlib import Path

FOLDERS = ["core", "media", "lights", "compensation", "screenspace", "gathering", "integrators", "session",
           "trade", "viewer", "apps", "python", "plugins", "experiments", "benchmark", "tests", "tools", "scenes"]
NAME = r"(?:[a-z]')?[^\W\d_][\w'-]+"
CITATION = re.compile(rf"((?:{NAME}(?:, | & | and ))*{NAME})(?: et al\.)?,? \(?((?:18|19|20)\d\d)\b")
NOT_AUTHORS = {"CIE", "IEC", "ISO", "IEEE"}


def plain(text):
    """Letters alone: accents, umlauts' dots, hyphens and apostrophes taken off."""
    return "".join(c for c in unicodedata.normalize("NFKD", text) if c.isascii() and c.isalpha())


def comments(path):
    """The comment text of a C++ or Python file, joined over its lines."""
    marker = "//" if path.suffix in {".h", ".cpp"} else "#"
    parts = []
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if marker in line:
            parts.append(line.split(marker, 1)[1].lstrip("/ "))
        else:
            parts.append(";")  # two comments apart do not make one citation
    return " ".join(parts)


def citations(path):
    """(first and further names, year) of every citation in one file."""
    for names, year in CITATION.findall(comments(path)):
        authors = [n for n in re.split(r", | & | and ", names) if plain(n)[:1].isupper() or "'" in n]
        if authors and not NOT_AUTHORS & set(authors) and authors[-1][0] not in "abcdefghijklmnopqrstuvwxyz":
            yield authors, year


def missing(root):
    """One line for every citation without an entry, and the number of citations."""
    keys = set(re.findall(r"^@\w+\{(\w+),", (root / "docs/references.bib").read_text(encoding="utf-8"), re.M))
    lines, count = [], 0
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in {".h", ".cpp", ".py"} or "floors" in path.parts:
                continue
            for authors, year in citations(path):
                count += 1
                if not any(plain(name) + year in keys for name in authors):
                    lines.append(f"{path.relative_to(root)}: '{' & '.join(authors)} {year}' has no entry "
                                 f"{plain(authors[0])}{year} in docs/references.bib")
    return lines, count


def main():
    lines, count = missing(Path(sys.argv[1]).resolve())
    for line in lines:
        print(line)
    print(f"{count} citations, {len(lines)} without an entry")
    return 1 if lines or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
