"""house_style.py SOURCE OUT: the public headers, in the style of the house, written to OUT as Doxygen wants them.

- The comment at the top of a file is the documentation of the file.
- A comment before or behind a declaration of several names ("float x, y;  ///< place") is that of each of them.
- A plain comment right above a declaration documents it, and the declarations that follow it without a gap.
- <tags> in comments are text, not HTML.
"""
import re
import sys
from pathlib import Path

# One line that declares data: type, names with their dimensions and initial values.
declaration = re.compile(r"^(\s*)((?:(?:static|constexpr|const|mutable|inline)\s+)*[\w:]+(?:<[^;=]*>)?[\s*&]+)"
                         r"(\w+[^;()]*(?:\([^;()]*\)[^;()]*)*);\s*(///<.*)?$")


def split_names(names):
    """At commas outside of brackets."""
    parts, depth, start = [], 0, 0
    for i, c in enumerate(names):
        depth += (c in "([{<") - (c in ")]}>")
        if c == "," and depth == 0:
            parts.append(names[start:i].strip())
            start = i + 1
    return parts + [names[start:].strip()]


def escaped(comment):
    return re.sub(r"<(?=[A-Za-z/])([^<>\s]*[^<>]*)>", r"\\<\1\\>", comment)


def top_comment(lines):
    """The file's first comment as documentation of the file, and of the first type in it if that has none: one idea a
    file, and the file says what it is. Lines keep their numbers, but after a comment of one line."""
    end = next((i for i, line in enumerate(lines) if not line.startswith("//")), len(lines))
    if end == 0:
        return lines
    text = [escaped(line[2:].strip()) for line in lines[:end]]
    first_line = text[0]
    rest = lines[end:]
    first = next((i for i, line in enumerate(rest) if re.match(r"(struct|class) [^;]*{", line)), 0)
    while first > 0 and rest[first - 1].startswith("template"):
        first -= 1
    if first > 0 and not rest[first - 1].startswith("//"):
        rest[first] = f"/** {' '.join(text[:text.index('')] if '' in text else text)} */ {rest[first]}"
    text[0] = "/** \\file"
    text[1:] = [" ".join([first_line] + text[1:2])] + text[2:]
    text[-1] += " */"
    return text + rest


def documented(lines):
    out, above, inside_block = [], [], False
    for line in lines:
        stripped = line.strip()
        if stripped.startswith("/**") and "*/" not in stripped:
            inside_block = True
        if inside_block:
            inside_block = "*/" not in stripped
            out.append(line)
            continue
        if stripped.startswith("//"):
            if not (out and out[-1].strip().startswith("//")):
                above = []
            text = stripped.lstrip("/").strip() if not stripped.startswith("///<") else ""
            above.append(escaped(text))
            out.append(re.sub(r"//+(?!<)", "///", escaped(line), count=1) if not stripped.startswith("///<")
                       else escaped(line))
            continue
        match = declaration.match(line)
        names = split_names(match[3]) if match and match[2].split()[0] not in (
            "return", "using", "friend", "template", "namespace", "class", "struct", "enum", "typedef") else []
        if len(names) > 1 or (names and above and not match[4]):
            behind = escaped(match[4] or "")
            for k, name in enumerate(names):
                comment = behind or ("///< " + " ".join(above) if above and (k > 0 or not out[-1].strip()
                                                                              .startswith("///")) else "")
                out.append(f"{match[1]}{match[2]}{name};  {comment}" if comment else f"{match[1]}{match[2]}{name};")
        else:
            before, arrow, comment = line.partition("///<")
            out.append(before + arrow + escaped(comment) if arrow else line)
            if not names:
                above = []
        if not stripped:
            above = []
    return out


source, out = Path(sys.argv[1]), Path(sys.argv[2])
listed = (source / "cmake/public_headers.txt").read_text().splitlines()
for header in [line for line in listed if line and not line.startswith("#")]:
    target = out / header
    target.parent.mkdir(parents=True, exist_ok=True)
    text = "\n".join(documented(top_comment((source / header).read_text().split("\n"))))
    # Doxygen takes a comment on the next line for the rest of one that is behind a name, unless that has an end.
    target.write_text(re.sub(r"///<(.*)$", r"/**<\1 */", text, flags=re.MULTILINE))
