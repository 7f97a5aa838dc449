#!/usr/bin/env python3
"""Proves that the checks of this folder can fail: plants offences in an empty folder and expects each to be found."""
import sys
import tempfile
from pathlib import Path

import check_comments
import check_references
import count_loops
from check_floors import check

# (file, content, must be refused)
CASES = [
    ("core/a.cpp", '#include "media/medium.h"\n', True),
    ("core/a.cpp", '#  include <lights/area.h>\n', True),
    ("core/film/a.cpp", '#include "core/render/b.h"\n', True),
    ("core/scene/a.h", '#include "core/formats/xml/b.h"\n', True),
    ("core/render/a.h", '#include "core/cameras/b.h"\n', True),
    ("core/scene/a.h", '#include "core/geometry/b.h"\n#include "core/scene/c.h"\n', False),
    ("media/a.h", '#include "media/b.h"\n#include "core/c.h"\n#include <vector>\n', False),
    ("media/a.h", '#include "lights/b.h"\n', True),
    ("lights/a.cpp", '#include "integrators/path.h"\n', True),
    ("lights/a.cpp", '#include "media/b.h"\n', False),
    ("gathering/a.cpp", '#include "screenspace/b.h"\n', True),
    ("gathering/a.cpp", '#include "lights/b.h"\n', False),
    ("integrators/a.cpp", '#include "compensation/b.h"\n', False),
    ("integrators/a.cpp", '#include "apps/b.h"\n', True),
    ("apps/a.cpp", '#include "plugins/b.h"\n', True),
    ("apps/a.cpp", '#include "tests/support/catch.h"\n', True),
    ("core/a.cpp", '#include "../media/b.h"\n', True),
    ("experiments/a.cpp", '#include "apps/b.h"\n', False),
    ("tests/core/a.cpp", '#include "integrators/b.h"\n', False),
    ("tools/a.cpp", '#include "core/b.h"\n', False),
    ("core/a.cpp", '// next to #include "media/b.h"\n', False),
    ("docs/a.md", "see /work/shared\n", True),
    ("docs/a.md", 'path "/home/someone/scene.xml"\n', True),
    ("docs/a.md", "from `/root/x`\n", True),
    ("docs/a.md", "cd /usr/local/mote-1.2\n", True),
    ("docs/a.md", "/usr/share/glmark2/models/bunny.obj\n", False),
    ("docs/a.md", "a/work/b, ../home/c, https://example.org/home/d, lights/media/x\n", False),
]

# (comment, must be refused) where the references hold Veach1997, Raab2008 and Novak2014
CITATIONS = [
    ("// the balance heuristic (Veach 1997, Eq. 9.8)", False),
    ("// Raab et al. 2008, Sec. 3", False),
    ("// residual tracking (Nov\u00e1k et al. 2014)", False),
    ("// Raab, Seibert and Keller 2008", False),
    ("// as Raab et al.\n// 2008 have it", False),
    ("// Unheard 1999, Eq. 1", True),
    ("// Veach 1998", True),
    ("// Raab et al. 2009", True),
    ("// the standard observer of CIE 1931", False),
]

# (file, content, must be refused)
COMMENTS = [
    ("lights/a.h", "/// Of all lights [W].\nfloat power();\n", True),
    ("core/film/a.cpp", "int x;  // Whether it is there\n", True),
    ("apps/a.cpp", "    // The same again\n", True),
    ("lights/a.h", "/// Power of all lights [W]. What is infinite counts as well.\nfloat power();\n", False),
    ("lights/a.h", "/// Power\n/// Of all lights.\nfloat power();\n", False),
    ("lights/a.h", "// Offset; whatever it is\n", False),
    ("tests/lights/a.cpp", "// What is tested\n", True),
    ("lights/a.cpp", "const int most_lights = 3;\n", True),
    ("tests/a.py", "least_error = 1\n", True),
    ("lights/a.cpp", "solve_least_squares(a);\n", False),
    ("lights/a.cpp", "const auto drawn_light = choose();\n", True),
    ("lights/a.cpp", "// a term that is weighed\n", True),
    ("lights/a.cpp", "bool knows_media = false;\n", True),
    ("lights/a.cpp", 'plan("what was asked for");\n', True),
    ("lights/a.cpp", "// unknown weights; the walk continues, withdrawn by nothing\n", False),
    ("lights/a.cpp", "m = look_at(eye);\n", False),
]


def check_comment_openings():
    """How many of COMMENTS come out wrong."""
    failures = 0
    for name, content, refused in COMMENTS:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.parent.mkdir(parents=True)
            path.write_text(content)
            found, _ = check_comments.offences(Path(folder))
        if bool(found) != refused:
            failures += 1
            print(f"{name}: {content!r}: expected {'an offence' if refused else 'none'}, got {found}")
    return failures


def check_citations():
    """How many of CITATIONS come out wrong."""
    failures = 0
    for comment, refused in CITATIONS:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "docs").mkdir()
            (root / "docs/references.bib").write_text("@book{Veach1997,}\n@book{Raab2008,}\n@book{Novak2014,}\n")
            (root / "core").mkdir()
            (root / "core/a.h").write_text(comment + "\nint x;\n", encoding="utf-8")
            lines, _ = check_references.missing(root)
        if bool(lines) != refused:
            failures += 1
            print(f"{comment!r}: expected {'a missing entry' if refused else 'none'}, got {lines}")
    return failures


def check_loops():
    """1 where a second eye path, or a comment that only speaks of one, is taken for the other."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "integrators").mkdir()
        (root / "integrators/second.cpp").write_text("event = core::walk<Media>(scene, ray, state);\n")
        (root / "integrators/comment.cpp").write_text("// as walk<Media>(scene) does\n")
        lines = [line for line in count_loops.offences(root) if not line.endswith("are known") or ": 0 where" not in line]
    if len(lines) == 1 and lines[0].startswith("integrators/second.cpp: a walk"):
        return 0
    print(f"a second eye path: found {lines}")
    return 1


def check_circles():
    """How many of these come out wrong: subfolders that include each other, directly or by way of a third."""
    chains = [(["a", "b"], False), (["a", "b", "a"], True), (["a", "b", "c", "a"], True)]
    failures = 0
    for chain, refused in chains:
        with tempfile.TemporaryDirectory() as folder:
            for includer, included in zip(chain, chain[1:]):
                path = Path(folder) / f"lights/{includer}/to_{included}.h"
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(f'#include "lights/{included}/x.h"\n')
            offences, _ = check(Path(folder))
        if bool(offences) != refused:
            failures += 1
            print(f"{chain}: expected {'a circle' if refused else 'none'}, got {offences}")
    return failures


def main():
    failures = check_citations() + check_comment_openings() + check_loops() + check_circles()
    for name, content, refused in CASES:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.parent.mkdir(parents=True)
            path.write_text(content)
            offences, count = check(Path(folder))
        if count != 1 or bool(offences) != refused:
            failures += 1
            print(f"{name}: {content.strip()!r}: expected {'an offence' if refused else 'none'}, "
                  f"got {offences} in {count} files")
    print(f"{len(CASES) + len(CITATIONS) + len(COMMENTS) + 4} cases, {failures} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
