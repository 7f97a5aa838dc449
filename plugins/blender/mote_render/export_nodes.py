"""Surface nodes: for each the nearest BSDF of mote. Functions add one BSDF to `parent` and return the emission [3]."""
import xml.etree.ElementTree as tree

from .export_principled import add_principled
from .export_textures import add_socket, constant, source_of
from .scene_xml import add, add_value

BLACK = [0.0, 0.0, 0.0]


def add_surface(export, where, parent, node):
    made = {"BSDF_DIFFUSE": diffuse, "BSDF_PRINCIPLED": add_principled, "BSDF_GLOSSY": glossy,
            "BSDF_ANISOTROPIC": glossy, "BSDF_GLASS": glass, "BSDF_REFRACTION": glass, "EMISSION": emission,
            "BSDF_TRANSPARENT": transparent, "BSDF_TRANSLUCENT": translucent, "MIX_SHADER": mix,
            "ADD_SHADER": add_up, "BSDF_VELVET": diffuse, "BSDF_SHEEN": diffuse,
            "SUBSURFACE_SCATTERING": diffuse}.get(node.type if node else "")
    if made is None:
        if node is not None:
            export.note(f"{where}: the node '{node.name}' became a grey diffuse")
        add(parent, "bsdf", "diffuse", reflectance=[0.8] * 3 if node else BLACK)
        return BLACK
    if node.inputs.get("Normal") and node.inputs["Normal"].is_linked:
        export.note(f"{where}: the normal of '{node.name}' is left out")
    return made(export, where, parent, node) or BLACK


def diffuse(export, where, parent, node):
    if node.type != "BSDF_DIFFUSE" or constant(export, where, node.inputs["Roughness"]) > 0:
        export.note(f"{where}: '{node.name}' is Lambertian")
    add_socket(export, where, add(parent, "bsdf", "diffuse"), "reflectance", node.inputs["Color"])


def roughness(export, where, node):
    """The facets' distribution and alpha: Blender's roughness is its square root. Smooth: None."""
    rough = constant(export, where, node.inputs["Roughness"])
    if node.distribution == "SHARP" or rough < 1e-2:
        return {}
    if node.distribution not in ("GGX", "BECKMANN"):
        export.note(f"{where}: '{node.name}' is GGX with single scattering")
    return {"distribution": "beckmann" if node.distribution == "BECKMANN" else "ggx", "alpha": rough**2}


def glossy(export, where, parent, node):
    if "Anisotropy" in node.inputs and constant(export, where, node.inputs["Anisotropy"]):
        export.note(f"{where}: '{node.name}' is isotropic")
    rough = roughness(export, where, node)
    bsdf = add(parent, "bsdf", "roughconductor" if rough else "conductor", **rough)
    add_socket(export, where, bsdf, "specular_reflectance", node.inputs["Color"])


def glass(export, where, parent, node):
    if node.type == "BSDF_REFRACTION":
        export.note(f"{where}: '{node.name}' also reflects")
    rough = roughness(export, where, node)
    bsdf = add(parent, "bsdf", "roughdielectric" if rough else "dielectric", ext_ior=1.0,
               int_ior=constant(export, where, node.inputs["IOR"]), **rough)
    for name in ("specular_reflectance", "specular_transmittance"):
        add_socket(export, where, bsdf, name, node.inputs["Color"])


def emission(export, where, parent, node):
    """Radiance of Cycles: colour times strength, on a black surface."""
    add(parent, "bsdf", "diffuse", reflectance=BLACK)
    strength = constant(export, where, node.inputs["Strength"])
    return [strength * c for c in constant(export, where, node.inputs["Color"])]


def transparent(export, where, parent, node):
    colour = constant(export, where, node.inputs["Color"])
    if max(colour) - min(colour) > 1e-3:
        export.note(f"{where}: '{node.name}' is grey")
    bsdf = add(parent, "bsdf", "mask", opacity=1 - sum(colour) / 3)
    add(bsdf, "bsdf", "diffuse", reflectance=BLACK)


def translucent(export, where, parent, node):
    export.note(f"{where}: '{node.name}' is a thin sheet of the principled kind")
    bsdf = add(parent, "bsdf", "principledthin", diff_trans=2.0, eta=1.0001, roughness=1.0)
    add_socket(export, where, bsdf, "base_color", node.inputs["Color"])


def mix(export, where, parent, node):
    """(1 - factor) of the first and factor of the second; with a transparent node a mask."""
    first, second = (source_of(node.inputs[i]) for i in (1, 2))
    for clear, other, share in ((first, second, "opacity"), (second, first, "1 - opacity")):
        if clear is not None and clear.type == "BSDF_TRANSPARENT":
            return masked(export, where, parent, node, other, share == "opacity")
    bsdf = add(parent, "bsdf", "blendbsdf")
    add_socket(export, where, bsdf, "weight", node.inputs[0])
    light = [add_surface(export, where, bsdf, source) for source in (first, second)]
    if not any(map(any, light)):
        return BLACK
    weight = min(max(constant(export, where, node.inputs[0]), 0.0), 1.0)
    return [(1 - weight) * a + weight * b for a, b in zip(*light)]


def masked(export, where, parent, node, other, factor_is_opacity):
    bsdf = add(parent, "bsdf", "mask")
    if factor_is_opacity:
        add_socket(export, where, bsdf, "opacity", node.inputs[0])
    else:
        add_value(bsdf, "opacity", 1 - constant(export, where, node.inputs[0]))
    if any(add_surface(export, where, bsdf, other)):
        export.note(f"{where}: light from a surface with holes is left out")


def add_up(export, where, parent, node):
    """One part may emit; two that reflect are half of each, which is said."""
    sources = [source_of(i) for i in node.inputs[:2]]
    parts, light = [], BLACK
    for source in sources:
        holder = tree.Element("holder")
        light = [a + b for a, b in zip(light, add_surface(export, where, holder, source))]
        if source is not None and source.type != "EMISSION":
            parts.append(holder[0])
    if len(parts) < 2:
        parent.append(parts[0]) if parts else add(parent, "bsdf", "diffuse", reflectance=BLACK)
        return light
    export.note(f"{where}: '{node.name}' became half of each of its parts")
    add(parent, "bsdf", "blendbsdf", weight=0.5).extend(parts)
    return light
