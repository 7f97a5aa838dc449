"""From a dictionary in the manner of Mitsuba's to the elements of a scene file.

An object is {"type": ..., name: value or object, ...}. Directly in the scene the key of an object is its id, which
{"type": "ref", "id": ...} names; deeper it is the name of a parameter. What kind of object a type is, and of what kind
its values are, the manual pages say.
"""
from __future__ import annotations

from functools import lru_cache
from typing import Any, Dict, List, Mapping, Tuple

import numpy as np

from . import _mote
from ._errors import Error
from ._manual import manuals

_PREFERRED = ["shape", "emitter", "sensor", "bsdf", "integrator", "medium", "film", "sampler", "rfilter", "phase",
              "texture", "volume", "compensation", "visibility"]


@lru_cache(maxsize=1)
def _manuals() -> Dict[str, Dict[str, Dict[str, str]]]:
    """{type: {category: {parameter: kind}}}"""
    pages: Dict[str, Dict[str, Dict[str, str]]] = {}
    for page in manuals():
        pages.setdefault(page["type"], {})[page["category"]] = {p["name"]: p["type"] for p in page["parameters"]}
    return pages


def _category(kind: str, key: str, parent: Mapping[str, str]) -> str:
    """Which category is meant by a type that an object under `key` has."""
    found = _manuals().get(kind)
    if not found:
        return parent[key] if parent.get(key) in _PREFERRED else key if key in _PREFERRED else "shape"
    if parent.get(key) in found:
        return parent[key]
    fitting = [c for c in _PREFERRED if c in found and c in parent.values()]
    return fitting[0] if fitting else next(c for c in _PREFERRED if c in found)


def _fail(place: str, text: str) -> Error:
    error = Error(f"{place}: {text}")
    error.file, error.errors = place, [(str(error), place, 0)]
    return error


def _indices(values: Any, place: str) -> np.ndarray:
    """Whole numbers that 32 bits hold."""
    array = np.asarray(values)
    if array.dtype.kind not in "iu":
        raise _fail(place, f"triangles are whole numbers, not {array.dtype}")
    if array.size and (array.min() < 0 or array.max() > np.iinfo(np.uint32).max):
        raise _fail(place, f"triangles name vertices from 0 on, not {array.min()} to {array.max()}")
    return np.ascontiguousarray(array, dtype=np.uint32)


class _Writer:
    def __init__(self, tree: _mote.Tree) -> None:
        self.tree = tree

    def scene(self, scene: Mapping[str, Any]) -> None:
        if scene.get("type", "scene") != "scene":
            raise _fail("scene", "the dictionary of a scene has the type 'scene'")
        for key, value in scene.items():
            if key == "type":
                continue
            if not isinstance(value, Mapping):
                raise _fail(f"scene.{key}", "directly in a scene are objects: dictionaries with a 'type'")
            self.object(key, value, {}, f"scene.{key}", top=True)

    def object(self, key: str, given: Mapping[str, Any], parent: Mapping[str, str], place: str, top: bool = False) -> None:
        if "type" not in given:
            raise _fail(place, "an object has a 'type'")
        entries = dict(given)
        kind = entries.pop("type")
        if kind == "ref":
            self.tree.reference(str(entries.get("id", "")), "" if key in ("bsdf", "emitter") else key)
        elif kind in ("rgb", "spectrum", "float", "integer", "boolean", "string"):
            self.value(key, entries.get("value"), "rgb" if kind == "spectrum" else kind, place)
        else:
            category = _category(kind, key, parent)
            identity = str(entries.pop("id", key if top else ""))
            kind, entries = self.with_arrays(kind, entries, place)
            self.tree.begin(category, kind, "" if top else key, identity, key)
            known = _manuals().get(kind, {}).get(category, {})
            for name, value in entries.items():
                if isinstance(value, Mapping):
                    self.object(name, value, known, f"{place}.{name}")
                else:
                    self.value(name, value, known.get(name, ""), f"{place}.{name}")
            self.tree.end()

    def with_arrays(self, kind: str, entries: Dict[str, Any], place: str) -> Tuple[str, Dict[str, Any]]:
        """Meshes and grids of arrays, which the tree takes apart from its elements."""
        name = place
        if "positions" in entries and kind in ("arraymesh", "mesh"):
            def floats(key: str) -> Any:
                value = entries.pop(key, None)
                return None if value is None else np.ascontiguousarray(value, dtype=np.float32)
            triangles = _indices(entries.pop("triangles"), place)
            self.tree.add_mesh(name, floats("positions"), triangles, floats("normals"), floats("uvs"))
            kind = "arraymesh"
        elif "data" in entries and kind in ("arraygrid", "gridvolume"):
            bounds = entries.pop("bounds", ((0, 0, 0), (1, 1, 1)))
            given = np.asarray(entries.pop("data"))
            _mote.require_memory(8.0 * given.size, f"the grid {place} and its copy")  # of views, which take nothing
            values = np.ascontiguousarray(given, dtype=np.float32)
            self.tree.add_grid(name, values, [float(x) for x in bounds[0]], [float(x) for x in bounds[1]])
            kind = "arraygrid"
        else:
            return kind, entries
        return kind, {"array": name, **entries}

    def value(self, name: str, value: Any, kind: str, place: str) -> None:
        """`kind` as the manual page has it; "": the page lacks the name, and the loader reports it."""
        matrix = getattr(value, "matrix", None)
        if matrix is not None or kind == "transform":
            rows = np.asarray(value if matrix is None else matrix, dtype=float)
            if rows.size != 16:
                raise _fail(place, f"a transform has 4 x 4 numbers, not {rows.shape}")
            self.tree.transform(name, [float(x) for x in rows.reshape(16)])
        elif isinstance(value, (bool, np.bool_)):
            self.tree.value("boolean", name, "true" if value else "false")
        elif isinstance(value, str):
            self.tree.value("string", name, value)
        elif isinstance(value, (int, np.integer)) and kind in ("integer", ""):
            self.tree.value("integer", name, str(int(value)))
        elif np.ndim(value) == 0 and not isinstance(value, (type(None), bytes)):
            self.tree.number(name, float(value))
        elif np.shape(value) == (3,):
            x, y, z = (float(c) for c in value)
            self.tree.triple(kind if kind in ("point", "vector") else "rgb", name, x, y, z)
        else:
            raise _fail(place, f"{value!r} is no value of a scene: a number, a text, a truth value, three numbers, a "
                               "4 x 4 matrix or a dictionary")


def tree_of(scene: Mapping[str, Any], folder: str) -> _mote.Tree:
    tree = _mote.Tree("scene", folder)
    _Writer(tree).scene(scene)
    return tree


def texts_of(parameters: Mapping[str, Any]) -> List[Tuple[str, str]]:
    """Parameters as -D gives them."""
    def text(value: Any) -> str:
        if isinstance(value, (bool, np.bool_)):
            return "true" if value else "false"
        value = getattr(value, "matrix", value)  # of a transform
        if isinstance(value, (list, tuple, np.ndarray)):
            return ", ".join(repr(float(x)) for x in np.ravel(value))
        return str(value)
    return [(name.replace("__", "."), text(value)) for name, value in parameters.items()]
