"""Materials: each is written once as a BSDF with an id; its emission and its medium go with the shapes that have it."""
import xml.etree.ElementTree as tree
from dataclasses import dataclass, field

from . import export_nodes, export_volumes
from .scene_xml import add

# BSDFs through which light passes: these stand as they are. All others are the same on both sides, as in Cycles.
OPEN = {"dielectric", "roughdielectric", "thindielectric", "principledthin", "null", "mask"}


@dataclass
class Made:
    """What a shape needs to have this material."""
    name: str
    emission: list = field(default_factory=list)
    medium: str = ""

    def attach(self, shape):
        tree.SubElement(shape, "ref", id=self.name)
        if self.emission:
            add(shape, "emitter", "area", radiance=self.emission)
        if self.medium:
            tree.SubElement(shape, "ref", name="interior", id=self.medium)


class Materials:
    """By Blender's materials; None is the grey that Blender gives to what has none."""

    def __init__(self, export):
        self.export, self.made = export, {}

    def of(self, material):
        key = material.name_full if material else ""
        if key not in self.made:
            self.made[key] = self.make(material, f"material_{len(self.made)}")
        return self.made[key]

    def make(self, material, name):
        holder, made = tree.Element("holder"), Made(name)
        surface, volume = outputs(material)
        if surface is not None:
            emission = export_nodes.add_surface(self.export, f"material '{material.name}'", holder, surface)
            made.emission = emission if any(emission) else []
            if made.emission:
                self.export.note(f"material '{material.name}' shines from the side of its normals alone")
        elif material is None or not material.use_nodes:
            colour = [0.8] * 3 if material is None else material.diffuse_color
            add(holder, "bsdf", "diffuse", reflectance=colour)
        else:
            add(holder, "bsdf", "null" if volume is not None else "diffuse", **({} if volume else {"reflectance": [0] * 3}))
        if volume is not None:
            made.medium = name + "_medium"
            export_volumes.add_homogeneous(self.export, f"material '{material.name}'", made.medium, volume)
        bsdf = both_sides(holder[0])
        bsdf.set("id", name)
        self.export.root.append(bsdf)
        return made


def outputs(material):
    """The nodes behind Surface and Volume of the active output, None where there is none."""
    if material is None or not material.use_nodes:
        return None, None
    node = material.node_tree.get_output_node("CYCLES") or material.node_tree.get_output_node("ALL")
    if node is None:
        return None, None
    return tuple(export_nodes.source_of(node.inputs[name]) for name in ("Surface", "Volume"))


def both_sides(bsdf):
    """The BSDF inside `twosided` where it is opaque; inside of a mask, that within it."""
    kinds = {element.get("type") for element in bsdf.iter("bsdf")}
    glassy = any(f.get("name") == "spec_trans" for f in bsdf.iter("float"))
    if bsdf.get("type") == "mask":
        inner = bsdf.find("bsdf")
        bsdf.remove(inner)
        bsdf.append(both_sides(inner))
        return bsdf
    if kinds & OPEN or glassy:
        return bsdf
    outer = tree.Element("bsdf", type="twosided")
    outer.append(bsdf)
    return outer
