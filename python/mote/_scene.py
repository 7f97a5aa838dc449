"""Scenes: from a file, from text, from a dictionary."""
from __future__ import annotations

import html
import os
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Union

from . import _errors, _mote  # noqa: F401  (errors are registered first)
from ._paths import path_text
from ._scene_dict import texts_of, tree_of
from ._scene_object import Element, SceneObject, objects_of

Path_ = Union[str, Path]


class Plan(dict):
    """What an integrator will run on a scene, and why: {"integrator", "runs", "left_out", "missing"}, lists of
    {"topic", "choice", "reason", "cure"}, and "costly", sentences on what takes very long. str(plan) is the table that `mote plan` prints."""

    def __init__(self, entries: Mapping[str, Any], text: str) -> None:
        super().__init__(entries)
        self._text = text

    def __str__(self) -> str:
        return self._text

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._text)}</pre>"


class Scene:
    """A scene that is ready to be rendered.

    Scene({"type": "scene", "floor": {"type": "rectangle", "bsdf": {...}}, ...}) builds one of a dictionary in the
    manner of Mitsuba's: nested objects with a "type", transforms as mote.Transform or 4 x 4 matrices, colours as three
    numbers or {"type": "rgb", "value": [...]}, {"type": "ref", "id": ...} for an object that stands directly in the
    scene. Besides Mitsuba's types: {"type": "arraymesh", "positions": (n, 3), "triangles": (m, 3), "normals": (n, 3),
    "uvs": (n, 2)} and {"type": "arraygrid", "data": (depth, height, width) or (depth, height, width, 3),
    "bounds": (lower, upper)}, a density grid in the unit cube of its `to_world` (or, with use_grid_bbox, in `bounds`).

    integrator: this type instead of the scene's. define: what -D sets of a scene, {"film.width": 640}.
    lenient: leave out or approximate what is wrong, and say so in `warnings`. folder: where relative file names are
    looked up. plugins: shared libraries to load types from, as `--plugin`. Raises mote.Error.

    scene["lamp"]["position"] = (0, 2, 0), or scene["lamp"].position, changes a parameter: objects go by id, else by name,
    else by category ("integrator"), and "shape:2" is the second of several. Meshes and grids that stay are not read again.
    list(scene) are the names.
    """

    def __init__(self, scene: Mapping[str, Any], *, integrator: str = "", define: Optional[Mapping[str, Any]] = None,
                 lenient: bool = False, folder: Path_ = "", plugins: Sequence[Path_] = ()) -> None:
        self._folder = path_text(folder) or os.getcwd()
        tree = tree_of(scene, self._folder)
        self._scene = _mote.LoadedScene.from_tree(tree, integrator, texts_of(define or {}), lenient, _texts(plugins))
        self.path = ""

    @classmethod
    def _of(cls, inner: _mote.LoadedScene, path: str, folder: str = "") -> Scene:
        scene = cls.__new__(cls)
        scene._scene, scene.path, scene._folder = inner, path, folder
        return scene

    # Objects and parameters, to be read and changed.
    def _elements(self) -> Element:
        return self._scene.elements()

    def _change(self, values: Mapping[str, Any]) -> None:
        self._scene = self._scene.changed(texts_of(values))

    def __getitem__(self, name: str) -> SceneObject:
        return SceneObject(self, "")[name]

    def __setitem__(self, name: str, value: Any) -> None:
        SceneObject(self, "")[name] = value

    def __iter__(self) -> Iterator[str]:
        return iter(SceneObject(self, "").keys())

    def __contains__(self, name: object) -> bool:
        return name in SceneObject(self, "").keys()

    def _ipython_key_completions_(self) -> List[str]:
        return SceneObject(self, "").keys()

    def xml(self) -> str:
        """The scene as a scene file says it, with all changes; files that it names are looked up where they were."""
        return self._scene.xml()

    def plan(self) -> Plan:
        """What will run, with the reason for every choice."""
        return Plan(self._scene.plan(), self._scene.plan_text())

    @property
    def width(self) -> int:
        """Of the film [pixels]."""
        return self._scene.width

    @property
    def height(self) -> int:
        return self._scene.height

    @property
    def sample_count(self) -> int:
        """Passes of a render without an end of its own."""
        return self._scene.sample_count

    @property
    def integrator(self) -> str:
        return self._scene.integrator

    @property
    def files(self) -> List[str]:
        """All that were read."""
        return self._scene.files

    @property
    def warnings(self) -> List[str]:
        return self._scene.warnings

    @property
    def hash(self) -> str:
        """Of all that determines a picture besides seed and passes: the `sceneHash` of its metadata."""
        return self._scene.hash

    def _repr_html_(self) -> str:
        """What it is and holds, and what will run."""
        rows = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(tag + ' ' + attributes.get('type', ''))}</td></tr>"
                       for name, (tag, attributes, _) in objects_of(self._elements()).items())
        return f"<b>{html.escape(repr(self))}</b><table>{rows}</table>{self.plan()._repr_html_()}"

    def __repr__(self) -> str:
        return f"<mote.Scene {self.path or 'of a dictionary'}: {self.width} x {self.height}, {self.integrator}>"


def _texts(paths: Sequence[Path_]) -> List[str]:
    return [path_text(path) for path in paths]


def load(path: Union[str, Path], *, integrator: str = "", define: Optional[Mapping[str, Any]] = None,
         lenient: bool = False, plugins: Sequence[Path_] = (), **parameters: Any) -> Scene:
    """A scene file (docs/scene-format.md), glTF, GLB or pbrt.

    parameters: as -D NAME=VALUE, load("scene.xml", paths=256); `define` holds those whose names are paths, such as
    {"integrator.paths": 256} (film__width=64 is the same as {"film.width": 64}). integrator: this type instead of the
    scene's. lenient: leave out or approximate what is wrong. plugins: shared libraries to load types from. Raises mote.Error with .file and .line.
    """
    defines: Dict[str, Any] = {**parameters, **(define or {})}
    return Scene._of(_mote.LoadedScene.from_file(path_text(path), integrator, texts_of(defines), lenient,
                                                   _texts(plugins)), str(path))


def load_string(xml: str, *, folder: Union[str, Path] = "", name: str = "<string>", integrator: str = "",
                define: Optional[Mapping[str, Any]] = None, lenient: bool = False, plugins: Sequence[Path_] = (),
                **parameters: Any) -> Scene:
    """The same of a scene file's text; relative file names are looked up in `folder`."""
    defines: Dict[str, Any] = {**parameters, **(define or {})}
    where = path_text(folder) or os.getcwd()
    inner = _mote.LoadedScene.from_text(xml, where, name, integrator, texts_of(defines), lenient, _texts(plugins))
    return Scene._of(inner, name, where)
