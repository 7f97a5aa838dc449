#!/usr/bin/env python3
"""Finds links that lead nowhere, and pages that neither README.md nor an index of docs links to.

Files and folders of relative links exist, and so do the headings of their anchors. Links to other hosts are not followed. Sources
that name a page and a heading, as in docs/testing.md, "Error and noise", name one that is there.

    tests/pages/check_links.py ROOT
"""
import re
import sys

from pages import anchors, pages, read, run, tracked, without_code

LINK = re.compile(r"\]\(([^)\s]+)(?: \"[^\"]*\")?\)")
BEGINNINGS = ("README.md", "docs/guide.md", "docs/index.md", "docs/api/index.md", "docs/methods/index.md", "docs/gallery/index.md")  # where a reader comes from
APART = ("docs/reference/mainpage.md",)      # the first page of Doxygen's reference


def links(text):
    """(line, target) of every relative link."""
    for number, line in enumerate(without_code(text).split("\n"), 1):
        for target in LINK.findall(line):
            if not re.match(r"[a-z]+:", target):
                yield number, target


def leads_nowhere(root, page, target):
    path, _, anchor = target.partition("#")
    file = (root / page).parent / path if path else root / page
    if not file.exists():
        return f"there is no {path}"
    if anchor and file.suffix == ".md" and anchor not in anchors(file.read_text(encoding="utf-8")):
        return f"{file.name} has no heading '#{anchor}'"
    return None


QUOTED = re.compile(r'docs/([a-z_/-]+\.md), "([^"]{3,60})"')


def missing_headings(root):
    """Headings that comments of sources quote and no page has."""
    for name in tracked(root):
        path = root / name
        if name.endswith(".md") or name.startswith("tests/pages/") or not path.is_file():
            continue
        text = re.sub(r"\n\s*(?://+|#|\*)?\s*", " ", path.read_text(encoding="utf-8", errors="ignore"))
        for page, heading in QUOTED.findall(text):
            headings = re.findall(r"^#+ (.*)$", read(root, f"docs/{page}"), flags=re.MULTILINE) if (root / "docs" / page).is_file() else []
            if not any(h.startswith(heading) for h in headings):
                yield f"{name}: docs/{page} has no heading '{heading}'"


def check(root):
    offences, reached = list(missing_headings(root)), set()
    for page in pages(root):
        for line, target in links(read(root, page)):
            offence = leads_nowhere(root, page, target)
            offences += [f"{page}:{line}: {offence}"] if offence else []
            if page in BEGINNINGS and not offence:
                reached.add(((root / page).parent / target.partition("#")[0]).resolve())
    for page in pages(root):
        if page not in BEGINNINGS and page not in APART and (root / page).resolve() not in reached:
            offences.append(f"{page}: neither {' nor '.join(BEGINNINGS)} links to it")
    return offences


if __name__ == "__main__":
    sys.exit(run(check, sys.argv[1], "every link leads somewhere, and every page can be reached"))
