"""Inside of Blender: three scenes, each rendered by Cycles and by mote with several seeds. See blender_agreement.py.

Arguments after --: ADDON.zip FOLDER SAMPLES SEEDS SCENE...
"""
import json
import math
import resource
import sys
from pathlib import Path

import bpy
from mathutils import Matrix

SIZE, DEPTH = (64, 36), 12  # pixels; edges of the longest path, the emitter's included


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


def view(angle, tilt):
    """The camera with an angle across [degrees], 4 m away; and the same settings for both engines."""
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.angle = math.radians(angle)
    matrix = Matrix.Translation((0, -4, 1.2)) @ Matrix.Rotation(math.radians(tilt), 4, "X")
    scene.camera = put("camera", camera, matrix)
    render, cycles, image = scene.render, scene.cycles, scene.render.image_settings
    render.resolution_x, render.resolution_y, render.resolution_percentage = *SIZE, 100
    render.threads_mode, render.threads = "FIXED", 2
    image.file_format, image.color_depth, image.exr_codec = "OPEN_EXR", "32", "ZIP"
    scene.view_settings.view_transform, scene.view_settings.exposure = "Raw", 0.0
    cycles.use_denoising = cycles.use_adaptive_sampling = cycles.use_auto_tile = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.light_sampling_threshold, cycles.pixel_filter_type, cycles.film_exposure = 0.0, "BOX", 1.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    for kind in ("max", "diffuse", "glossy", "transmission", "volume", "transparent_max"):
        setattr(cycles, kind + "_bounces", 1024 if kind == "transparent_max" else DEPTH - 1)
    scene.mote.integrator, scene.mote.volpath.max_depth, scene.mote.pixel_filter = "volpath", DEPTH, "box"
    scene.mote.threads = 2
    return scene


def processor_seconds():
    return sum(u.ru_utime + u.ru_stime for u in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def main():
    archive, folder, samples, seeds, *names = sys.argv[sys.argv.index("--") + 1:]
    for name in names:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.preferences.addon_install(filepath=archive, overwrite=True)
        bpy.ops.preferences.addon_enable(module="mote_render")
        {"room": room, "sun": sun, "fog": fog}[name]()
        scene, log = view(*((31, 80) if name == "sun" else (50, 85))), []  # close to the balls
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
