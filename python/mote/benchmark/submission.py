"""A submission: a folder of pictures at equal times, and its manifest submission.json."""
from __future__ import annotations

import datetime
import json
import math
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Tuple

import numpy as np

from .._errors import Error
from .._picture import Picture
from .problem import BenchmarkError, hint, key_problems, read_json
from .suite import FORMAT, Suite

MANIFEST = "submission.json"
KINDS = ("raw", "denoised")
NOISE = ("independent", "shared")
_NUMBER = (int, float)
_TOP = {"format": (int,), "suite": (str,), "method": (str,), "program": (str,), "version": (str,), "settings": (dict,), "kind": (str,),
        "noise": (str,), "unbiased": (bool,), "repeatable": (bool,), "machine": (dict,), "yardstick_s": (list,), "pictures": (list,)}
_TOP_OPTIONAL = {"left_out": (list,), "notes": (list,)}
_MACHINE = {"processor": (str,), "threads": (int,)}
_PICTURE = {"scene": (str,), "budget_s": _NUMBER, "seed": (int,), "file": (str,), "passes": (int,), "wall_s": _NUMBER,
            "cpu_s": _NUMBER, "load_s": _NUMBER, "started": (str,)}
_LEFT_OUT = {"scene": (str,), "reason": (str,)}
CLOCK = 0.05  # share by which processor time may exceed that of all threads, and seconds by which pictures may overlap


class Entry(NamedTuple):
    """A picture of the manifest. wall_s: seconds from the loaded scene to the finished picture. cpu_s: of all its
    processors, loading included. started: seconds since 1970."""
    scene: str
    budget_s: float
    seed: int
    file: str
    passes: int
    wall_s: float
    cpu_s: float
    load_s: float
    started: float


class Submission(NamedTuple):
    folder: Path
    method: str
    program: str
    version: str
    settings: Dict[str, Any]
    kind: str
    noise: str
    unbiased: bool
    repeatable: bool
    machine: Dict[str, Any]
    yardstick: Tuple[float, ...]
    entries: Tuple[Entry, ...]
    left_out: Tuple[Dict[str, Any], ...]
    notes: Tuple[str, ...]

    def at(self, scene: str, budget: float) -> List[Entry]:
        """Pictures of a scene and budget in order of their seeds; one that is late is there as well."""
        return sorted((e for e in self.entries if e.scene == scene and e.budget_s == budget), key=lambda e: e.seed)

    def picture(self, entry: Entry) -> np.ndarray:
        """Radiance (height, width, 3)."""
        return np.asarray(Picture.load(self.folder / entry.file)["beauty"])


def _started(text: str) -> float:
    return datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp()


def _entry_problems(where: str, given: Dict[str, Any], suite: Suite, folder: Path, threads: int) -> List[str]:
    lines = []
    scenes = {s.name: s for s in suite.scenes}
    scene = scenes.get(given["scene"])
    if scene is None:
        return [f"{where}: no scene '{given['scene']}'{hint(given['scene'], scenes)}"]
    if given["budget_s"] not in scene.budgets:
        lines.append(f"{where}: {given['budget_s']:g} s is no budget of {scene.name}{hint(given['budget_s'], scene.budgets)}")
    if given["seed"] not in suite.seeds_of(scene):
        lines.append(f"{where}: seed {given['seed']} is not prescribed for {scene.name}; they are {suite.seeds_of(scene)}")
    for key in ("wall_s", "cpu_s", "load_s"):
        if not (math.isfinite(given[key]) and given[key] >= 0):
            lines.append(f"{where}: {key} {given[key]} is no number of seconds")
    if given["passes"] < 1 or given["wall_s"] <= 0:
        lines.append(f"{where}: {given['passes']} passes in {given['wall_s']} s are none")
    longest = (threads * (given["wall_s"] + given["load_s"])) * (1 + CLOCK) + 0.2
    if given["cpu_s"] > longest:
        lines.append(f"{where}: {given['cpu_s']:.3g} s of processors do not fit into {given['wall_s']:.3g} s and {given['load_s']:.3g} s "
                     f"of loading with {threads} threads")
    try:
        _started(given["started"])
    except ValueError:
        lines.append(f"{where}: 'started' is no time such as 2026-01-31T12:00:00.0Z")
    file = Path(given["file"])
    if file.is_absolute() or ".." in file.parts:
        lines.append(f"{where}: '{file}' leads out of the submission")
    return lines or _picture_problems(folder / file, given, scene.width, scene.height)


