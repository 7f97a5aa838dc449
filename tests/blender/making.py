"""Objects and materials by name, rendering, and reading the image, for the tests inside of Blender."""
import bpy
import numpy as np
from mathutils import Matrix


def check(true, text):
    if not true:
        raise AssertionError(text)
    print("checked:", text)


def material(name, kind, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = made.node_tree
    nodes.nodes.clear()
    shader, output = nodes.nodes.new(kind), nodes.nodes.new("ShaderNodeOutputMaterial")
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    nodes.links.new(shader.outputs[0], output.inputs[0])
    return made


def add(name, data, *matrices):
    made = bpy.data.objects.new(name, data)
    made.matrix_world = matrices[0] if len(matrices) == 1 else matrices[0] @ matrices[1]
    bpy.context.scene.collection.objects.link(made)
    return made


def plane(name, shader, matrix):
    data = bpy.data.meshes.new(name)
    data.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    data.materials.append(shader)
    return add(name, data, matrix)


def render(scene, folder, name="picture"):
    """Renders as F12 does; the channels of the multi-layer EXR that Blender writes, without the view layer's name."""
    from mote_render.exr import read_exr
    image = scene.render.image_settings
    image.file_format, image.color_depth, image.exr_codec = "OPEN_EXR_MULTILAYER", "32", "ZIP"
    scene.render.filepath = str(folder / f"{name}.exr")
    bpy.ops.render.render(write_still=True)
    planes = read_exr(scene.render.filepath)
    return {channel.partition(".")[2]: plane for channel, plane in planes.items()}


def colour(planes, name="Combined"):
    return np.stack([planes[f"{name}.{c}"] for c in "RGB"], axis=2)
