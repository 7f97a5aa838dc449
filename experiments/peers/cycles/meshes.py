"""Triangles of a shape of the exported scene, as arrays: PLY and OBJ files, rectangles, cubes and spheres."""
from dataclasses import dataclass

import numpy as np

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
             "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4",
             "uint32": "u4", "float32": "f4", "float64": "f8"}


@dataclass
class Mesh:
    """In coordinates of the world once `transformed`; normals and uvs are per vertex, or None."""
    positions: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray = None
    uvs: np.ndarray = None

    def transformed(self, matrix):
        positions = self.positions @ matrix[:3, :3].T + matrix[:3, 3]
        normals = self.normals
        if normals is not None:
            normals = normals @ np.linalg.inv(matrix[:3, :3])
            normals = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        triangles = self.triangles if np.linalg.det(matrix[:3, :3]) > 0 else self.triangles[:, ::-1]
        return Mesh(positions, triangles, normals, self.uvs)


def mesh_of(shape, folder):
    """In coordinates of the world; None for a shape that is no mesh here."""
    if shape.type in ("ply", "obj"):
        mesh = (read_ply if shape.type == "ply" else read_obj)(folder / shape.get("filename"))
        if shape.get("face_normals", False):
            mesh.normals = None
    elif shape.type in ("rectangle", "cube"):
        mesh = rectangle() if shape.type == "rectangle" else cube()
    elif shape.type == "sphere":
        mesh = sphere(np.array(shape.get("center", [0.0, 0.0, 0.0])), shape.get("radius", 1.0))
    else:
        return None
    return mesh.transformed(shape.transforms.get("to_world", np.eye(4)))


def is_smooth(shape):
    """Mitsuba computes normals of vertices where an OBJ or PLY file has none, unless face_normals are requested."""
    return shape.type in ("ply", "obj", "sphere") and not shape.get("face_normals", False)


def rectangle():
    """[-1, 1] squared, its normal along z."""
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    return Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]), None, 0.5 + 0.5 * corners[:, :2])


def cube():
    """[-1, 1] cubed: six rectangles, turned."""
    square, parts = rectangle().positions + [0, 0, 1], []
    x, y, z = np.eye(3)
    for frame in ((x, y, z), (-x, y, -z), (z, y, -x), (-z, y, x), (x, -z, y), (x, z, -y)):
        parts.append(square @ np.array(frame))
    positions = np.concatenate(parts)
    faces = np.concatenate([rectangle().triangles + 4 * i for i in range(6)])
    return Mesh(positions, faces, None, np.tile(rectangle().uvs, (6, 1)))


def sphere(center, radius, rings=96):
    """By longitude and latitude, with the normals of the sphere; its area is that of the sphere, for the power of a lamp."""
    latitude, longitude = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1), indexing="ij")
    normals = np.stack([np.sin(latitude) * np.cos(longitude), np.sin(latitude) * np.sin(longitude), np.cos(latitude)], axis=2)
    normals = normals.reshape(-1, 3)
    corner = np.arange(rings)[:, None] * (2 * rings + 1) + np.arange(2 * rings)
    below, right = corner + 2 * rings + 1, corner + 1
    upper = np.stack([corner, below, right], axis=2)[1:]  # the pole's triangle of no area is left out
    lower = np.stack([right, below, below + 1], axis=2)[:-1]
    triangles = np.concatenate([upper.reshape(-1, 3), lower.reshape(-1, 3)])
    a, b, c = (normals[triangles[:, i]] for i in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    return Mesh(center + radius * np.sqrt(4 * np.pi / area) * normals, triangles, normals)


def read_obj(path):
    """Positions and faces; polygons become fans. Normals and uvs of the file are not read."""
    positions, triangles = [], []
    for line in open(path, encoding="utf-8", errors="replace"):
        words = line.split()
        if words[:1] == ["v"]:
            positions.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            corners = [c - 1 if c > 0 else len(positions) + c for c in corners]
            triangles += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
    return Mesh(np.array(positions), np.array(triangles))


def read_ply(path):
    """Binary, little-endian, triangles only; raises ValueError for others."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode().splitlines()
    if lines[1] != "format binary_little_endian 1.0":
        raise ValueError(f"{path}: not binary and little-endian")
    elements = []
    for line in lines:
        words = line.split()
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    read = {}
    for name, count, properties in elements:
        kind = np.dtype([field for words in properties for field in fields_of(words)])
        read[name] = np.frombuffer(data, kind, count, end)
        end += count * kind.itemsize
    if not (read["face"]["count"] == 3).all():
        raise ValueError(f"{path}: faces that are no triangles")
    corner = read["vertex"]
    columns = lambda names: np.stack([corner[n] for n in names], axis=1).astype(float)
    has = lambda name: name in corner.dtype.names
    uvs = next((columns(pair) for pair in (("u", "v"), ("s", "t")) if has(pair[0])), None)
    return Mesh(columns("xyz"), read["face"]["corners"].astype(int),
                columns(("nx", "ny", "nz")) if has("nx") else None, uvs)


def fields_of(words):
    """Fields of one property; a list is a count and three corners."""
    if words[0] == "list":
        return [("count", "<" + PLY_TYPES[words[1]]), ("corners", "<" + PLY_TYPES[words[2]], 3)]
    return [(words[1], "<" + PLY_TYPES[words[0]])]