def _picture_problems(path: Path, given: Dict[str, Any], width: int, height: int) -> List[str]:
    if not path.is_file():
        return [f"{path}: is not there{hint(path.name, sorted(p.name for p in path.parent.glob('*.exr'))) if path.parent.is_dir() else ''}"]
    try:
        picture = Picture.load(path)
        pixels = picture["beauty"]
    except (Error, KeyError) as problem:
        return [str(problem) if str(path) in str(problem) else f"{path}: {problem}"]
    if (picture.width, picture.height) != (width, height):
        return [f"{path}: {picture.width} x {picture.height} pixels, and the suite has {width} x {height}"]
    bad = int(np.count_nonzero(~np.isfinite(pixels).all(axis=2)))
    if bad:
        return [f"{path}: {bad} pixels are not finite; the rules leave no pixel out"]
    said = picture.metadata
    return [f"{path}: the file says {key} {said[key]}, the manifest {given[key]}" for key in ("seed", "passes")
            if key in said and said[key].isdigit() and int(said[key]) != given[key]]


def _missing(where: str, given: Dict[str, Any], suite: Suite) -> List[str]:
    """Scenes and budgets must be complete, or be left out with a reason."""
    lines = []
    left = [(o["scene"], o.get("budget_s")) for o in given.get("left_out", [])]
    for scene in suite.scenes:
        for budget in scene.budgets:
            if (scene.name, None) in left or (scene.name, budget) in left:
                continue
            seeds = [p["seed"] for p in given["pictures"] if p["scene"] == scene.name and p["budget_s"] == budget]
            absent = sorted(set(suite.seeds_of(scene)) - set(seeds))
            if absent:
                lines.append(f"{where}: {scene.name} at {budget:g} s has no picture of seed{'s' * (len(absent) > 1)} "
                             f"{', '.join(map(str, absent))}, and is not in left_out")
            if len(set(seeds)) < len(seeds):
                lines.append(f"{where}: {scene.name} at {budget:g} s has two pictures of one seed")
    return lines


def _overlaps(where: str, entries: List[Entry]) -> List[str]:
    """Pictures of one machine are rendered one after the other: stated times that overlap cannot be true."""
    ordered, lines = sorted(entries, key=lambda e: e.started), []
    for first, second in zip(ordered, ordered[1:]):
        over = first.started + first.wall_s - second.started
        if over > CLOCK:
            lines.append(f"{where}: {second.file} starts {over:.2f} s before {first.file} can have ended")
    return lines


def read_submission(folder: Path, suite: Suite) -> Submission:
    """Raises BenchmarkError with a line for everything that is wrong."""
    folder = Path(folder)
    path = folder / MANIFEST
    given = read_json(path)
    lines = key_problems(str(path), given, _TOP, _TOP_OPTIONAL)
    if lines:
        raise BenchmarkError(*lines)
    if given["format"] != FORMAT:
        lines.append(f"{path}: format {given['format']}, and this program reads {FORMAT}")
    if given["suite"] != suite.label():
        lines.append(f"{path}: of the suite '{given['suite']}', not of '{suite.label()}'")
    for key, words in (("kind", KINDS), ("noise", NOISE)):
        if given[key] not in words:
            lines.append(f"{path}: {key} '{given[key]}'{hint(given[key], words)}")
    lines += key_problems(f"{path}: machine", given["machine"], _MACHINE, {"memory_gb": _NUMBER, "system": (str,)})
    if not all(isinstance(s, _NUMBER) and s > 0 for s in given["yardstick_s"]):
        lines.append(f"{path}: yardstick_s holds the seconds of renders, above 0")
    for i, out in enumerate(given.get("left_out", [])):
        lines += key_problems(f"{path}: left_out {i + 1}", out, _LEFT_OUT, {"budget_s": _NUMBER})
    for i, picture in enumerate(given["pictures"]):
        lines += key_problems(f"{path}: picture {i + 1}", picture, _PICTURE, {})
    if lines:
        raise BenchmarkError(*lines)
    for i, picture in enumerate(given["pictures"]):
        lines += _entry_problems(f"{path}: picture {i + 1}", picture, suite, folder, given["machine"]["threads"])
    if lines:
        raise BenchmarkError(*lines)
    entries = [Entry(**{**p, "started": _started(p["started"])}) for p in given["pictures"]]
    lines = _missing(str(path), given, suite) + _overlaps(str(path), entries)
    if lines:
        raise BenchmarkError(*lines)
    return Submission(folder, given["method"], given["program"], given["version"], given["settings"], given["kind"], given["noise"],
                      given["unbiased"], given["repeatable"], given["machine"], tuple(given["yardstick_s"]), tuple(entries),
                      tuple(given.get("left_out", [])), tuple(given.get("notes", [])))


def time_text(seconds: float) -> str:
    """Seconds since 1970 as the manifest has them."""
    return datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).isoformat(timespec="milliseconds")


def write_manifest(folder: Path, content: Dict[str, Any]) -> None:
    (Path(folder) / MANIFEST).write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
