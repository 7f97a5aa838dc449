"""Blender's lamps and world in radiometric units.

Cycles divides a lamp's energy P [W] by 4 pi for the radiant intensity of a point or spot, I = P / (4 pi); a sphere of
radius r with that flux has L = P / (4 pi^2 r^2), as pi L is its exitance and 4 pi r^2 its area. An area lamp has
L = P / (4 A): its flux is pi A L = P pi / 4, not P. A sun's energy is the irradiance [W/m^2] on what faces it. A spot's
cone takes light away and makes the rest no brighter.
"""
import math

import bpy
import numpy as np
from mathutils import Matrix

from .export_textures import write_pfm
from .scene_xml import add, add_matrix

PROFILE = 256  # texels across a spot's cone
TURNED = Matrix.Diagonal((1, -1, -1, 1))  # lamps shine along -z, our shapes face +z


def add_lights(export, depsgraph):
    for entry in depsgraph.object_instances:
        if entry.object.type == "LIGHT" and entry.show_self:
            add_light(export, entry.object, entry.matrix_world.copy())


def add_light(export, obj, matrix):
    lamp = obj.data
    if lamp.use_nodes and any(n.type not in ("EMISSION", "OUTPUT_LIGHT") for n in lamp.node_tree.nodes):
        export.note(f"light '{obj.name}': its nodes are left out")
    {"POINT": add_point, "SUN": add_sun, "SPOT": add_spot, "AREA": add_area}[lamp.type](
        export, obj, lamp, matrix, power(lamp))


def power(lamp):
    """Energy times colour, times the strength and colour of its emission node; exposure and temperature since 4.x."""
    result = [lamp.energy * 2.0 ** getattr(lamp, "exposure", 0.0) * c for c in lamp.color]
    if getattr(lamp, "use_temperature", False):
        result = [a * b for a, b in zip(result, lamp.temperature_color)]
    emission = [n for n in lamp.node_tree.nodes if n.type == "EMISSION"] if lamp.use_nodes and lamp.node_tree else []
    for node in emission[:1]:
        colour, strength = node.inputs["Color"].default_value, node.inputs["Strength"].default_value
        result = [a * b * strength for a, b in zip(result, colour)]
    return result


def add_point(export, obj, lamp, matrix, watts):
    place, radius = matrix.translation, lamp.shadow_soft_size
    if radius <= 0:
        light = add(export.root, "emitter", "point", intensity=[w / (4 * math.pi) for w in watts])
        return add_matrix(light, Matrix.Translation(place))
    shape = add(export.root, "shape", "sphere", radius=float(radius))
    add_matrix(shape, Matrix.Translation(place))
    hidden(export, obj)
    return add(shape, "emitter", "area", radiance=[w / (4 * math.pi**2 * radius**2) for w in watts])


def add_sun(export, obj, lamp, matrix, watts):
    if lamp.angle > 0:
        export.note(f"sun '{obj.name}': its disc of {math.degrees(lamp.angle):.3g} degrees became a direction")
    light = add(export.root, "emitter", "directional", irradiance=watts)
    add_matrix(light, matrix.to_quaternion().to_matrix().to_4x4() @ TURNED)


def add_spot(export, obj, lamp, matrix, watts):
    """A hard cone, through which a picture of Cycles' fall-off shines."""
    half = min(lamp.spot_size / 2, math.radians(89))
    if lamp.shadow_soft_size > 0:
        export.note(f"spot '{obj.name}': its radius became 0")
    light = add(export.root, "emitter", "spot", intensity=[w / (4 * math.pi) for w in watts],
                cutoff_angle=math.degrees(half), beam_width=math.degrees(half) * 0.9999)
    file = f"spot_{len(export.root)}.pfm"
    write_pfm(export.folder / file, (PROFILE, PROFILE), fall_off(half, lamp.spot_blend).repeat(3))
    add(light, "texture", "bitmap", "texture", filename=file, raw=True, wrap_mode="clamp")
    add_matrix(light, matrix.normalized() @ TURNED)


def fall_off(half, blend):
    """A smooth step in the cosine, over the square around the cone; times the cosine itself in Blender 3."""
    across = (2 * np.arange(PROFILE) + 1) / PROFILE - 1
    cosine = 1 / np.sqrt(1 + (across[:, None]**2 + across**2) * math.tan(half)**2)
    step = np.clip((cosine - math.cos(half)) / max((1 - math.cos(half)) * blend, 1e-9), 0, 1) if blend > 0 else 1 + 0 * cosine
    return step * step * (3 - 2 * step) * (cosine if bpy.app.version < (4, 0) else 1)


def add_area(export, obj, lamp, matrix, watts):
    across, up = lamp.size, lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size
    round_ = lamp.shape in ("DISK", "ELLIPSE")
    scale = matrix.to_scale()
    area = abs(across * scale.x * up * scale.y) * (math.pi / 4 if round_ else 1)
    if area <= 0:
        return export.note(f"area light '{obj.name}' has no area and is left out")
    if lamp.spread < math.pi - 1e-4:
        export.note(f"area light '{obj.name}': its spread became 180 degrees")
    hidden(export, obj)
    shape = add(export.root, "shape", "disk" if round_ else "rectangle")
    add_matrix(shape, matrix @ TURNED @ Matrix.Diagonal((across / 2, up / 2, 1, 1)))
    # Later Blender has the flux itself, pi L A = P; it can be made a radiance.
    share = math.pi * (area if lamp.normalize else 1) if hasattr(lamp, "normalize") else 4 * area
    return add(shape, "emitter", "area", radiance=[w / share for w in watts])


def hidden(export, obj):
    if not obj.visible_camera:
        export.note(f"light '{obj.name}' is seen by the camera (hide_emitters of the integrator hides all of them)")
