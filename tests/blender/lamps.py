"""Inside of Blender: lamps of every form, instances and volumes; called by parts.py."""
import math
from pathlib import Path

import bpy
import numpy as np
from making import add, check, colour, plane
from mathutils import Matrix
from nodes import diffuse, surface
from stage import PIXELS, mean_of, picture, stage

WHITE = 0.8
HERE = Path(__file__).resolve().parent


def lamp(kind, matrix, energy=100.0, **settings):
    data = bpy.data.lights.new("lamp", kind)
    data.energy = energy
    if kind in ("POINT", "SPOT"):
        data.shadow_soft_size = 0.0
    for name, value in settings.items():
        setattr(data, name, value)
    return add("lamp", data, matrix)


def lamps(folder):
    """The floor below a lamp in the height h, by formula: E = P / (4 h^2) below an area lamp of any form."""
    scene = stage((1, 1), sky=0.0)
    plane("floor", surface("floor", diffuse((WHITE, WHITE, WHITE, 1))), Matrix.Scale(20, 4))
    scene.camera.data.ortho_scale = 0.1
    up, cosine = Matrix.Translation((0.3, 0, 4)), 1 / math.hypot(1, 0.3 / 4)  # where the camera does not see it
    area = 100 / (math.pi if bpy.app.version >= (4, 5) else 4) / 16 * cosine**4
    spot = 50 / (4 * math.pi) / 16 * cosine**(4 if bpy.app.version < (4, 0) else 3)
    for kind, matrix, irradiance, settings in (
            ("AREA", up, area, {"shape": "DISK", "size": 0.2}),
            ("AREA", up @ Matrix.Diagonal((2, 0.5, 1, 1)), area, {"shape": "ELLIPSE", "size": 0.1, "size_y": 0.2}),
            ("SPOT", up, spot, {"spot_size": math.radians(20), "spot_blend": 0.2, "color": (0.1, 0.5, 0.9)}),
            ("SUN", Matrix.Rotation(math.radians(60), 4, "X"), 1.5, {"energy": 3.0, "angle": math.radians(5)})):
        made = lamp(kind, matrix, **settings)
        found, error = mean_of(colour(picture(scene, folder))[..., 1])
        expected = WHITE / math.pi * irradiance
        # A lamp 0.2 m wide and the view of 0.1 m change E by less than (0.2 / 4)^2 + 2 * 0.05 * 0.3 / 16.
        name = f"{kind} {settings.get('shape', '')}".strip()
        check(abs(found / expected - 1) < 0.0045 + 4 * error / expected, f"lamp {name}: {found:.5f} = {expected:.5f}")
        cycles, their_error = mean_of(colour(picture(scene, folder, "CYCLES"))[..., 1])
        check(abs(cycles / expected - 1) < 0.01 + 4 * their_error / expected, f"lamp {name} in Cycles: {cycles:.5f}")
        bpy.data.objects.remove(made)
    spots(scene, folder)


def spots(scene, folder):
    """All that a spot throws on the floor, as in Cycles, and nothing beside its cone."""
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.camera.data.ortho_scale = 4.4
    for blend in (0.15, 1.0):
        made = lamp("SPOT", Matrix.Translation((0, 0, 4)), spot_size=math.radians(50), spot_blend=blend)
        ours, cycles = (colour(picture(scene, folder, engine))[..., 1] for engine in ("MOTE", "CYCLES"))
        check(abs(ours.mean() / cycles.mean() - 1) < 0.002 and ours[0, 0] == cycles[0, 0] == 0,
              f"spot of blend {blend}: all its light {ours.mean():.5f}, in Cycles {cycles.mean():.5f}, greatest difference "
              f"{np.abs(ours - cycles).max() / cycles.max():.3f} of the brightest")
        bpy.data.objects.remove(made)


