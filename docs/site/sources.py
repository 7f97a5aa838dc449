#!/usr/bin/env python3
"""Writes the pages as Sphinx reads them. Pages of docs/ stay plain Markdown; this adds what only the site has.

- Lists of links under the headings of docs/index.md become the tree of contents, and so do the links of a folder's index.md.
- Blocks of Python in docs/tutorials and docs/methods become cells that are run, in the folder of the project.
- Links to files outside of docs become copies of these files.
- The table of docs/gallery/index.md gets thumbnails; docs/references.bib becomes a page.

    sources.py OUT
"""
import os
import re
import shutil
import sys
from pathlib import Path

from PIL import Image

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
DOCS = ROOT / "docs"
RUN = ("tutorials", "methods")
PAGES = {ROOT / "README.md": "index.md", ROOT / "CHANGELOG.md": "changelog.md", ROOT / "scenes/README.md": "scenes.md",
         DOCS / "references.bib": "bibliography.md"}
LINK = re.compile(r"(?<=\]\()([^)\s#:]+)(#[\w-]*)?(?=\))")
FENCE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
FRONT = "---\nfile_format: mystnb\nkernelspec:\n  name: python3\n  language: python\n---\n"
SETUP = "```{code-cell}\n:tags: [remove-cell]\nimport os\nos.chdir(os.environ['MOTE_SITE_ROOT'])\n```\n\n"


def outside_fences(text, change):
    """`change` applied to all that is no block of code."""
    parts, end = [], 0
    for fence in FENCE.finditer(text):
        parts += [change(text[end:fence.start()]), fence.group(0)]
        end = fence.end()
    return "".join([*parts, change(text[end:])])


def relink(text, source, page, out):
    """Links of a page as they lead from its place in the site."""
    def target(match):
        path = (source.parent / match.group(1)).resolve()
        anchor = match.group(2) or ""
        if path.is_dir():
            path = path / "README.md" if (path / "README.md").is_file() else path
        if path in PAGES:
            name = out / PAGES[path]
        elif DOCS in path.parents and path.is_file():
            name = out / path.relative_to(DOCS)
        elif path.is_file():
            name = out / "files" / path.relative_to(ROOT)
            name.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, name)
        else:
            return match.group(0)
        return os.path.relpath(name, page.parent) + anchor
    text = re.sub(r"\[([^\]]+)\]\(([^)#:]+)\)", lambda m: m.group(1) if is_folder(source, m.group(2)) else m.group(0), text)
    return LINK.sub(target, text)


def is_folder(source, link):
    path = (source.parent / link).resolve()
    return path.is_dir() and not (path / "README.md").is_file()


def runnable(text):
    """The page with its blocks of Python as cells."""
    if "```python\n" not in text:
        return text
    title, rest = text.split("\n", 1)
    return f"{FRONT}\n{title}\n\n{SETUP}{rest}".replace("```python\n", "```{code-cell}\n")


def toctree(pages, caption=""):
    return "".join(["\n```{toctree}\n:hidden:\n", f":caption: {caption}\n" if caption else "", "\n", *(f"{p}\n" for p in pages), "```\n"])


def linked_pages(text):
    found = [link.removesuffix(".md") for link, _ in LINK.findall(text) if link.endswith(".md")]
    return list(dict.fromkeys(found))


def contents(text, nested):
    """Trees of the lists below each heading; `nested`: those of the folder's own pages alone, under no heading."""
    if nested:
        return text + toctree([p for p in linked_pages(text) if "/" not in p])
    return text + "".join(toctree(linked_pages("\n".join(re.findall(r"^- .*", part, flags=re.MULTILINE))), part.split("\n", 1)[0])
                          for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:] if re.search(r"^- \[", part, flags=re.MULTILINE))


def thumbnails(text, out):
    """Each run of rows `| [title](page.md), ... | verdict |` becomes a grid of small pictures."""
    def grid(rows):
        cells = []
        for title, name, verdict in re.findall(r"^\| \[([^\]]+)\]\((\w+)\.md\)[^|]*\|([^|]*)\|$", rows, flags=re.MULTILINE):
            picture = DOCS / "gallery" / f"{name}.png"
            small = out / "_static/thumbnails" / f"{name}.jpg"
            image = ""
            if picture.is_file():
                small.parent.mkdir(parents=True, exist_ok=True)
                with Image.open(picture) as full:
                    shown = full.convert("RGB")
                    shown.thumbnail((480, 480))
                    shown.save(small, quality=80)
                image = f'<img src="../_static/thumbnails/{name}.jpg" alt="{title}" loading="lazy">'
            cells.append(f'<a href="{name}.html">{image}{title}<span>{verdict.strip()}</span></a>')
        return '\n<div class="thumbnails">\n' + "\n".join(cells) + "\n</div>\n\n"
    return re.sub(r"^\| figure \|[^\n]*\n\|---\|---\|\n((?:\|.*\n)+)", lambda m: grid(m.group(1)), text, flags=re.MULTILINE)


def bibliography(text):
    entries = sorted((re.match(r"@\w+\{(\w+),", e).group(1), e.strip()) for e in re.split(r"\n(?=@)", text) if e.startswith("@"))
    return "# Bibliography\n\nKeys that pages, comments and errata cite.\n" + "".join(f"\n## {key}\n\n```bibtex\n{entry}\n```\n" for key, entry in entries)


def main(out):
    shutil.rmtree(out, ignore_errors=True)
    ignored = shutil.ignore_patterns("*.md", "site", "reference", "*.checks", "*.figure.json", "*.bib", "CMakeLists.txt")
    shutil.copytree(DOCS, out, ignore=ignored)
    (out / "_static").mkdir(exist_ok=True)
    shutil.copy(HERE / "mote.css", out / "_static")
    import importlib.util
    mathjax = Path(importlib.util.find_spec("sphinx-mathjax-offline").origin).parent / "static/mathjax/tex-svg.js"
    shutil.copy(mathjax, out / "_static/tex-svg.js")
    sources = {path: out / path.relative_to(DOCS) for path in DOCS.rglob("*.md") if path.relative_to(DOCS).parts[0] not in ("site", "reference")}
    sources |= {path: out / name for path, name in PAGES.items() if name in ("changelog.md", "scenes.md")}
    for source, page in sources.items():
        text = source.read_text(encoding="utf-8")
        text = outside_fences(text, lambda part: relink(part, source, page, out))
        text = outside_fences(text, lambda part: re.sub(r"(?<=\d) (?=%)", "\u00a0", part))  # in narrow cells
        if page.name == "index.md":
            text = contents(text, page.parent != out)
        if page == out / "gallery/index.md":
            text = thumbnails(text, out)
        if page.relative_to(out).parts[0] in RUN:
            text = runnable(text)
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text(text, encoding="utf-8")
    (out / "bibliography.md").write_text(bibliography((DOCS / "references.bib").read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
