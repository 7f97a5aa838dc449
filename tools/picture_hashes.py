#!/usr/bin/env python3
"""Hashes of small pictures of all scenes by all integrators: shows which pictures a change of the code changes.

  tools/picture_hashes.py MOTE -o HASHES                  hash what the program MOTE renders
  tools/picture_hashes.py MOTE --against HASHES           compare with an earlier file; ends with 1 on a difference

A line of the file is "scene integrator hash"; where the program refuses the scene, the hash is "refused". The hash
covers the pixels of every channel (pixel_hash.py). The city is left out: it takes half a minute to load.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from pixel_hash import pixel_hash

ROOT = Path(__file__).resolve().parent.parent
LEFT_OUT = {"city"}
SIZE = ["-D", "film.width=40", "-D", "film.height=25", "--passes", "2", "--seed", "7"]


def integrators(mote):
    """All types of integrators, from the program's own page of its scene language."""
    page = subprocess.run([mote, "formats"], check=True, capture_output=True, text=True).stdout
    section = re.split(r"^## ", page.split("\n## Integrators\n")[1], flags=re.MULTILINE)[0]
    return re.findall(r"^### `(\w+)`", section, re.MULTILINE)


def picture_hash(mote, scene, integrator, threads):
    """The hash of a render; "refused" for exit code 1; anything else is an error."""
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.exr"
        command = [mote, "render", str(scene), "--integrator", integrator, "-t", str(threads), "-o", str(picture), "--quiet"]
        run = subprocess.run(command + SIZE, capture_output=True, text=True)
        if run.returncode == 1:
            return "refused"
        if run.returncode != 0:
            return f"exit_{run.returncode}"
        return pixel_hash(picture)[:16]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mote", help="the program")
    parser.add_argument("-o", "--output", help="file of hashes to write")
    parser.add_argument("--against", help="file of hashes to compare with")
    parser.add_argument("--scenes", help="only scenes whose name matches this regular expression", default="")
    parser.add_argument("--integrators", help="only types that match this regular expression", default="")
    parser.add_argument("--jobs", type=int, default=2, help="renders at a time")
    options = parser.parse_args()
    scenes = [s for s in sorted((ROOT / "scenes").glob("*.xml"))
              if s.stem not in LEFT_OUT and re.search(options.scenes, s.stem)]
    types = [t for t in integrators(options.mote) if re.search(options.integrators, t)]
    pairs = [(s, t) for s in scenes for t in types]
    lines = []
    with ThreadPoolExecutor(options.jobs) as pool, open(options.output or os.devnull, "w", encoding="utf-8") as output:
        for (scene, kind), value in zip(pairs, pool.map(lambda pair: picture_hash(options.mote, *pair, 1), pairs)):
            lines.append(f"{scene.stem} {kind} {value}")
            print(lines[-1], file=output, flush=True)
    failed = [line for line in lines if line.split()[2].startswith("exit_")]
    changed = []
    if options.against:
        before = dict(line.rsplit(" ", 1) for line in Path(options.against).read_text().splitlines())
        changed = [f"{line} (was {before[line.rsplit(' ', 1)[0]]})" for line in lines
                   if before.get(line.rsplit(" ", 1)[0], "new") not in ("new", line.rsplit(" ", 1)[1])]
    for line in failed + changed:
        print(line)
    print(f"{len(lines)} pictures, {len(failed)} failed" +
          (f", {len(changed)} changed" if options.against else ""))
    return 1 if failed or changed else 0


if __name__ == "__main__":
    sys.exit(main())
