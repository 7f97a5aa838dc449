"""An empty scene below an orthographic camera, for parts.py and lamps.py, and its picture by either engine."""
import bpy
from making import add, render
from mathutils import Matrix

PIXELS = 8  # of a patch, each way


def stage(size, sky=1.0):
    """An empty scene: one orthographic camera of 1 m a patch looks down from 3 m, the sky is white or black."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for name in ("mote_render", "cycles"):
        bpy.ops.preferences.addon_enable(module=name)
    scene = bpy.context.scene
    data = bpy.data.cameras.new("camera")
    data.type, data.ortho_scale = "ORTHO", max(size)
    scene.camera = add("camera", data, Matrix.Translation((0, 0, 3)))
    scene.render.resolution_x, scene.render.resolution_y = (PIXELS * n for n in size)
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads, scene.mote.threads = "FIXED", 2, 2
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (1, 1, 1, 1), sky
    scene.render.engine, scene.mote.pixel_filter, scene.mote.passes = "MOTE", "box", 16
    return scene


def picture(scene, folder, engine="MOTE", samples=16):
    scene.render.engine, cycles = engine, scene.cycles
    scene.mote.passes = cycles.samples = samples
    scene.mote.keep = str(folder / "kept")
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.pixel_filter_type, cycles.light_sampling_threshold = "BOX", 0.0
    cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    cycles.max_bounces = cycles.transmission_bounces = cycles.transparent_max_bounces = 64
    return render(scene, folder)


def mean_of(block):
    """Mean and standard error, float's own included, of the independent pixels of a block."""
    return block.mean(), block.std(ddof=1) / block.size**0.5 + 1e-4 * abs(block.mean())
