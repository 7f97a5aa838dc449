#!/usr/bin/env python3
"""Packs the Blender add-on into one .zip that Blender installs.

Usage: make_zip.py OUTPUT.zip [FORMATS.md]
FORMATS.md is what `mote formats` prints (default: docs/scene-format.md); the integrators and their parameters in
Blender's panel are those of that page.
"""
import json
import re
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PACKAGE = HERE / "mote_render"
ROW = re.compile(r"^\| `(\w+)` \| (\w+) \| (.*?) \| (.*) \|$")
OBJECTS = {"Compensation of the bound": "compensation", "Visibility": "visibility",
           "Selection of virtual point lights": "selection"}


def sections(text):
    """(part, type, lines below its heading) of each registered type on the page."""
    part, kind, lines = "", None, []
    for line in [*text.splitlines(), "## end"]:
        if line.startswith("##"):
            if kind:
                yield part, kind, lines
            kind, lines = None, []
            if line.startswith("## "):
                part = line[3:]
            elif line.startswith("### `"):
                kind = line[5:-1]
        else:
            lines.append(line)


def integrators(text):
    """{"integrators": {type: {"text", "parameters": [...]}}, "objects": {category: [types]}}."""
    found, objects = {}, {category: [] for category in OBJECTS.values()}
    for part, kind, lines in sections(text):
        if part in OBJECTS:
            objects[OBJECTS[part]].append(kind)
        if part == "Integrators":
            rows = [match.groups() for match in map(ROW.match, lines) if match]
            found[kind] = {"text": next(line for line in lines if line), "parameters": [
                dict(zip(("name", "type", "default", "meaning"), row)) for row in rows]}
    if not found or not all(objects.values()):
        sys.exit("make_zip.py: this is not what `mote formats` prints: no integrators on it")
    return {"integrators": found, "objects": objects}


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    page = Path(sys.argv[2]) if len(sys.argv) == 3 else HERE.parents[1] / "docs" / "scene-format.md"
    table = integrators(page.read_text())
    with zipfile.ZipFile(sys.argv[1], "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(PACKAGE.glob("*.py")):
            archive.write(path, f"mote_render/{path.name}")
        archive.writestr("mote_render/integrators.json", json.dumps(table, indent=1))
    print(f"{sys.argv[1]}: {len(table['integrators'])} integrators")


main()
