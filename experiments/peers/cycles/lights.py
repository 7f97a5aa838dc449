"""Emitters of the exported scene as lamps and a world of Blender, in the same radiometric units.

A lamp of energy P has the radiant intensity P / (4 pi) as a point or spot, the radiance P / (4 area) as an area, and the
irradiance P as a sun: as in Cycles' source, and as `match.py` measures. Spots fall off linearly in the angle, from
beam_width to cutoff_angle, by nodes: Blender's own cone is wider and cuts nothing, and the cosine that Cycles 3.4
multiplies it by is divided away.
"""
import math

import bpy
import numpy as np
from mathutils import Matrix
from nodes import Nodes

OFFSET = 1e-4   # of a lamp before the black rectangle that stands behind it, relative to its size


def add_emitter(emitter, folder, notes):
    made = {"spot": add_spot, "point": add_point, "directional": add_sun, "constant": add_constant,
            "envmap": add_environment}.get(emitter.type)
    if made is None:
        notes.append(f"emitter '{emitter.type}' is left out")
        return
    made(emitter, folder)


def add_lamp(kind, colour, energy, matrix):
    """Colours above 1 go into the energy."""
    lamp = bpy.data.lights.new(kind.lower(), kind)
    peak = max(max(colour), 1e-30)
    lamp.color, lamp.energy = [c / peak for c in colour], energy * peak
    lamp.cycles.max_bounces = 1024
    lamp.cycles.use_multiple_importance_sampling = True
    made = bpy.data.objects.new(lamp.name, lamp)
    made.matrix_world = Matrix(matrix.tolist())
    made.visible_camera = kind == "AREA"  # Blender hides lamps from the camera
    bpy.context.scene.collection.objects.link(made)
    return lamp


def frame(forward, origin=(0, 0, 0), across=None):
    """Blender's lamps shine along -z: a matrix with `forward` there."""
    z = -np.asarray(forward, float) / np.linalg.norm(forward)
    x = np.asarray(across if across is not None else np.cross([0, 1, 0] if abs(z[1]) < 0.9 else [1, 0, 0], z), float)
    x = x / np.linalg.norm(x)
    result = np.eye(4)
    result[:3] = np.stack([x, np.cross(z, x), z, origin], axis=1)
    return result


def add_point(emitter, _):
    place = emitter.transforms.get("to_world", np.eye(4))[:3, 3] + emitter.get("position", [0, 0, 0])
    add_lamp("POINT", emitter.rgb("intensity"), 4 * math.pi, frame((0, 0, 1), place)).shadow_soft_size = 0.0


def add_spot(emitter, _):
    matrix = emitter.transforms["to_world"]
    cutoff = math.radians(emitter.get("cutoff_angle", 20.0))
    beam = math.radians(emitter.get("beam_width", 0.75 * math.degrees(cutoff)))
    lamp = add_lamp("SPOT", emitter.rgb("intensity"), 4 * math.pi, frame(matrix[:3, 2], matrix[:3, 3]))
    lamp.shadow_soft_size, lamp.spot_size, lamp.spot_blend = 0.0, 2 * cutoff + math.radians(1.0), 0.01
    lamp.use_nodes = True
    nodes = Nodes(lamp.node_tree)
    direction = nodes.add("ShaderNodeSeparateXYZ", "Z", (nodes.add("ShaderNodeTexCoord", "Normal"),))
    cosine = nodes.math("MULTIPLY", direction, -1.0)
    angle = nodes.math("ARCCOSINE", cosine)
    share = nodes.math("DIVIDE", nodes.math("SUBTRACT", cutoff, angle), max(cutoff - beam, 1e-6), clamp=True)
    nodes.output("ShaderNodeOutputLight", Surface=nodes.add("ShaderNodeEmission", inputs={"Strength": share}))


def add_sun(emitter, _):
    direction = emitter.get("direction") or emitter.transforms["to_world"][:3, 2]
    add_lamp("SUN", emitter.rgb("irradiance"), 1.0, frame(direction)).angle = 0.0


def world():
    made = bpy.data.worlds.new("world")
    bpy.context.scene.world = made
    made.use_nodes = True
    return made, Nodes(made.node_tree)


def add_constant(emitter, _):
    _, nodes = world()
    nodes.output("ShaderNodeOutputWorld",
                 Surface=nodes.add("ShaderNodeBackground", inputs={"Color": emitter.rgb("radiance")}))


def add_environment(emitter, folder):
    """Blender's map has z upwards: its direction (z, x, y) has Mitsuba's longitude atan2(x, -z)."""
    made, nodes = world()
    turn = np.linalg.inv(emitter.transforms.get("to_world", np.eye(4))[:3, :3])
    seen = nodes.add("ShaderNodeTexCoord", "Generated")
    local = [nodes.add("ShaderNodeVectorMath", "Value", (seen, tuple(turn[i])), operation="DOT_PRODUCT")
             for i in (2, 0, 1)]
    image = bpy.data.images.load(str(folder / emitter.get("filename")))
    image.colorspace_settings.name = "Linear Rec.709"
    colour = nodes.add("ShaderNodeTexEnvironment", inputs=(nodes.add("ShaderNodeCombineXYZ", inputs=local),), image=image)
    nodes.output("ShaderNodeOutputWorld", Surface=nodes.add(
        "ShaderNodeBackground", inputs={"Color": colour, "Strength": float(emitter.get("scale", 1.0))}))
    made.cycles.sampling_method = "MANUAL"
    made.cycles.sample_map_resolution = 2048


def add_area(mesh, radiance):
    """A lamp where the mesh is one rectangle, sampled by solid angle; False where it is none: then the mesh shines."""
    corners = rectangle_of(mesh)
    if corners is None:
        return False
    a, b = corners[1] - corners[0], corners[3] - corners[0]
    width, height, normal = np.linalg.norm(a), np.linalg.norm(b), np.cross(a, b) / np.linalg.norm(np.cross(a, b))
    centre = corners.mean(axis=0) + OFFSET * max(width, height) * normal
    lamp = add_lamp("AREA", radiance, math.pi * width * height, frame(normal, centre, a))
    lamp.shape, lamp.size, lamp.size_y = "RECTANGLE", width, height
    return True


def rectangle_of(mesh):
    """Its corners in the order of its winding, or None."""
    if len(mesh.positions) != 4 or len(mesh.triangles) != 2:
        return None
    first, second = mesh.triangles.tolist()
    shared = set(first) & set(second)
    apex = [c for c in first if c not in shared]
    if len(shared) != 2 or len(apex) != 1:
        return None
    i = first.index(apex[0])
    other = next(c for c in second if c not in shared)
    corners = mesh.positions[[apex[0], first[(i + 1) % 3], other, first[(i + 2) % 3]]]
    a, b, c = corners[1] - corners[0], corners[3] - corners[0], corners[2] - corners[1]
    scale = np.linalg.norm(a) * np.linalg.norm(b)
    return corners if abs(a @ b) < 1e-6 * scale and np.linalg.norm(b - c) < 1e-6 * np.linalg.norm(b) else None
