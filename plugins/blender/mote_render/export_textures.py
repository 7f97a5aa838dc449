"""Values of node sockets: constants, pictures; what has no counterpart becomes the socket's own value, and is noted."""
import os
import shutil

import bpy
import numpy as np
from mathutils import Matrix

from .scene_xml import add, add_matrix, add_value

UPSIDE_DOWN = Matrix(((1, 0, 0, 0), (0, -1, 0, 1), (0, 0, 1, 0), (0, 0, 0, 1)))  # our v goes down, Blender's up
LINEAR = {"Non-Color", "Raw", "Linear", "Linear Rec.709", "Generic Data"}


def picture_name(image, ending):
    return f"picture_{abs(hash(image.name_full)) % 10**8}{ending}"


def picture_file(export, image):
    """The picture's file in the export's folder. Packed and generated ones are written as Blender holds them."""
    source = bpy.path.abspath(image.filepath_from_user()) if image.source == "FILE" else ""
    if source and os.path.isfile(source) and not image.packed_file and not image.is_dirty:
        name = picture_name(image, os.path.splitext(source)[1])
        shutil.copyfile(source, export.folder / name)
        return name
    name = picture_name(image, ".pfm" if image.is_float else ".png")
    save_pixels(image, export.folder / name)
    return name


def alpha_file(export, image):
    """The alpha of a picture as a grey picture of its own."""
    name = picture_name(image, "_alpha.pfm")
    write_pfm(export.folder / name, image.size, pixels_of(image)[:, [3, 3, 3]])
    return name


def pixels_of(image):
    """Rows of R, G, B, A from the bottom left; what is grey is grey in all."""
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    rows = pixels.reshape(-1, image.channels)
    colour = rows[:, [min(c, image.channels - 1) for c in range(3)]] if image.channels != 2 else rows[:, [0, 0, 0]]
    alpha = rows[:, -1:] if image.channels in (2, 4) else np.ones_like(rows[:, :1])
    return np.hstack([colour, alpha])


def write_pfm(path, size, rgb):
    """Rows from the bottom, as Blender's."""
    path.write_bytes("PF\n{} {}\n-1.0\n".format(*size).encode() + np.ascontiguousarray(rgb, "<f4").tobytes())


def save_pixels(image, path):
    """Bytes by Blender through an image of its own (the user's one keeps its name and its unsaved changes); floats,
    which are linear and which Blender would encode for its colour space, as PFM."""
    rgba = pixels_of(image)
    if image.is_float:
        return write_pfm(path, image.size, rgba[:, :3])
    copy = bpy.data.images.new("mote", *image.size, alpha=True)
    copy.pixels.foreach_set(rgba.ravel())
    copy.file_format, copy.filepath_raw = "PNG", str(path)
    copy.save()
    return bpy.data.images.remove(copy)


def source_of(socket):
    """The node that feeds a socket, through reroutes; None where it has a value of its own."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def constant(export, where, socket):
    """The value of a socket that must be constant in mote: a float, or a list of three."""
    node = source_of(socket)
    if node is not None and node.type in ("RGB", "VALUE"):
        socket = node.outputs[0]
    elif node is not None:
        export.note(f"{where}: the node '{node.name}' behind '{socket.name}' became a constant")
    value = socket.default_value
    return float(value) if isinstance(value, (int, float)) else [float(v) for v in list(value)[:3]]


def add_socket(export, where, parent, name, socket):
    """A parameter that may be a picture, or the alpha of one."""
    node = source_of(socket)
    if node is None or node.type != "TEX_IMAGE" or node.image is None:
        return add_value(parent, name, constant(export, where, socket))
    if node.extension not in ("REPEAT", "EXTEND", "MIRROR"):
        export.note(f"{where}: '{node.name}' is repeated, not cut")
    alpha = socket.links[0].from_socket.name == "Alpha"
    texture = add(parent, "texture", "bitmap", name,
                  filename=alpha_file(export, node.image) if alpha else picture_file(export, node.image),
                  wrap_mode={"EXTEND": "clamp", "MIRROR": "mirror"}.get(node.extension, "repeat"),
                  filter_type="nearest" if node.interpolation == "Closest" else "bilinear",
                  raw=alpha or node.image.colorspace_settings.name in LINEAR)
    turned = mapping(export, where, node)
    if turned != Matrix.Identity(4):
        add_matrix(texture, UPSIDE_DOWN @ turned @ UPSIDE_DOWN, "to_uv")
    return texture


def mapping(export, where, node):
    """The matrix of a mapping node of constant values between the corners' u, v and the picture."""
    source = source_of(node.inputs["Vector"])
    turned = Matrix.Identity(4)
    if source is not None and source.type == "MAPPING":
        location, turn, scale = (source.inputs.get(name) for name in ("Location", "Rotation", "Scale"))
        place = Matrix.Translation(location.default_value) if location and source.vector_type == "POINT" else turned
        turned = place @ turn.default_value.to_matrix().to_4x4() @ Matrix.Diagonal((*scale.default_value, 1))
        if source.vector_type not in ("POINT", "VECTOR") or any(i.is_linked for i in (location, turn, scale) if i):
            export.note(f"{where}: the mapping of '{node.name}' is left out")
            turned = Matrix.Identity(4)
        source = source_of(source.inputs["Vector"])
    if source is not None and (source.type not in ("UVMAP", "TEX_COORD") or not is_uv(node.inputs["Vector"])):
        export.note(f"{where}: '{node.name}' is laid by the corners' u and v")
    return turned


def is_uv(socket):
    """Do the texture coordinates at the end of a chain of mappings come out of UV?"""
    link = socket.links[0]
    while link.from_node.type in ("MAPPING", "REROUTE") and link.from_node.inputs[0].is_linked:
        link = link.from_node.inputs[0].links[0]
    return link.from_node.type == "UVMAP" or link.from_socket.name == "UV"
