"""Meshes as they are after modifiers: a binary PLY for each material of a mesh; what stands there more than once is
written once and placed by instances, but for lamps and media, which are copied."""
from collections import defaultdict

import numpy as np
from . import export_volumes
from .scene_xml import add, add_matrix

SHAPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


def add_meshes(export, depsgraph, materials):
    """All visible objects with surfaces; each mesh is named by what it was made of."""
    places = defaultdict(list)
    for entry in depsgraph.object_instances:
        if entry.object.type in SHAPES and entry.show_self:
            slots = tuple(s.material.name_full if s.material else "" for s in entry.object.material_slots)
            modified = entry.object.original.name_full if entry.object.modifiers else ""
            key = (entry.object.data.name_full if entry.object.data else "", modified, slots)
            places[key].append((entry.object.original.name_full, entry.matrix_world.copy()))
            if len(places[key]) == 1:
                places[key].insert(0, write_mesh(export, entry.object, len(places)))
        elif entry.object.type == "VOLUME" and entry.show_self:
            export_volumes.add_grid(export, entry.object, entry.matrix_world.copy(), materials)
    for parts, *copies in places.values():
        place(export, parts, [matrix for _, matrix in copies], materials)


def place(export, parts, matrices, materials):
    """Parts that emit or hold a medium are copied: groups hold no lights. The rest is a group when it is there often."""
    group = None
    for number, (file, smooth, material) in enumerate(parts):
        made = materials.of(material)
        if len(matrices) == 1 or made.emission or made.medium:
            for matrix in matrices:
                shape(export, export.root, file, smooth, made, matrix)
            continue
        if group is None:
            group = add(export.root, "shape", "shapegroup")
            group.set("id", "group_" + file[:-4])
        shape(export, group, file, smooth, made, None)
    for matrix in matrices if group is not None else []:
        instance = add(export.root, "shape", "instance")
        add_reference(instance, group.get("id"))
        add_matrix(instance, matrix)


def shape(export, parent, file, smooth, made, matrix):
    element = add(parent, "shape", "ply", filename=file, face_normals=not smooth)
    if matrix is not None:
        add_matrix(element, matrix)
    made.attach(element)


def add_reference(parent, name):
    add(parent, "ref", "").attrib.clear()
    parent[-1].set("id", name)


def write_mesh(export, obj, number):
    """[(file, smooth, material)] of an evaluated object, one for every material on it."""
    mesh = obj.to_mesh()
    parts = []
    if mesh is not None:
        mesh.calc_loop_triangles()
        if len(mesh.loop_triangles):
            vertices, triangles, slots, smooth = arrays(mesh)
            count = max(len(obj.material_slots), 1)
            for slot in np.unique(np.clip(slots, 0, count - 1)):
                file = f"mesh_{number}_{slot}.ply"
                write_ply(export.folder / file, vertices, triangles[np.clip(slots, 0, count - 1) == slot])
                material = obj.material_slots[slot].material if len(obj.material_slots) else None
                parts.append((file, smooth, material))
    obj.to_mesh_clear()
    return parts


def taken(collection, name, count, kind=np.float32):
    values = np.empty(count, kind)
    collection.foreach_get(name, values)
    return values


def arrays(mesh):
    """Of every corner x y z, normal, u and v (from the top, as pictures are); corners and material of triangles."""
    loops = len(mesh.loops)
    if hasattr(mesh, "calc_normals_split"):  # until Blender 4.0
        mesh.calc_normals_split()
        normals = taken(mesh.loops, "normal", 3 * loops)
    else:
        normals = taken(mesh.corner_normals, "vector", 3 * loops)
    positions = taken(mesh.vertices, "co", 3 * len(mesh.vertices)).reshape(-1, 3)
    corners = positions[taken(mesh.loops, "vertex_index", loops, np.int32)]
    uv = np.zeros((loops, 2), np.float32)
    if mesh.uv_layers.active:
        uv = taken(mesh.uv_layers.active.data, "uv", 2 * loops).reshape(-1, 2)
        uv[:, 1] = 1 - uv[:, 1]
    count = len(mesh.loop_triangles)
    triangles = taken(mesh.loop_triangles, "loops", 3 * count, np.int32).reshape(-1, 3)
    smooth = bool(taken(mesh.polygons, "use_smooth", len(mesh.polygons), bool).any())
    return (np.hstack([corners, normals.reshape(-1, 3), uv]), triangles,
            taken(mesh.loop_triangles, "material_index", count, np.int32), smooth)


def write_ply(path, vertices, triangles):
    """Binary PLY of the corners that the triangles use, equal ones once."""
    rows, index = np.unique(vertices[triangles.ravel()], axis=0, return_inverse=True)
    faces = np.empty(len(triangles), [("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, index.reshape(-1, 3)
    names = "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{names}"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(header.encode() + rows.astype("<f4").tobytes() + faces.tobytes())
