"""Values of node sockets: constants, pictures; what has no counterpart becomes the socket's own value, and is noted."""
import os
import shutil

import bpy
import numpy as np

from .scene_xml import add, add_value

LINEAR = {"Non-Color", "Raw", "Linear", "Linear Rec.709", "Generic Data"}


def picture_file(export, image):
    """The picture's file in the export's folder. Packed and generated ones are written as Blender holds them."""
    source = bpy.path.abspath(image.filepath_from_user()) if image.source == "FILE" else ""
    if source and os.path.isfile(source) and not image.packed_file and not image.is_dirty:
        name = f"picture_{abs(hash(image.name_full)) % 10**8}{os.path.splitext(source)[1]}"
        shutil.copyfile(source, export.folder / name)
        return name
    name = f"picture_{abs(hash(image.name_full)) % 10**8}{'.pfm' if image.is_float else '.png'}"
    save_pixels(image, export.folder / name)
    return name


def save_pixels(image, path):
    """Bytes by Blender through an image of its own (the user's one keeps its name and its unsaved changes); floats,
    which are linear and which Blender would encode for its colour space, as PFM: rows from the bottom, as Blender's."""
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    rgba = pixels.reshape(-1, image.channels)[:, [min(c, image.channels - 1) for c in range(4)]]
    if image.is_float:
        header = "PF\n{} {}\n-1.0\n".format(*image.size)
        return path.write_bytes(header.encode() + np.ascontiguousarray(rgba[:, :3], "<f4").tobytes())
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
    """A parameter that may be a picture."""
    node = source_of(socket)
    if node is None or node.type != "TEX_IMAGE" or node.image is None:
        return add_value(parent, name, constant(export, where, socket))
    if node.inputs["Vector"].is_linked and source_of(node.inputs["Vector"]).type not in ("UVMAP", "TEX_COORD"):
        export.note(f"{where}: the mapping of '{node.name}' is left out")
    if node.extension not in ("REPEAT", "EXTEND", "MIRROR"):
        export.note(f"{where}: '{node.name}' is repeated, not cut")
    texture = add(parent, "texture", "bitmap", name, filename=picture_file(export, node.image),
                  wrap_mode={"EXTEND": "clamp", "MIRROR": "mirror"}.get(node.extension, "repeat"),
                  filter_type="nearest" if node.interpolation == "Closest" else "bilinear",
                  raw=node.image.colorspace_settings.name in LINEAR)
    return texture
