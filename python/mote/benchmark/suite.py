"""The suite: scenes with sizes, budgets and seeds that are the same for everybody."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

from .problem import BenchmarkError, hint, key_problems, read_json

FORMAT = 1
_NUMBER = (int, float)
_SUITE = {"format": (int,), "name": (str,), "version": (int,), "seeds": (int,), "targets": (list,), "scenes": (list,), "quick": (dict,)}
_SCENE = {"name": (str,), "title": (str,), "tests": (str,), "licence": (str,), "file": (str,), "width": (int,), "height": (int,),
          "budgets": (list,), "reference": (dict,)}
_SCENE_OPTIONAL = {"defines": (dict,), "origin": (str,), "made_by": (str,), "lenient": (bool,)}
_REFERENCE = {"integrator": (str,), "passes": (int,)}


class Scene(NamedTuple):
    """One scene. budgets: seconds. settings: those of the references' integrator. number: from 0, for the seeds."""
    name: str
    title: str
    tests: str
    licence: str
    origin: str
    file: Path
    width: int
    height: int
    budgets: Tuple[float, ...]
    integrator: str
    settings: Dict[str, Any]
    passes: int
    defines: Dict[str, str]
    made_by: str
    lenient: bool
    number: int

    def words(self) -> List[str]:
        """Values of -D: size, a box filter of one pixel, which leaves the noise of pixels independent, and the scene's own."""
        size = [f"film.width={self.width}", f"film.height={self.height}", "film.rfilter=box"]
        return size + [f"{name}={value}" for name, value in self.defines.items()]

    def missing(self) -> str:
        """Why the scene cannot be rendered here; "" where it can."""
        if self.file.is_file():
            return ""
        return f"{self.file} is not there" + (f": {self.made_by}" if self.made_by else "")


class Suite(NamedTuple):
    file: Path
    name: str
    version: int
    seeds: int
    targets: Tuple[float, ...]
    scenes: Tuple[Scene, ...]
    quick: bool

    def label(self) -> str:
        return f"{self.name} {self.version}" + (" quick" if self.quick else "")

    def scene(self, name: str) -> Scene:
        """Raises BenchmarkError with the nearest name."""
        for scene in self.scenes:
            if scene.name == name:
                return scene
        raise BenchmarkError(f"{self.file}: no scene '{name}'{hint(name, [s.name for s in self.scenes])}")

    def seeds_of(self, scene: Scene) -> List[int]:
        """Seeds are prescribed, so that none is chosen by its picture. Small and consecutive: some programs count up from one."""
        first = 1000 * (scene.number + 1)
        return list(range(first, first + self.seeds))

    def chosen(self, names: Sequence[str]) -> List[Scene]:
        return [self.scene(name) for name in names] if names else list(self.scenes)


def _scene(where: str, given: Any, number: int, folder: Path, quick: Optional[Dict[str, Any]]) -> Scene:
    lines = key_problems(where, given, _SCENE, _SCENE_OPTIONAL)
    if not lines:
        lines = key_problems(f"{where}: reference", given["reference"], _REFERENCE, {"settings": (dict,)})
    if not lines and not all(isinstance(b, _NUMBER) and b > 0 for b in given["budgets"]):
        lines = [f"{where}: budgets are seconds above 0"]
    if lines:
        raise BenchmarkError(*lines)
    reference, shrink = given["reference"], quick["shrink"] if quick else 1
    generated = str(folder.resolve() / "generated")
    data = os.environ.get("MOTE_TEST_DATA", str(folder.parent.parent / "shared" / "data"))
    return Scene(name=given["name"], title=given["title"], tests=given["tests"], licence=given["licence"],
                 origin=given.get("origin", ""), file=(folder / given["file"].replace("$DATA", data)).resolve(),
                 width=max(16, given["width"] // shrink), height=max(16, given["height"] // shrink),
                 budgets=tuple(float(b) for b in (quick["budgets"] if quick else given["budgets"])),
                 integrator=reference["integrator"], settings=reference.get("settings", {}),
                 passes=max(8, reference["passes"] // (quick["fewer_passes"] if quick else 1)),
                 defines={k: str(v).replace("$GENERATED", generated) for k, v in given.get("defines", {}).items()},
                 made_by=given.get("made_by", ""),
                 lenient=given.get("lenient", False), number=number)


def load_suite(path: Path, quick: bool = False) -> Suite:
    """Raises BenchmarkError. quick: small pictures and budgets, to prove that everything runs."""
    path = Path(path) / "suite.json" if Path(path).is_dir() else Path(path)
    given = read_json(path)
    lines = key_problems(str(path), given, _SUITE, {})
    if not lines and given["format"] != FORMAT:
        lines = [f"{path}: format {given['format']}, and this program reads {FORMAT}"]
    if not lines:
        numbers = {"shrink": (int,), "fewer_passes": (int,), "seeds": (int,), "budgets": (list,)}
        lines = key_problems(f"{path}: quick", given["quick"], numbers, {})
    if lines:
        raise BenchmarkError(*lines)
    chosen = given["quick"] if quick else None
    scenes = tuple(_scene(f"{path}: scene {i + 1}", s, i, path.parent, chosen) for i, s in enumerate(given["scenes"]))
    names = [s.name for s in scenes]
    for name in names:
        if names.count(name) > 1:
            raise BenchmarkError(f"{path}: two scenes are called '{name}'")
    return Suite(path, given["name"], given["version"], chosen["seeds"] if chosen else given["seeds"],
                 tuple(given["targets"]), scenes, quick)
