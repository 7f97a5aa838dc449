"""Inside of Blender: single parts of the export, each against what it must be by a formula, or against Cycles.

Surfaces are patches side by side in one plane below a white sky: no patch sees another, so that a patch's radiance is what
its nodes say. Tolerances are four standard errors, from the spread of the pixels of a patch, which are independent.
"""
import math

import bpy
import numpy as np
from lamps import grid, instances, lamps, media
from making import add, check, colour, plane
from mathutils import Euler, Matrix
from nodes import PATCHES, emission, node, surface
from stage import PIXELS, mean_of, picture, stage

def patches(folder):
    """Each node against its formula, and the same patch in Cycles."""
    scene = stage((len(PATCHES), 1))
    for i, (name, make, _) in enumerate(PATCHES):
        plane(name, surface(name, make), Matrix.Translation((i + 0.5 - len(PATCHES) / 2, 0, 0)) @ Matrix.Scale(0.5, 4))
    ours, cycles = (colour(picture(scene, folder, engine)) for engine in ("MOTE", "CYCLES"))
    for i, (name, _, expected) in enumerate(PATCHES):
        inner = np.s_[1:-1, PIXELS * i + 1:PIXELS * (i + 1) - 1, 1]
        (found, error), (other, their_error) = mean_of(ours[inner]), mean_of(cycles[inner])
        check(abs(found - expected) < 4 * error, f"{name}: {found:.4f} = {expected:.4f} +- {error:.4f}")
        check(abs(found - other) < 4 * math.hypot(error, their_error), f"{name}: as Cycles, {other:.4f}")


def textures(folder):
    """A picture of 4 x 2 colours, plainly, by a mapping, as data, and its alpha: every pixel as in Cycles."""
    scene = stage((5, 1), sky=1.0)
    for i, kind in enumerate(("plain", "mapped", "raw", "alpha", "float")):
        made = surface(kind, lambda tree, k=kind: textured(tree, k, folder))
        plane(kind, made, Matrix.Translation((i - 2, 0, 0)) @ Matrix.Scale(0.5, 4))
        unwrap(bpy.data.objects[kind].data)
    ours, cycles = (colour(picture(scene, folder, engine, 64)) for engine in ("MOTE", "CYCLES"))
    for i, kind in enumerate(("plain", "mapped", "raw", "alpha", "float")):
        a, b = (p[:, PIXELS * i:PIXELS * (i + 1)] for p in (ours, cycles))
        # 64 samples of a white sky leave 0.03 in a pixel at the most; pixels across an edge of texels have twice that.
        apart = np.abs(a - b)
        check(np.ptp(b) > 0.3 and apart.mean() < 0.03 and apart.max() < 0.15,
              f"texture, {kind}: difference to Cycles {apart.mean():.4f}, at the most {apart.max():.4f}")


def unwrap(mesh):
    layer = mesh.uv_layers.new(name="uv")
    for loop, corner in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = corner


def textured(tree, kind, folder):
    image = bpy.data.images.new("image_" + kind, 4, 2, alpha=True, float_buffer=kind == "float")
    values = np.random.default_rng(7).choice([0.2, 0.5, 0.9], (8, 4))
    values[:, 3] = (values[:, 0] + 0.1) if kind == "alpha" else 1
    image.pixels.foreach_set(values.astype(np.float32).ravel())
    if kind in ("plain", "raw", "alpha"):  # a file; the others are held by Blender alone
        image.alpha_mode = "CHANNEL_PACKED"
        image.filepath_raw, image.file_format = str(folder / f"{kind}.png"), "PNG"
        image.save()
    if kind == "raw":
        image.colorspace_settings.name = "Non-Color"
    shown, diffuse = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeBsdfDiffuse")
    shown.image, shown.interpolation = image, "Closest"
    if kind == "mapped":
        coordinates, turn = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
        turn.inputs["Location"].default_value = (0.25, -0.125, 0)
        turn.inputs["Rotation"].default_value = (0, 0, math.pi / 2)
        turn.inputs["Scale"].default_value = (2, 1, 1)
        tree.links.new(coordinates.outputs["UV"], turn.inputs["Vector"])
        tree.links.new(turn.outputs[0], shown.inputs["Vector"])
    if kind != "alpha":
        tree.links.new(shown.outputs["Color"], diffuse.inputs["Color"])
        return diffuse
    mixed, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
    diffuse.inputs["Color"].default_value = (0, 0, 0, 1)
    for output, place in ((shown.outputs["Alpha"], 0), (clear.outputs[0], 1), (diffuse.outputs[0], 2)):
        tree.links.new(output, mixed.inputs[place])
    return mixed


