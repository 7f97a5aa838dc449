#!/usr/bin/env python3
"""Finds names in pages that the tree no longer has, and what pages say twice.

- Paths in inline code, such as `core/math/ray.h`, are files or folders (with * also several; a suffix may be left out).
- Names in inline code, such as `LightTree`, `make_vertex()` or `max_depth`, occur in the sources.
- Options such as --passes occur in the sources.
- Tags and cases of `mote_tests_PART "..."` occur in tests/PART.
- README.md names every integrator of docs/scene-format.md and every command that the sources add.
- Tables of floors in docs/design.md name every folder of core, lights, gathering and screenspace.
- No page holds the same sixteen words twice in its prose, and no entry of references.bib comes twice.

    tests/pages/check_names.py ROOT
"""
import re
import sys
from fnmatch import fnmatch

from pages import GENERATED, inline_code, pages, prose, read, run, shown, tracked

FOLDERS = ("apps cmake compensation core docs examples experiments gathering integrators lights media plugins python scenes "
           "screenspace session tests tools trade").split()
SOURCES = (".h", ".cpp", ".py", ".cmake", ".txt", ".xml", ".json", ".toml", ".c", ".sh")
NAME = re.compile(r"(?:\w+::)*([A-Za-z]\w*)(\(\))?$")
REPEATED = 16  # words
README, DESIGN, FORMATS = "README.md", "docs/design.md", "docs/scene-format.md"
# Names of other programs and of papers, and of files that a reader is to write.
FOREIGN_OPTIONS = set("--nworkers --nthreads --array --cpus-per-task --parsable --dependency --wrap --map-by".split())
FOREIGN = {"PMI_RANK", "PMI_SIZE", "DRJIT_LIBLLVM_PATH", "read_native_scanline", "next_p"}
OWN = "my_"


OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]+")


def words_of_sources(root, files):
    """Every identifier and option of the tree's sources, pages apart, and the names of its files."""
    words = {name.rsplit("/", 1)[-1].split(".")[0] for name in files}
    for name in files:
        path = root / name
        if (path.suffix in SOURCES or path.suffix == "") and not name.startswith("docs/") and path.is_file():
            source = path.read_text(encoding="utf-8", errors="ignore")
            words.update(re.findall(r"\w+", source), OPTION.findall(source))
    return words


def is_path(word):
    return "/" in word and word.split("/", 1)[0] in FOLDERS and "generated" not in word and not re.search(r"[<>$:#]", word)


def there(path, files, folders):
    path = path.rstrip("/")
    return path in folders or any(f == path or f.rsplit(".", 1)[0] == path or fnmatch(f, path) for f in files)


def is_name(word):
    """Identifiers of code: with an underscore, a capital inside, or brackets."""
    match = NAME.fullmatch(word)
    return match and (match.group(2) or "_" in word.strip("_") or re.search(r"[a-z][A-Z]", word))


def missing_names(root, page, text, files, folders, words):
    for line, code in inline_code(text):
        first = code.split()[0] if code.split() else ""
        if is_path(first):
            if OWN not in first and not there(first, files, folders):
                yield f"{page}:{line}: there is no {first}"
        elif is_name(code):
            name = NAME.fullmatch(code).group(1)
            if name not in words and name not in FOREIGN and OWN not in name:
                yield f"{page}:{line}: no source has the name {code}"


def missing_rooms(text, folders):
    """A folder of these rooms that the page on the house does not name."""
    named = {code for _, code in inline_code(text)}
    for folder in sorted(folders):
        if folder.count("/") == 1 and folder.startswith(("core/", "lights/", "gathering/", "screenspace/")) and folder.split("/")[1] not in named:
            yield f"{DESIGN}: no table of floors names {folder}"


def missing_options(page, text, words):
    for number, line in enumerate(shown(text).split("\n"), 1):
        for option in OPTION.findall(line):
            if option not in words and option not in FOREIGN_OPTIONS:
                yield f"{page}:{number}: no source has the option {option}"


def missing_features(root, files):
    """Integrators and commands that README.md does not name."""
    readme, formats = (read(root, name) if (root / name).is_file() else "" for name in (README, FORMATS))
    part = re.search(r"^## Integrators\n(.*?)(?=^## |\Z)", formats, flags=re.MULTILINE | re.DOTALL)
    for name in re.findall(r"^### `(\w+)`", part.group(1) if part else "", flags=re.MULTILINE):
        if f"`{name}`" not in readme:
            yield f"{README}: does not name the integrator {name}"
    for name in (n for n in files if n.startswith("apps/") and n.endswith(".cpp")):
        for command in re.findall(r'add_subcommand\(\s*"(\w+)"', (root / name).read_text(encoding="utf-8")):
            if not re.search(rf"\bmote {command}\b", readme):
                yield f"{README}: does not name the command mote {command}"


def missing_tests(root, page, text, tests):
    for folder, wanted in re.findall(r'mote_tests_(\w+) "([^"]+)"', text.replace("\n", " ")):
        cases = tests.get(folder, "")
        tags = re.findall(r"\[[^\]]+\]", wanted)
        for tag in tags:
            if tag not in cases:
                yield f"{page}: no test of tests/{folder} has the tag {tag}"
        if not tags and not any(fnmatch(name, wanted) for name in re.findall(r'TEST_CASE(?:_METHOD)?\((?:\w+, *)?"([^"]+)"', cases)):
            yield f"{page}: tests/{folder} has no case '{wanted}'"


def repeats(page, text):
    """Prose alone: tables may say alike things of unlike rows."""
    lines = [line for line in prose(text).split("\n") if not line.startswith("|")]
    words = re.findall(r"[^\s|]+", " ".join(lines))
    seen, last = {}, -REPEATED
    for i in range(len(words) - REPEATED + 1):
        piece = tuple(words[i:i + REPEATED])
        if piece in seen and i >= last + REPEATED:
            last = i
            yield f"{page}: says twice: {' '.join(piece)}"
        seen.setdefault(piece, i)


def repeated_rows(page, text):
    rows = [re.split(r"\s*\|\s*", line)[1:3] for line in prose(text).split("\n") if line.startswith("| ") and len(line) > 120]
    for row in {tuple(r) for r in rows if rows.count(r) > 1 and len(r[0]) > 12 and r[1]}:
        yield f"{page}: two rows of a table begin with '{row[0]} | {row[1]}'"


def check(root):
    files = tracked(root)
    folders = {"/".join(f.split("/")[:i]) for f in files for i in range(1, f.count("/") + 1)}
    words = words_of_sources(root, files)
    tests = {}
    for name in files:
        if name.startswith("tests/") and name.endswith((".cpp", ".h")):
            tests[name.split("/")[1]] = tests.get(name.split("/")[1], "") + (root / name).read_text(encoding="utf-8")
    offences = [*missing_features(root, files)]
    for page in pages(root):
        if page in GENERATED:
            continue
        text = read(root, page)
        offences += [*missing_names(root, page, text, files, folders, words), *missing_tests(root, page, text, tests), *missing_options(page, text, words),
                     *repeats(page, text), *repeated_rows(page, text), *(missing_rooms(text, folders) if page == DESIGN else [])]
    bibliography = root / "docs" / "references.bib"
    keys = re.findall(r"^@\w+\{(\w+),", bibliography.read_text(encoding="utf-8"), flags=re.MULTILINE) if bibliography.is_file() else []
    return offences + [f"docs/references.bib: {key} comes twice" for key in sorted({k for k in keys if keys.count(k) > 1})]


if __name__ == "__main__":
    sys.exit(run(check, sys.argv[1], "pages name what is there, and nothing twice"))
