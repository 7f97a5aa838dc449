"""Writes a scene of bitterli_rainbow as its renderer reads it: every opaque surface has two sides. Read as Mitsuba reads
them, walls that turn their back are black there.

    python benchmark/two_sided.py FROM.xml TO.xml
"""
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

OPAQUE = ("diffuse", "roughconductor", "conductor", "plastic", "roughplastic")


def two_sided(source, target):
    """Files that the scene names are named by their whole path: the result stands in another folder."""
    tree = ElementTree.parse(source)
    scene = tree.getroot()
    for parent in [scene, *scene.iter("shape")]:
        for at, bsdf in enumerate(list(parent)):
            if bsdf.tag == "bsdf" and bsdf.get("type") in OPAQUE:
                wrapped = ElementTree.Element("bsdf", {"type": "twosided", **{k: v for k, v in bsdf.attrib.items() if k == "id"}})
                bsdf.attrib.pop("id", None)
                wrapped.append(bsdf)
                parent[at] = wrapped
    for shape in scene.iter("shape"):
        for name in shape.findall("string[@name='filename']"):
            name.set("value", str((Path(source).parent / name.get("value")).resolve()))
    tree.write(target, encoding="utf-8", xml_declaration=True)


if __name__ == "__main__":
    two_sided(sys.argv[1], sys.argv[2])