def glass(folder):
    """A tilted pane of n = 1.5 between the camera and a shining half plane: where its edge is seen, and how bright.

    Through a pane of thickness t at the angle a the edge moves by t sin a (1 - cos a / sqrt(n^2 - sin^2 a)); of light that is
    not polarised the pane lets (1 - F) / (1 + F) through, with F the mean of both polarisations' at one face.
    """
    angle, thick, n = math.radians(45), 0.5, 1.5
    scene = stage((8, 1), sky=0.0)
    plane("light", surface("light", emission(2.0)), Matrix.Translation((-2, 0, -3)) @ Matrix.Scale(2, 4))
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.context.object.matrix_world = Matrix.Rotation(angle, 4, "Y") @ Matrix.Diagonal((40, 40, thick, 1))
    bpy.context.object.data.materials.append(surface("glass", lambda tree: node(
        tree, "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0.0, IOR=n)))
    scene.camera.data.ortho_scale, scene.camera.matrix_world = 1, Matrix.Translation((0, 0, 40))
    ours = colour(picture(scene, folder, samples=64))[..., 1]
    inside = math.sqrt(n**2 - math.sin(angle)**2)
    faces = [((math.cos(angle) - inside) / (math.cos(angle) + inside))**2,
             ((n**2 * math.cos(angle) - inside) / (n**2 * math.cos(angle) + inside))**2]
    through, moved = (1 - sum(faces) / 2) / (1 + sum(faces) / 2), thick * math.sin(angle) * (1 - math.cos(angle) / inside)
    bright, error = mean_of(ours[:, :ours.shape[1] // 4])
    check(abs(bright / 2 - through) < 4 * error, f"glass lets {bright / 2:.4f} = {through:.4f} through")
    edge = ours.mean() / bright - 0.5  # in widths of the picture, which is 1 m
    check(abs(abs(edge) - moved) < 4 * error, f"glass moves an edge by {abs(edge):.4f} = {moved:.4f} m")


def depth_of_field(folder):
    """A small light at z seen with the focus at f is a disc of radius R = a |z - f| / z in the plane of focus, and
    its own half side s f / z: the variance across is R^2 / 4 + s^2 f^2 / (3 z^2)."""
    scene, side, far, focus = stage((8, 8), sky=0.0), 0.05, 3.0, 2.0
    plane("light", surface("light", emission(10.0)), Matrix.Scale(side, 4))
    data = scene.camera.data
    data.type, data.lens, data.dof.use_dof, data.dof.aperture_fstop = "PERSP", 50, True, 0.2
    data.angle = math.radians(15)
    target = add("target", None, Matrix.Translation((0.3, 0.2, far - focus)))
    aperture = data.lens * 1e-3 / (2 * data.dof.aperture_fstop)
    for what in ("distance", "object"):
        data.dof.focus_distance, data.dof.focus_object = (focus, None) if what == "distance" else (1.0, target)
        ours = colour(picture(scene, folder, samples=64))[..., 1]
        across = (np.arange(64) + 0.5 - 32) / 32 * focus * math.tan(data.angle / 2)
        weights = ours.sum(axis=0) / ours.sum()
        found = (weights * across**2).sum() - (weights * across).sum()**2
        pixel = across[1] - across[0]
        expected = (aperture * (far - focus) / far)**2 / 4 + (side * focus / far)**2 / 3 + pixel**2 / 12
        # Variance of the mean of x^2 over n points on a disc: (R^4 / 8 - R^4 / 16) / n; n samples met the light.
        error = expected / math.sqrt(64 * ours.sum() / 10)
        check(abs(found - expected) < 4 * error,
              f"depth of field by {what}: variance {found:.5f} = {expected:.5f} m^2 +- {error:.5f}")


def sky(folder):
    """A turned picture all around, seen by a wide camera: every pixel as in Cycles."""
    scene = stage((8, 5), sky=2.0)
    scene.camera.data.type, scene.camera.data.angle = "PERSP", math.radians(120)
    scene.camera.matrix_world = Euler((1.2, 0.1, 0.4)).to_matrix().to_4x4()
    # Smooth waves: in mote the first and last rows lie at the poles, in Blender half a row beside them.
    image = bpy.data.images.new("sky", 128, 64, float_buffer=True)
    around, up = np.meshgrid(np.linspace(0, 2 * np.pi, 128, endpoint=False), np.linspace(0, np.pi, 64))
    rows = np.stack([1 + np.cos(around + k) * np.sin(up) * (k > 0) + 0.8 * np.cos(up - k) for k in range(4)], axis=2)
    image.pixels.foreach_set(rows.astype(np.float32).ravel())
    tree = scene.world.node_tree
    around, turn, where = (tree.nodes.new("ShaderNode" + n) for n in ("TexEnvironment", "Mapping", "TexCoord"))
    around.image = image
    turn.inputs["Rotation"].default_value = (0.3, -0.5, 0.9)
    tree.links.new(where.outputs["Generated"], turn.inputs["Vector"])
    tree.links.new(turn.outputs[0], around.inputs["Vector"])
    tree.links.new(around.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    ours, cycles = (colour(picture(scene, folder, engine, 64)) for engine in ("MOTE", "CYCLES"))
    difference = np.abs(ours - cycles)
    check(np.median(difference) < 0.02 * cycles.mean() and abs(ours.mean() / cycles.mean() - 1) < 0.01,
          f"sky picture: median difference to Cycles {np.median(difference) / cycles.mean():.4f}, "
          f"means {ours.mean():.4f}, {cycles.mean():.4f}")


def parts(folder):
    for part in (patches, textures, glass, depth_of_field, sky, lamps, instances, grid, media):
        part(folder)
    print("checked: all")
