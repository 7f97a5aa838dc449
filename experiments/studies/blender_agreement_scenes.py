"""Inside of Blender: four scenes, each rendered by Cycles and by mote with several seeds. See blender_agreement.py.

Arguments after --: ADDON.zip FOLDER SMOKE.vdb WIDTH SAMPLES SEEDS SCENE...
"""
import json
import math
import resource
import sys
from pathlib import Path

import bpy
from mathutils import Matrix

DEPTH = 12  # edges of the longest path, the emitter's included


def material(name, kind, socket="Surface", **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    if hasattr(shader, "distribution"):
        shader.distribution = "GGX"  # with single scattering
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    tree.links.new(shader.outputs[0], output.inputs[socket])
    return made


def put(name, data, matrix, shader=None):
    if shader is not None:
        data.materials.append(shader)
    made = bpy.data.objects.new(name, data)
    made.matrix_world = matrix
    bpy.context.scene.collection.objects.link(made)
    return made


def plane(shader, matrix):
    data = bpy.data.meshes.new("plane")
    data.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    return put("plane", data, matrix, shader)


def ball(shader, x, radius=0.5):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, segments=48, ring_count=24, location=(x, 0, radius))
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(shader)


def box(shader, size, centre):
    bpy.ops.mesh.primitive_cube_add(size=size, location=centre)
    bpy.context.object.data.materials.append(shader)


def lamp(kind, energy, matrix, size=1.0):
    data = bpy.data.lights.new("lamp", kind)
    data.energy = energy
    if kind == "AREA":
        data.size = size
    if kind == "SUN":
        data.angle = 0.0
    data.cycles.max_bounces = 1024
    put("lamp", data, matrix)


def grounds():
    grey = material("grey", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.6, 0.6, 1))
    plane(grey, Matrix.Diagonal((3, 3, 1, 1)))
    plane(grey, Matrix.Translation((0, 2, 1)) @ Matrix.Rotation(math.pi / 2, 4, "X") @ Matrix.Diagonal((3, 3, 1, 1)))


def room():
    grounds()
    box(material("red", "ShaderNodeBsdfDiffuse", Color=(0.7, 0.1, 0.1, 1)), 0.8, (-0.6, 0, 0.4))
    box(material("green", "ShaderNodeBsdfDiffuse", Color=(0.1, 0.6, 0.1, 1)), 0.6, (0.6, 0, 0.3))
    lamp("AREA", 60, Matrix.Translation((0, 0, 3)))


def sun():
    grounds()
    ball(material("lacquer", "ShaderNodeBsdfPrincipled", Base_Color=(0.6, 0.2, 0.1, 1), Roughness=0.4), -0.6)
    ball(material("metal", "ShaderNodeBsdfGlossy", Color=(0.8, 0.7, 0.5, 1), Roughness=0.5), 0.6)
    lamp("SUN", 3, Matrix.Rotation(math.radians(35), 4, "X") @ Matrix.Rotation(math.radians(20), 4, "Y"))
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.3, 0.5, 0.9, 1)


def fog():
    grounds()
    made = material("fog", "ShaderNodeVolumePrincipled", "Volume", Color=(0.8, 0.8, 0.8, 1), Density=1.0, Anisotropy=0.3)
    made.cycles.homogeneous_volume = True
    box(made, 1.2, (0, 0, 0.7))
    lamp("AREA", 60, Matrix.Translation((0, 0, 3)))


