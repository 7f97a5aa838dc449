"""Blender's Principled BSDF by mote's, both Burley's: names differ between Blender 3 and 4."""
from .export_textures import add_socket, constant
from .scene_xml import add, add_value

# Ours, then the names of Blender 3 and 4, and the value that means "none" where only that is the same in both.
SAME = [("metallic", "Metallic", "Metallic"), ("roughness", "Roughness", "Roughness"),
        ("anisotropic", "Anisotropic", "Anisotropic")]
NEAR = [("spec_tint", "Specular Tint", None), ("sheen", "Sheen", "Sheen Weight"),
        ("clearcoat", "Clearcoat", "Coat Weight"), ("spec_trans", "Transmission", "Transmission Weight")]
LEFT_OUT = ["Subsurface", "Subsurface Weight", "Thin Film Thickness", "Diffuse Roughness"]


def add_principled(export, where, parent, node):
    alpha = node.inputs["Alpha"]
    if alpha.is_linked or alpha.default_value < 1:
        parent = add(parent, "bsdf", "mask")
        add_socket(export, where, parent, "opacity", alpha)
    bsdf = add(parent, "bsdf", "principled")
    add_socket(export, where, bsdf, "base_color", node.inputs["Base Color"])
    for ours, old, new in SAME + NEAR:
        add_weight(export, where, bsdf, node, ours, old, new)
    add_specular(export, where, bsdf, node)
    for name in LEFT_OUT:
        if socket(node, name) and (socket(node, name).is_linked or socket(node, name).default_value > 0):
            export.note(f"{where}: '{name}' is left out")
    if getattr(node, "distribution", "GGX") == "MULTI_GGX":
        export.note(f"{where}: GGX with single scattering")
    emission = emitted(export, where, node)
    if any(emission) and parent.get("type") == "mask":
        export.note(f"{where}: light from a surface with holes is left out")
        return None
    return emission


def socket(node, *names):
    return next((node.inputs[n] for n in names if n and n in node.inputs), None)


def add_weight(export, where, bsdf, node, ours, old, new):
    """Leaves out what is zero: the default of all but roughness."""
    found = socket(node, new, old)
    if found is None or found.type not in ("VALUE",):
        return
    if found.is_linked or found.default_value > 0 or ours == "roughness":
        add_socket(export, where, bsdf, ours, found)
        if (ours, old, new) in NEAR:
            export.note(f"{where}: '{found.name}' is near, not equal")
        if ours == "clearcoat":
            rough = constant(export, where, socket(node, "Clearcoat Roughness", "Coat Roughness"))
            add_value(bsdf, "clearcoat_gloss", min(max(1 - rough, 0.0), 1.0))


def add_specular(export, where, bsdf, node):
    """Reflectance head on: 0.08 * Specular in Blender 3; glass, and Blender 4 at level 0.5, have it from the IOR."""
    level, index = socket(node, "Specular", "Specular IOR Level"), constant(export, where, node.inputs["IOR"])
    glassy = constant(export, where, socket(node, "Transmission", "Transmission Weight")) > 0
    value = constant(export, where, level)
    if level.name == "Specular" and not glassy:
        return add_value(bsdf, "specular", min(value, 1.0))
    if level.name != "Specular" and value != 0.5:
        head_on = ((index - 1) / (index + 1)) ** 2 * 2 * value
        return add_value(bsdf, "specular", min(head_on / 0.08, 1.0))
    return add_value(bsdf, "eta", max(index, 1.001))


def emitted(export, where, node):
    strength = constant(export, where, node.inputs["Emission Strength"])
    if strength == 0:
        return [0.0, 0.0, 0.0]
    return [strength * c for c in constant(export, where, socket(node, "Emission Color", "Emission"))]
