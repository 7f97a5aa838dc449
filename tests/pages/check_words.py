#!/usr/bin/env python3
"""Finds words in pages that the field has better ones for, or that give a mind to code.

Each pattern is followed by the word to write. Code, links' targets, comments, and the tables of docs/testing.md, which quote names of
tests, are not read.

    tests/pages/check_words.py ROOT
"""
import re
import sys

from pages import GENERATED, pages, read, run, without_code

WORDS = [
    (r"weighed|weighs?|weighing", "weighted, MIS weights"),
    (r"whoever|nobody|somebody else", "the one that it is"),
    (r"stands? for|stood for", "represents, replaces"),
    (r"looks? at|looked at|looking at", "evaluates, gathers, reads"),
    (r"goes on|go on|going on", "continues"),
    (r"asks?|asked|hears?|believes?|believed|knows?", "queries, receives, stores"),
    (r"is told|are told|tells whether", "is reported"),
    (r"thrown away", "discarded"),
    (r"what (?:it|they) knows?", "what is stored"),
    (r"(?:lights?|VPLs|distances?|samples?|directions?|candidates?) (?:that )?(?:is|are|were) drawn", "sampled"),
    (r"drawn (?:lights?|distances?|directions?|samples?)", "sampled"),
    (r"shares? of (?:the )?(?:draws|samples)", "probability"),
    (r"part(?:s)? of (?:the |a )?nodes?", "child"),
    (r"(?:most|least)_(?!squares\b|common\b)[a-z]\w*", "max_, min_"),
]

# In names, comments and messages of code as well (tools/count_house.py), where nothing is drawn but pictures.
CODE_WORDS = [*WORDS, (r"drawn", "sampled"), (r"tells?|told", "shows, reports, distinguishes"), (r"offers?|offered", "submits, has")]

QUOTES_TESTS = "docs/testing.md"


def first_word(line, words):
    """The first match of a list of words in a line, with the better word; or None. Names count by their parts as well."""
    for pattern, better in words:
        for text in (line, re.sub("look_at", "", line).replace("_", " ")):  # look_at is a matrix
            match = re.search(rf"\b(?:{pattern})\b", text, flags=re.IGNORECASE)
            if match:
                return match.group(0), better
    return None


def check(root):
    offences = []
    for page in pages(root):
        if page in GENERATED or page == "CHANGELOG.md":
            continue
        text = read(root, page)
        for number, line in enumerate(without_code(text).split("\n"), 1):
            if page == QUOTES_TESTS and line.startswith("|"):
                continue
            line = re.sub(r"\]\([^)]*\)|\"[^\"]*\"", "]", line)
            for pattern, better in WORDS:
                for match in re.finditer(rf"\b(?:{pattern})\b", line, flags=re.IGNORECASE):
                    offences.append(f"{page}:{number}: '{match.group(0)}': {better}")
    return offences


if __name__ == "__main__":
    sys.exit(run(check, sys.argv[1], "pages speak the words of the field"))
