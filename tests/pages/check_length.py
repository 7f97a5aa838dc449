#!/usr/bin/env python3
"""Counts the words of the pages: what has a letter or a digit, outside of blocks of code and comments.

At most MAX_WORDS words in all but the reference of scenes (docs/scene-format.md) and of the API (docs/api), and at most MAX_INSIDE on the
page of how mote is built. What is longer hides what matters.

    tests/pages/check_length.py ROOT
"""
import re
import sys

from pages import GENERATED, pages, prose, read, run

MAX_WORDS, MAX_INSIDE, INSIDE = 45000, 5000, "docs/design.md"


def words(text):
    return len(re.findall(r"\S*[A-Za-z0-9]\S*", prose(text)))


def check(root):
    counts = {page: words(read(root, page)) for page in pages(root) if page not in GENERATED and not page.startswith("docs/api/")}
    total = sum(counts.values())
    if total > MAX_WORDS:
        yield f"the pages have {total} words, more than {MAX_WORDS}"
    if counts.get(INSIDE, 0) > MAX_INSIDE:
        yield f"{INSIDE}: {counts[INSIDE]} words, more than {MAX_INSIDE}"


if __name__ == "__main__":
    sys.exit(run(lambda root: list(check(root)), sys.argv[1], "the pages are as short as they are to be"))