def instances(folder):
    """Copies turned, stretched, mirrored, in a collection that stands there twice: depth and normals as in Cycles."""
    scene = stage((8, 5))
    scene.render.resolution_percentage = 400
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = True
    white = surface("white", diffuse((WHITE, WHITE, WHITE, 1)))
    bpy.ops.mesh.primitive_cone_add(radius1=0.5, depth=1.2, vertices=12, location=(-2.5, 1, 0))
    cone = bpy.context.object.data
    cone.materials.append(white)
    add("mirrored", cone, Matrix.Translation((-1, 1, 0)) @ Matrix.Rotation(0.8, 4, "X") @ Matrix.Diagonal((-1, 0.6, 1.5, 1)))
    group = bpy.data.collections.new("group")
    inner = bpy.data.objects.new("inner", cone)
    inner.matrix_world = Matrix.Translation((0.3, 0, 0)) @ Matrix.Rotation(1.1, 4, "Y")
    group.objects.link(inner)
    for matrix in (Matrix.Translation((1, 1, 0)) @ Matrix.Rotation(0.7, 4, "Z"),
                   Matrix.Translation((0, -1, 0)) @ Matrix.Scale(1.4, 4)):
        holder = add("holder", None, matrix)
        holder.instance_type, holder.instance_collection = "COLLECTION", group
    ours, cycles = (picture(scene, folder, engine, 1) for engine in ("MOTE", "CYCLES"))
    xml = (folder / "kept" / "scene.xml").read_text()
    check(xml.count('type="instance"') == 4 and xml.count('type="shapegroup"') == 1, "one mesh, four instances of it")
    # Pixels across an edge differ by where in them the sample lies; all others are the same.
    seen = [np.where(p["Depth.Z"] < 100, p["Depth.Z"], 9) for p in (ours, cycles)]
    same = np.abs(seen[0] - seen[1]) < 0.1
    check(same.mean() > 0.85 and (seen[0] < 9).mean() > 0.04, f"instances: depth as in Cycles in {same.mean():.1%} of the pixels")
    both = (seen[0] < 9) & (seen[1] < 9)
    normals = [np.stack([p[f"Normal.{c}"] for c in "XYZ"], axis=2)[both] for p in (ours, cycles)]
    alike = (normals[0] * normals[1]).sum(axis=1) > 0.98
    check(alike.mean() > 0.85, f"instances: normals as in Cycles in {alike.mean():.1%} of the pixels")


def grid(folder):
    """Transmittance of a .vdb file with a ramp of the density 0.25 + x [1/m] and 1.5 m deep, turned and twice as large, with
    densities of the object's space, which its scale leaves as opaque, and of the world's."""
    for space, density, size in (("OBJECT", 0.8, 2.0), ("WORLD", 0.4, 2.0)):
        scene = stage((1, 1))
        data = bpy.data.volumes.new("ramp")
        data.filepath = str(HERE / "ramp.vdb")  # 8 x 4 x 6 voxels of 0.25 m, the first about (0, 0, 0)
        data.materials.append(volume("ShaderNodeVolumePrincipled", Color=(0, 0, 0, 1), Density=density))
        data.render.space = space
        add("ramp", data, Matrix.Translation((1, -2, -3)) @ Matrix.Rotation(math.pi / 2, 4, "Z") @ Matrix.Scale(size, 4))
        # It sees x of the grid from 0.5 to 1.5 from the bottom up; in the outer columns the grid ends.
        scene.camera.data.ortho_scale = size
        scene.camera.matrix_world = Matrix.Translation((1 - 0.375 * size, -2 + size, 30))
        inner = np.s_[::-1, 2:-2, 1]
        found = colour(picture(scene, folder, samples=256))[inner].mean(axis=1)
        error = 0.5 / math.sqrt(256 * (PIXELS - 4))  # the greatest of what gets through or not
        length = 1.5 * (1 if space == "OBJECT" else size)
        expected = np.exp(-density * length * (0.75 + (np.arange(PIXELS) + 0.5) / PIXELS))
        check(np.abs(found - expected).max() < 4 * error and abs((found - expected).mean()) < 4 * error / PIXELS**0.5,
              f"grid of a file, density of {space}: {found.round(3)} = {expected.round(3)} +- {error:.3f}")
        cycles = colour(picture(scene, folder, "CYCLES", 4))[inner].mean(axis=1)
        shifted = np.exp(-density * length * (0.625 + (np.arange(PIXELS) + 0.5) / PIXELS))
        check(np.abs(cycles / shifted - 1).max() < 0.03, f"Cycles has the grid half a voxel farther: {cycles.round(3)}")


def media(folder):
    """A slab of 1 m before the white sky: it absorbs; it absorbs and shines; it scatters, of which a white sky shows nothing."""
    for kind, expected, inputs in (
            ("Absorption", math.exp(-0.9 * 0.8), {"Color": (0.2, 0.2, 0.2, 1), "Density": 0.9}),
            ("Principled", 0.5 + 0.5 * math.exp(-0.7), {"Color": (0, 0, 0, 1), "Density": 0.7, "Emission Strength": 0.35}),
            ("Scatter", 1.0, {"Color": (1, 1, 1, 1), "Density": 1.0, "Anisotropy": 0.4})):
        scene = stage((1, 1))
        bpy.ops.mesh.primitive_cube_add(size=1)
        bpy.context.object.matrix_world = Matrix() if kind == "Scatter" else Matrix.Diagonal((9, 9, 1, 1))
        bpy.context.object.data.materials.append(volume("ShaderNodeVolume" + kind, **inputs))
        scene.camera.data.ortho_scale = 0.5
        found, error = mean_of(colour(picture(scene, folder))[..., 1])
        check(abs(found - expected) < 4 * error, f"{kind} in a cube: {found:.4f} = {expected:.4f} +- {error:.4f}")


def volume(kind, **inputs):
    made = bpy.data.materials.new(kind)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    node, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    for name, value in inputs.items():
        node.inputs[name].default_value = value
    tree.links.new(node.outputs[0], output.inputs["Volume"])
    return made
