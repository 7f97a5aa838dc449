"""Objects of a scene and their parameters: scene["lamp"]["position"] = (0, 2, 0), or scene.lamp.position."""
from __future__ import annotations

from typing import Any, Dict, Iterator, List, Optional, Tuple

from ._manual import Manual, manuals

Element = Tuple[str, Dict[str, str], List[Any]]
_VALUES = {"boolean", "integer", "float", "string", "rgb", "spectrum", "point", "vector", "transform", "lookat", "ref", "default"}


def _parsed(text: str) -> Any:
    """A number, several numbers, a truth value, or the text."""
    if text in ("true", "false"):
        return text == "true"
    try:
        numbers = [float(word) for word in text.replace(",", " ").split()]
    except ValueError:
        return text
    numbers = [int(x) if x.is_integer() and "." not in text else x for x in numbers]
    return numbers[0] if len(numbers) == 1 else tuple(numbers) if numbers else text


def objects_of(element: Element) -> Dict[str, Element]:
    """Objects below an element by what a path calls them: their id, else name, else category, numbered where several have it."""
    objects = [child for child in element[2] if child[0] not in _VALUES]
    words = [child[1].get("id") or child[1].get("name") or child[0] for child in objects]
    seen: Dict[str, int] = {}
    named = {}
    for word, child in zip(words, objects):
        seen[word] = seen.get(word, 0) + 1
        named[f"{word}:{seen[word]}" if words.count(word) > 1 else word] = child
    return named


class SceneObject:
    """An object of a scene, as scene["ball"] gives it; scene["ball"]["bsdf"] is an object in it. A parameter is read by its
    name, its default where the scene says nothing, and set: the scene is then loaded again with it, meshes and grids that
    stay are not. Tab completes both."""

    def __init__(self, scene: Any, path: str) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_path", path)

    def _element(self) -> Element:
        element = self._scene._elements()
        for word in self._path.split(".") if self._path else []:
            element = objects_of(element)[word]
        return element

    def _manual(self) -> Optional[Manual]:
        tag, attributes, _ = self._element()
        return next((m for m in manuals() if m["category"] == tag and m["type"] == attributes.get("type")), None)

    def keys(self) -> List[str]:
        """Names of the objects in it and of its parameters."""
        page = self._manual()
        objects = list(objects_of(self._element()))
        return objects + [p["name"] for p in (page["parameters"] if page else ()) if p["name"] not in objects]

    def __getitem__(self, name: str) -> Any:
        element = self._element()
        if name in objects_of(element):
            return SceneObject(self._scene, f"{self._path}.{name}" if self._path else name)
        for tag, attributes, _ in element[2]:
            if attributes.get("name") == name and "value" in attributes:
                return _parsed(attributes["value"])
            if attributes.get("name") == name and tag in ("point", "vector"):
                return tuple(_parsed(attributes.get(axis, "0")) for axis in "xyz")
        if name == "type":
            return element[1].get("type")
        page = self._manual()
        for parameter in page["parameters"] if page else ():
            if parameter["name"] == name:
                return _parsed(parameter["default"]) if parameter["default"] else None
        raise KeyError(f"{self._path or 'the scene'} has no '{name}'; it has {', '.join(self.keys())}")

    def __setitem__(self, name: str, value: Any) -> None:
        """Raises mote.Error, and the scene stays as it was, for what the object's type does not take."""
        if not self._path:
            raise TypeError(f"'{name}' is an object of the scene: set its parameters, scene['{name}']['...']")
        self._scene._change({f"{self._path}.{name}": value})

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(key for key in self.keys() if key.isidentifier())]

    def _ipython_key_completions_(self) -> List[str]:
        return self.keys()

    def __repr__(self) -> str:
        tag, attributes, _ = self._element()
        return f"<{tag} '{attributes.get('type', '')}' {self._path}: {', '.join(self.keys())}>"
