#!/usr/bin/env python3
"""Proves that check_floors.py can fail: plants offences in an empty folder and expects each to be found."""
import sys
import tempfile
from pathlib import Path

from check_floors import check

# (file, content, must be refused)
CASES = [
    ("core/a.cpp", '#include "media/medium.h"\n', True),
    ("core/a.cpp", '#  include <lights/area.h>\n', True),
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


def main():
    failures = 0
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
    print(f"{len(CASES)} cases, {failures} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
