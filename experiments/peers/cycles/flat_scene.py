"""The scene that `mote export --to mitsuba3` writes, as plain data: elements with their values, transforms as matrices.

The export has no parameters, no includes and no defaults that differ from Mitsuba's, so a small reader suffices. What
the VDB grids were is in our own scene file alone (the export holds plain grids): `vdb_volumes` looks there.
"""
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

VALUES = ("float", "integer", "string", "boolean", "rgb", "vector", "point", "spectrum")


def numbers(text):
    return [float(word) for word in text.replace(",", " ").split()]


class Element:
    """`type`, `id`, `values` by name, `transforms` by name, `children` with the elements inside, references resolved."""

    def __init__(self, node, known):
        self.tag, self.type, self.id = node.tag, node.get("type", ""), node.get("id", "")
        self.name = node.get("name", "")
        self.values, self.transforms, self.children = {}, {}, []
        for child in node:
            if child.tag in VALUES:
                self.values[child.get("name")] = value_of(child)
            elif child.tag == "transform":
                self.transforms[child.get("name")] = matrix_of(child)
            elif child.tag == "ref":
                self.children.append((child.get("name", ""), known[child.get("id")]))
            elif child.tag != "default":
                element = Element(child, known)
                self.children.append((child.get("name", ""), element))
                if element.id:
                    known[element.id] = element

    def get(self, name, default=None):
        return self.values.get(name, default)

    def rgb(self, name, default=1.0):
        """Three numbers; a single one is grey."""
        value = self.values.get(name, default)
        value = value if isinstance(value, list) else [float(value)]
        return value * 3 if len(value) == 1 else value

    def child(self, tag, name=None):
        """The first element inside with this tag (and name), or None."""
        return next((e for n, e in self.children if e.tag == tag and name in (None, n)), None)

    def all(self, tag):
        return [e for _, e in self.children if e.tag == tag]


def value_of(node):
    text = node.get("value", "")
    if node.tag in ("vector", "point"):
        return numbers(text) if text else [float(node.get(axis, "0")) for axis in "xyz"]
    if node.tag in ("rgb", "spectrum"):
        return numbers(text)
    return {"float": float, "integer": int, "boolean": lambda t: t == "true"}.get(node.tag, str)(text)


def matrix_of(node):
    """The steps of a <transform>, the first of them applied first."""
    result = np.eye(4)
    for step in node:
        result = STEPS[step.tag](step) @ result
    return result


def translate(step):
    result = np.eye(4)
    result[:3, 3] = vector_of(step, 0.0)
    return result


def scale(step):
    return np.diag([*vector_of(step, 1.0), 1.0])


def vector_of(step, default):
    """Vector from the attributes x, y and z, or from `value`: three numbers, or one for all."""
    if step.get("value"):
        value = numbers(step.get("value"))
        return value * 3 if len(value) == 1 else value
    return [float(step.get(axis, default)) for axis in "xyz"]


def rotate(step):
    """By Rodrigues' formula."""
    axis, angle = np.array(vector_of(step, 0.0)), np.radians(float(step.get("angle")))
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result = np.eye(4)
    result[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return result


def look_at(step):
    """The z axis points to the target, x to the left."""
    origin, target, up = (np.array(numbers(step.get(name))) for name in ("origin", "target", "up"))
    forward = (target - origin) / np.linalg.norm(target - origin)
    left = np.cross(up, forward)
    left /= np.linalg.norm(left)
    result = np.eye(4)
    result[:3] = np.stack([left, np.cross(forward, left), forward, origin], axis=1)
    return result


STEPS = {"translate": translate, "scale": scale, "rotate": rotate, "lookat": look_at,
         "matrix": lambda step: np.array(numbers(step.get("value"))).reshape(4, 4)}


def read_flat_scene(path):
    """The <scene> element of an exported file."""
    return Element(ElementTree.parse(path).getroot(), {})


def vdb_volumes(path, defines=()):
    """(file, grid, matrix) of every <volume type="vdbvolume"> of one of our scene files, in its order.

    `defines` are NAME=VALUE as after -D; $names are replaced. Files that are included are not searched.
    """
    root = ElementTree.parse(path).getroot()
    named = {node.get("name"): node.get("value") for node in root.iter("default")}
    named.update(define.split("=", 1) for define in defines)
    for node in root.iter():
        for key, text in node.attrib.items():
            for name in sorted(named, key=len, reverse=True):
                text = text.replace(f"${name}", named[name])
            node.attrib[key] = text
    found = []
    for node in root.iter("volume"):
        if node.get("type") == "vdbvolume":
            volume = Element(node, {})
            file = Path(path).parent / volume.get("filename")
            found.append((str(file.resolve()), volume.get("grid", "density"),
                          volume.transforms.get("to_world", np.eye(4)).tolist()))
    return found
