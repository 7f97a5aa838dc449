"""The pieces of mote's scene language: elements with typed values, and what was approximated on the way."""
import xml.etree.ElementTree as tree


class Export:
    """What the parts of an export share: the folder, the scene's root element, and a list of approximations."""

    def __init__(self, folder):
        self.folder, self.root, self.notes = folder, tree.Element("scene", version="3.0.0"), []

    def note(self, text):
        """A line for the user about something that is not the same in mote."""
        if text not in self.notes:
            self.notes.append(text)

    def write(self, path):
        tree.indent(self.root)
        tree.ElementTree(self.root).write(path, encoding="utf-8")


def add(parent, tag, kind, name=None, **values):
    """<tag type="kind" name="name"> with values by their Python types: bool, int, float, str, a colour of three."""
    made = tree.SubElement(parent, tag, type=kind)
    if name:
        made.set("name", name)
    for key, value in values.items():
        add_value(made, key, value)
    return made


def add_value(parent, name, value):
    if isinstance(value, bool):
        tag, text = "boolean", str(value).lower()
    elif isinstance(value, int):
        tag, text = "integer", str(value)
    elif isinstance(value, float):
        tag, text = "float", repr(value)
    elif isinstance(value, str):
        tag, text = "string", value
    else:
        tag, text = "rgb", ", ".join(repr(float(v)) for v in list(value)[:3])
    tree.SubElement(parent, tag, name=name, value=text)


def add_matrix(parent, matrix, name="to_world"):
    """A 4 x 4 matrix; mathutils' and ours are both row-major, columns are vectors."""
    transform = tree.SubElement(parent, "transform", name=name)
    tree.SubElement(transform, "matrix", value=" ".join(repr(float(matrix[r][c])) for r in range(4) for c in range(4)))
