"""The settings of a scene, among them one group of properties for each integrator, made from integrators.json."""
import json
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

TABLE = json.loads((Path(__file__).parent / "integrators.json").read_text())


def number(text, kind):
    """The default as a number, or None where the page describes it in words ("automatic")."""
    try:
        return kind(text)
    except ValueError:
        return None


def property_of(parameter):
    """A Blender property for one row of the page. Where the default is no number it is text, and empty for the default."""
    default, hint = parameter["default"].strip(), parameter["meaning"]
    about = {"name": parameter["name"].replace("_", " ").capitalize(), "description": hint}
    kind = parameter["type"]
    if kind == "boolean":
        return BoolProperty(default=default == "true", **about)
    if kind == "integer" and number(default, int) is not None:
        return IntProperty(default=int(default), **about)
    if kind == "float" and number(default, float) is not None:
        return FloatProperty(default=float(default), precision=4, **about)
    if kind in TABLE["objects"]:
        return EnumProperty(items=[(t, t, "") for t in TABLE["objects"][kind]], default=default, **about)
    return StringProperty(default=default if kind == "string" else "", **about)


def group_of(integrator, entry):
    annotations = {p["name"]: property_of(p) for p in entry["parameters"]}
    return type("Mote_" + integrator, (bpy.types.PropertyGroup,), {"__annotations__": annotations})


GROUPS = {name: group_of(name, entry) for name, entry in TABLE["integrators"].items()}


class MoteSettings(bpy.types.PropertyGroup):
    """Scene.mote: options of `mote render`."""
    integrator: EnumProperty(name="Integrator", default="volpath",
                             items=[(name, name, entry["text"]) for name, entry in TABLE["integrators"].items()])
    passes: IntProperty(name="Passes", default=64, min=1, description="One sample a pixel each")
    seconds: FloatProperty(name="Time limit", default=0, min=0, description="Stop after so many seconds; 0: no limit")
    noise: FloatProperty(name="Noise", default=0, min=0, max=1, precision=4,
                         description="Stop when the noise is this, such as 0.02; 0: after all passes")
    seed: IntProperty(name="Seed", default=0, min=0)
    threads: IntProperty(name="Threads", default=0, min=0, description="0: one for every core")
    pixel_filter: EnumProperty(name="Pixel filter", default="gaussian",
                               items=[(n, n, "") for n in ("gaussian", "box", "tent")])
    keep: StringProperty(name="Keep files in", subtype="DIR_PATH",
                         description="Write the exported scene here and leave it; empty: a temporary folder")
    layers: StringProperty(options={"HIDDEN"}, description="Layers of the last picture, for the compositor")
    approximated: StringProperty(options={"HIDDEN"}, description="What the last export approximated, a line each")


for _name, _group in GROUPS.items():
    MoteSettings.__annotations__[_name] = PointerProperty(type=_group)
CLASSES = [*GROUPS.values(), MoteSettings]


def parameters(settings):
    """(name, type, value) of the chosen integrator's parameters that differ from their defaults."""
    group = getattr(settings, settings.integrator)
    for row in TABLE["integrators"][settings.integrator]["parameters"]:
        if group.is_property_set(row["name"]) and getattr(group, row["name"]) != "":
            yield row["name"], row["type"], getattr(group, row["name"])
