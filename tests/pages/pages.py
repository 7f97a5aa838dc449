"""Markdown pages as their checks read them: sections, headings, inline code, text that is shown."""
import re
import subprocess
from pathlib import Path

FENCE = re.compile(r"^( *)(```|~~~).*?^\1\2[ \t]*$", re.DOTALL | re.MULTILINE)
COMMENT = re.compile(r"<!--(.*?)-->", re.DOTALL)
GENERATED = {"docs/scene-format.md"}


def pages(root):
    """Paths of all pages, relative to the root: those under version control, else those in the usual places."""
    listed = subprocess.run(["git", "ls-files", "*.md"], cwd=root, capture_output=True, text=True, check=False)
    names = listed.stdout.split("\n") if listed.returncode == 0 else []
    names = names or [str(p.relative_to(root)) for p in [*root.glob("*.md"), *root.glob("docs/**/*.md")]]
    return sorted(name for name in names if name and (root / name).is_file())


def tracked(root):
    """Names of all files under version control, else of all files."""
    listed = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True, check=False)
    names = listed.stdout.split("\n") if listed.returncode == 0 else []
    names = names or [str(p.relative_to(root)) for p in root.rglob("*") if p.is_file()]
    return [n for n in names if n and n.split("/")[0] not in ("build", "out")]


def read(root, name):
    """The text of a page; what NAME.checks beside it holds stands at the end of the section whose heading it begins with, or of the page."""
    path = root / name
    text = path.read_text(encoding="utf-8")
    checks = path.with_suffix(".checks")
    if path.suffix == ".md" and checks.is_file():
        for heading, comments in re.findall(r"^(#+ [^\n]*\n)?((?:<!--.*?-->\n)+)", checks.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL):
            text = with_comments(text, heading.strip(), comments)
    return text


def with_comments(text, heading, comments):
    if not heading:
        return text + comments
    for line, section in sections(text):
        if section.startswith(heading + "\n"):
            return text.replace(section, section.rstrip("\n") + "\n\n" + comments + "\n", 1)
    raise ValueError(f"numbers are listed for '{heading}', and the page has no such heading")


def blank(match):
    """As many lines as the match has, and nothing in them: line numbers stay."""
    return "\n" * match.group(0).count("\n")


def shown(text):
    """The text without comments, which no reader sees."""
    return COMMENT.sub(blank, text)


def prose(text):
    """Shown text without blocks of code."""
    return FENCE.sub(blank, shown(text))


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", prose(text))


def slug(heading):
    """The anchor that GitHub gives a heading."""
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(text):
    found, count = set(), {}
    for heading in re.findall(r"^#{1,6} (.*?)#*$", prose(text), flags=re.MULTILINE):
        name = slug(heading)
        found.add(f"{name}-{count[name]}" if name in count else name)
        count[name] = count.get(name, 0) + 1
    return found


def sections(text):
    """(line, text) of each section below a heading of any depth."""
    starts = [m.start() for m in re.finditer(r"^#{1,6} ", FENCE.sub(lambda m: re.sub(r"[^\n]", " ", m.group(0)), text), flags=re.MULTILINE)]
    for begin, end in zip([0, *starts], [*starts, len(text)]):
        yield text.count("\n", 0, begin) + 1, text[begin:end]


def inline_code(text):
    """(line, words) of every piece of inline code outside of blocks."""
    for number, line in enumerate(prose(text).split("\n"), 1):
        for code in re.findall(r"`([^`]+)`", line):
            yield number, code


def run(check, root, well):
    """Prints what `check` finds. Returns the exit code."""
    found = check(Path(root))
    print("\n".join(found) if found else well)
    return 1 if found else 0
