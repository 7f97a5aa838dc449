#!/usr/bin/env python3
"""Checks the house (docs/design.md): includes go down the floors only and in no circle, and no path of one machine is committed.

Usage: check_floors.py ROOT
A file includes from its own folder or from floors below. Folders on the same floor do not include each other, and
subfolders of one folder form no circle.
tests/ and tools/ may include from anywhere. Reads the committed files where ROOT is a git checkout, else at
all files. Prints every offence as file:line and ends with 1 if there is one.
"""
import re
import subprocess
import sys
from pathlib import Path

FLOORS = [
    ["core"],
    ["media"],
    ["lights"],
    ["compensation", "screenspace", "gathering"],
    ["integrators"],
    ["session"],
    ["trade", "viewer"],
    ["apps", "python", "plugins"],
    ["experiments"],
]
FLOOR_OF = {folder: level for level, floor in enumerate(FLOORS) for folder in floor}
# core has floors of its own.
CORE_FLOORS = [["math"], ["objects"], ["parameters", "files", "metrics"], ["film"], ["materials"], ["geometry"], ["scene"],
               ["cameras", "render"], ["formats"]]
CORE_FLOOR_OF = {folder: level for level, floor in enumerate(CORE_FLOORS) for folder in floor}
EXEMPT = {"tests", "tools"}
SOURCES = {".h", ".hpp", ".cpp", ".c", ".cc", ".inl"}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
# Folders of people and machines. A path starts where no letter, digit, dot, slash or the like goes before it.
MACHINE_PATH = re.compile(r"(?<![\w./~$})-])/(?:work|root|home|Users|mnt|scratch)/[\w.]")
# System paths; those that every Debian system has are no property of one machine.
SYSTEM_PATH = re.compile(r"(?<![\w./~$})-])/usr/(?:local|share)/[\w.-]+")
ALLOWED_SYSTEM = {"/usr/share/glmark2", "/usr/share/common-licenses", "/usr/local/lib"}


def committed_files(root):
    """Tracked and new files that git does not ignore; every file where root is no checkout."""
    command = ["git", "-c", "safe.directory=*", "-C", str(root), "ls-files", "-z", "--cached", "--others",
               "--exclude-standard"]
    if (root / ".git").exists():
        try:
            names = subprocess.run(command, check=True, capture_output=True).stdout.decode().split("\0")
            return sorted({root / name for name in names if name and (root / name).is_file()})
        except (OSError, subprocess.CalledProcessError):
            pass  # no git program: read everything but the folders that .gitignore names
    left_out = {"build", "out", ".git", "__pycache__", "generated"}
    return sorted(p for p in root.rglob("*")
                  if p.is_file() and not left_out & set(p.relative_to(root).parts))


def include_offence(folder, included, room=None):
    """Why a file in `folder` (in its folder `room`, where it has one) may not include `included`, or None."""
    target = included.split("/")[0]
    if ".." in included.split("/"):
        return f"'{included}' climbs out of its folder; includes are written from the root"
    if target in EXEMPT:
        return f"'{included}' belongs to {target}/, which nothing else may include"
    if target == folder == "core":
        return floor_offence(CORE_FLOOR_OF, room, included.split("/")[1], included)
    return floor_offence(FLOOR_OF, folder, target, included)


def floor_offence(floor_of, folder, target, included):
    """Why a file of `folder` may not include `included`, which lies in `target`, by one table of floors."""
    if target == folder or folder not in floor_of or target not in floor_of:
        return None
    if floor_of[target] < floor_of[folder]:
        return None
    relation = "a floor above" if floor_of[target] > floor_of[folder] else "the same floor as"
    return f"'{included}' lies on {relation} {folder}/"


def offences_of_file(root, path):
    """(line, reason) of every offence in one file."""
    relative = path.relative_to(root)
    folder = relative.parts[0]
    data = path.read_bytes()
    if b"\0" in data[:4096]:
        return  # a picture or a volume
    checks_includes = path.suffix in SOURCES and folder in FLOOR_OF
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), 1):
        found = INCLUDE.match(line)
        if found and checks_includes:
            reason = include_offence(folder, found.group(1), relative.parts[1])
            if reason:
                yield number, reason
        if MACHINE_PATH.search(line) and not is_exempt_from_paths(relative):
            yield number, f"a path of one machine: {MACHINE_PATH.search(line).group(0)}..."
        for place in SYSTEM_PATH.findall(line):
            if place not in ALLOWED_SYSTEM and not is_exempt_from_paths(relative):
                yield number, f"a system path that the project does not rely on: {place}"


def room_includes(root, files):
    """Between the subfolders of one folder: {(folder, subfolder): {subfolder it includes: "file:line"}}.

    Subfolders of subfolders (core/formats/xml) are rooms of their parent in the same way.
    """
    graph = {}
    for path in files:
        relative = path.relative_to(root)
        if path.suffix not in SOURCES or relative.parts[0] not in FLOOR_OF:
            continue
        for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
            found = INCLUDE.match(line)
            if not found:
                continue
            here, there = relative.parts[:-1], tuple(found.group(1).split("/")[:-1])
            shared = 0
            while shared < min(len(here), len(there)) and here[shared] == there[shared]:
                shared += 1
            if shared and shared < min(len(here), len(there)):
                room = graph.setdefault(here[:shared], {}).setdefault(here[shared], {})
                room.setdefault(there[shared], f"{relative}:{number}")
    return graph


def circles(root, files):
    """An offence for each pair of subfolders of one folder that include each other, directly or by way of others."""
    for folder, graph in sorted(room_includes(root, files).items()):
        reached = {room: reachable(graph, room) for room in graph}
        for first, includes in sorted(graph.items()):
            for second, where in sorted(includes.items()):
                if first < second and first in reached.get(second, ()):
                    yield (f"{where}: {'/'.join(folder)}/{first} and {'/'.join(folder)}/{second} include each other "
                           f"({graph[second].get(first, 'by way of others')})")


def reachable(graph, start):
    """All rooms that `start` includes, directly or by way of others."""
    seen, open_rooms = set(), list(graph.get(start, ()))
    while open_rooms:
        room = open_rooms.pop()
        if room not in seen:
            seen.add(room)
            open_rooms += graph.get(room, ())
    return seen


def is_exempt_from_paths(relative):
    """These files hold the patterns themselves."""
    return relative.parts[:2] == ("tests", "floors")


def check(root):
    """All offences below root, as lines of text; and how many files were read."""
    files = committed_files(root)
    lines = [f"{path.relative_to(root)}:{number}: {reason}"
             for path in files for number, reason in offences_of_file(root, path)]
    return lines + list(circles(root, files)), len(files)


def main():
    root = Path(sys.argv[1]).resolve()
    offences, count = check(root)
    for offence in offences:
        print(offence)
    print(f"{count} files, {len(offences)} offences")
    if count < 10:
        print("too few files to be the project")
        return 1
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
