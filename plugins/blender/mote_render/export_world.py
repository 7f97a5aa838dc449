"""The world: a colour, or a picture all around.

Blender looks a direction up at u = 1/2 - atan2(y, x) / 2 pi with z up, ours at u = atan2(x, -z) / 2 pi with y up: what
is (z, x, y) in Blender's axes is (x, y, z) in those of the picture.
"""
from mathutils import Matrix

from .export_textures import picture_file
from .scene_xml import add, add_matrix

AXES = Matrix(((0, 0, 1, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))


def add_world(export, scene):
    world = scene.world
    if world is None:
        return
    if not (world.use_nodes and world.node_tree):
        return add_constant(export, world.color, 1.0)
    output = next((n for n in world.node_tree.nodes if n.type == "OUTPUT_WORLD" and n.is_active_output), None)
    if output is None:
        return
    if output.inputs["Volume"].is_linked:
        export.note("the world's volume is left out")
    link = output.inputs["Surface"].links
    node = link[0].from_node if link else None
    if node is None:
        return
    if node.type != "BACKGROUND":
        return export.note(f"world: the node '{node.name}' is left out")
    strength, colour = node.inputs["Strength"], node.inputs["Color"]
    if strength.is_linked:
        export.note("world: what drives its strength is left out")
    source = colour.links[0].from_node if colour.is_linked else None
    if source is not None and source.type == "TEX_ENVIRONMENT" and source.image:
        return add_picture(export, source, strength.default_value)
    if source is not None:
        export.note(f"world: the node '{source.name}' became the colour behind it")
    add_constant(export, colour.default_value, strength.default_value)


def add_constant(export, colour, strength):
    radiance = [strength * c for c in list(colour)[:3]]
    if any(radiance):
        add(export.root, "emitter", "constant", radiance=radiance)


def add_picture(export, node, strength):
    if node.projection != "EQUIRECTANGULAR":
        export.note("world: a mirror ball is taken as latitude and longitude")
    turn, vector = Matrix.Identity(4), node.inputs["Vector"]
    source = vector.links[0].from_node if vector.is_linked else None
    if source is not None and source.type == "MAPPING":
        turn = source.inputs["Rotation"].default_value.to_matrix().to_4x4()
        if source.vector_type != "POINT" or any(source.inputs["Location"].default_value) or \
                tuple(source.inputs["Scale"].default_value) != (1, 1, 1):
            export.note("world: of its mapping only the rotation is kept")
    emitter = add(export.root, "emitter", "envmap", filename=picture_file(export, node.image), scale=float(strength))
    add_matrix(emitter, turn.inverted() @ AXES)
