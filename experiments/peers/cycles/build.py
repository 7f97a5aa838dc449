"""A Blender scene from an exported one: meshes, surfaces, lights, media, camera. See materials.py for what is equal."""
import math

import bpy
import lights
import media
import numpy as np
from flat_scene import read_flat_scene
from materials import Materials
from mathutils import Matrix
from meshes import is_smooth, mesh_of


def build(job, folder):
    """Replaces the open scene by that of folder/scene.xml; returns what differs, one line each.

    job: vdb [(file, grid, matrix)] in the order of the grids, cut_grids, volume_sampling (media.py).
    """
    scene, notes, grids = read_flat_scene(folder / "scene.xml"), [], list(job["vdb"])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    materials = Materials(notes)
    for shape in scene.all("shape"):
        mesh = mesh_of(shape, folder)
        if mesh is None:
            notes.append(f"shape '{shape.type}' is left out")
            continue
        bsdf, medium, emitter = shape.child("bsdf"), shape.child("medium", "interior"), shape.child("emitter")
        if medium is not None:
            if medium.type == "heterogeneous" and grids:
                media.grid(medium, mesh, grids.pop(0), job, notes)
            elif medium.type == "homogeneous":
                link(mesh, False, media.homogeneous(medium, job, notes))
            else:
                notes.append(f"medium '{medium.type}' without a VDB file is left out")
        if bsdf is not None and bsdf.type == "null":
            continue
        if emitter is not None and lights.add_area(mesh, emitter.rgb("radiance")):
            shape.children = [(n, e) for n, e in shape.children if e is not emitter]  # the black rectangle behind it
        link(mesh, is_smooth(shape), materials.of(shape))
    for emitter in scene.all("emitter"):
        lights.add_emitter(emitter, folder, notes)
    place_camera(scene.child("sensor"))
    return sorted(set(notes))


def link(mesh, smooth, material):
    data = bpy.data.meshes.new("mesh")
    count = len(mesh.triangles)
    data.vertices.add(len(mesh.positions))
    data.vertices.foreach_set("co", mesh.positions.astype(np.float32).ravel())
    data.loops.add(3 * count)
    data.loops.foreach_set("vertex_index", mesh.triangles.astype(np.int32).ravel())
    data.polygons.add(count)
    data.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
    data.polygons.foreach_set("loop_total", np.full(count, 3, np.int32))
    data.polygons.foreach_set("use_smooth", np.full(count, smooth))
    if mesh.uvs is not None:
        layer = data.uv_layers.new()
        layer.data.foreach_set("uv", mesh.uvs[mesh.triangles.ravel()].astype(np.float32).ravel())
    data.update()
    if smooth and mesh.normals is not None:
        data.normals_split_custom_set_from_vertices(mesh.normals.tolist())
    data.materials.append(material)
    made = bpy.data.objects.new("mesh", data)
    made.cycles.shadow_terminator_geometry_offset = 0.0
    bpy.context.scene.collection.objects.link(made)


def place_camera(sensor):
    """Mitsuba's camera looks along z with x to the left; Blender's along -z with x to the right."""
    film, render = sensor.child("film"), bpy.context.scene.render
    render.resolution_x, render.resolution_y = film.get("width"), film.get("height")
    render.resolution_percentage = 100
    camera = bpy.data.cameras.new("camera")
    matrix = sensor.transforms["to_world"] @ np.diag([-1.0, 1.0, -1.0, 1.0])
    made = bpy.data.objects.new("camera", camera)
    made.matrix_world = Matrix(matrix.tolist())
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = made
    camera.sensor_fit, camera.angle_x = "HORIZONTAL", angle_across(sensor, film.get("width"), film.get("height"))
    camera.clip_start, camera.clip_end = sensor.get("near_clip", 0.01), sensor.get("far_clip", 1e4)


def angle_across(sensor, width, height):
    """The horizontal angle of view, in radians; fov_axis says what `fov` is the angle of."""
    axis, half = sensor.get("fov_axis", "x"), math.tan(math.radians(sensor.get("fov")) / 2)
    size = {"x": width, "y": height, "smaller": min(width, height), "larger": max(width, height),
            "diagonal": math.hypot(width, height)}[axis]
    return 2 * math.atan(half * width / size)
