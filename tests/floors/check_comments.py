#!/usr/bin/env python3
"""Checks that no comment in C++ begins with "Of", "Whether", "The same", "What" or "Who", and that code speaks the field's words.

Usage: check_comments.py ROOT
A comment begins with a noun phrase or a verb that stands alone. Names, comments and messages of C++ and Python hold none of the
words of tests/pages/check_words.py. tools/count_house.py holds the openings and the folders.
Prints every offence as file:line: comment, and ends with 1 if there is one.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import count_house  # noqa: E402


def offences(root):
    """All offences below root, as lines of text; and the number of files of the product's C++."""
    house = count_house.House(root)
    house.openings(True), house.openings(False), house.words()
    return house.places["comments"] + house.places["comments elsewhere"] + house.places["words"], len(house.cpp(count_house.PRODUCT))


def main():
    found, files = offences(Path(sys.argv[1]).resolve())
    for line in found:
        print(line)
    print(f"{files} files, {len(found)} offences")
    if files < 10:
        print("too few files to be the project")
        return 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