def table(smoke):
    """Scene as users make them: a floor with a picture, a ball of glass, smoke out of a file, under a lamp. No sky: our
    lamps hide what is behind them, those of Cycles do not."""
    wall = material("wall", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.55, 0.5, 1))
    plane(wall, Matrix.Translation((0, 2, 1)) @ Matrix.Rotation(math.pi / 2, 4, "X") @ Matrix.Diagonal((3, 3, 1, 1)))
    checked = material("checked", "ShaderNodeBsdfDiffuse")
    plane(checked, Matrix.Diagonal((3, 3, 1, 1)))
    layer = bpy.context.scene.objects[-1].data.uv_layers.new(name="uv")
    for loop, corner in zip(layer.data, ((0, 0), (6, 0), (6, 6), (0, 6))):
        loop.uv = corner
    nodes = checked.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = bpy.data.images.new("checks", 32, 32)
    rows, columns = [[(i // 32 if down else i % 32) // 16 for i in range(1024)] for down in (True, False)]
    colours = [(0.8, 0.3, 0.2, 1) if r == c else (0.85, 0.8, 0.7, 1) for r, c in zip(rows, columns)]
    texture.image.pixels[:] = [v for colour in colours for v in colour]
    checked.node_tree.links.new(texture.outputs[0], nodes["Diffuse BSDF"].inputs["Color"])
    ball(material("glass", "ShaderNodeBsdfGlass", Color=(1, 1, 1, 1), Roughness=0.0, IOR=1.5), -0.75)
    data = bpy.data.volumes.new("smoke")
    data.filepath = smoke
    data.materials.append(material("smoke", "ShaderNodeVolumePrincipled", "Volume", Color=(0.85, 0.85, 0.85, 1), Density=4.0))
    # The smoke is 2.9 m high along its y.
    put("smoke", data, Matrix.Translation((0.8, 0, 0.05)) @ Matrix.Rotation(math.pi / 2, 4, "X") @ Matrix.Scale(0.5, 4))
    lamp("AREA", 120, Matrix.Translation((0, -1, 3)), 1.5)


def view(angle, tilt, width):
    """The camera with an angle across [degrees], 4 m away; and the same settings for both engines."""
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.angle = math.radians(angle)
    matrix = Matrix.Translation((0, -4, 1.2)) @ Matrix.Rotation(math.radians(tilt), 4, "X")
    scene.camera = put("camera", camera, matrix)
    render, cycles, image = scene.render, scene.cycles, scene.render.image_settings
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, width * 9 // 16, 100
    render.threads_mode, render.threads = "FIXED", 2
    image.file_format, image.color_depth, image.exr_codec = "OPEN_EXR", "32", "ZIP"
    scene.view_settings.view_transform, scene.view_settings.exposure = "Raw", 0.0
    cycles.use_denoising = cycles.use_adaptive_sampling = cycles.use_auto_tile = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold, cycles.pixel_filter_type, cycles.film_exposure = 0.0, "BOX", 1.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, kind + "_bounces", 1024 if kind == "transparent_max" else DEPTH - 1)
    cycles.volume_step_rate, cycles.volume_max_steps = 0.5, 65536  # it marches through what is not homogeneous
    scene.mote.integrator, scene.mote.volpath.max_depth, scene.mote.pixel_filter = "volpath", DEPTH, "box"
    scene.mote.threads = 2
    return scene


def processor_seconds():
    return sum(u.ru_utime + u.ru_stime for u in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def main():
    archive, folder, smoke, width, samples, seeds, *names = sys.argv[sys.argv.index("--") + 1:]
    for name in names:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.preferences.addon_install(filepath=archive, overwrite=True)
        bpy.ops.preferences.addon_enable(module="mote_render")
        {"room": room, "sun": sun, "fog": fog, "table": lambda: table(smoke)}[name]()
        scene, log = view(*((31, 80) if name == "sun" else (50, 85)), int(width)), []  # close to the balls
        scene.cycles.samples = scene.mote.passes = int(samples)
        for engine in ("CYCLES", "MOTE"):
            scene.render.engine = engine
            for seed in range(int(seeds)):
                scene.cycles.seed = scene.mote.seed = seed + 1
                path = Path(folder) / f"{name}_{engine}_{seed}.exr"
                scene.render.filepath, began = str(path), processor_seconds()
                bpy.ops.render.render(write_still=True)
                log.append({"engine": engine, "file": path.name, "cpu_s": processor_seconds() - began})
        (Path(folder) / f"{name}.json").write_text(json.dumps({"runs": log, "notes": scene.mote.approximated}))


main()
