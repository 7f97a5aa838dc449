"""Meshes that cut light into shafts, as PLY files: a sculpture full of holes, and the crown of a tree; and water.

The sculpture represents the model that Engelhardt 2013 shows in chapter 9, which is not free: four spheres inside each
other, pierced along the level sets of gyroids.
"""
import numpy as np


def write_ply(path, vertices, triangles):
    faces = np.empty(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    normals = "".join(f"property float n{axis}\n" for axis in "xyz") if vertices.shape[1] == 6 else ""
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
              f"property float z\n{normals}element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(header.encode() + vertices.astype("<f4").tobytes() + faces.tobytes())


def sphere(rows, columns):
    """Unit sphere as a grid: vertices and triangles."""
    theta = np.linspace(0.02, np.pi - 0.02, rows + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, columns, endpoint=False)[None, :]
    points = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)), axis=2)
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    a, b = row * columns + column, row * columns + (column + 1) % columns
    c, d = a + columns, b + columns
    triangles = np.concatenate([np.stack(t, axis=2).reshape(-1, 3) for t in ((a, b, c), (b, d, c))])
    return points.reshape(-1, 3), triangles


def sculpture(path, rows=200):
    """Writes a sculpture of radius 1 around the origin; returns its number of triangles, some 330 thousand."""
    points, grid = sphere(rows, 2 * rows)
    vertices, triangles = [], []
    for i, (radius, waves) in enumerate([(1.0, 9.0), (0.8, 11.0), (0.6, 12.0), (0.4, 14.0)]):
        center = points[grid].mean(axis=1)
        x, y, z = (waves * center + 1.7 * i).T
        gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        triangles.append(grid[np.abs(gyroid) < 0.45 + 0.05 * i] + i * len(points))
        vertices.append(radius * points)
    triangles = np.concatenate(triangles)
    write_ply(path, np.concatenate(vertices), triangles)
    return len(triangles)


def crown(path, leaves=30000, seed=1):
    """Leaves of a few centimetres, in clusters within a ball of radius 1. Returns the number of triangles."""
    random = np.random.default_rng(seed)
    branches = random.normal(size=(260, 3))
    branches *= (random.random((260, 1)) ** 0.4 * 0.9) / np.linalg.norm(branches, axis=1, keepdims=True)
    center = branches[random.integers(0, 260, leaves)] + 0.06 * random.normal(size=(leaves, 3))
    u = random.normal(size=(leaves, 3))
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(u, random.normal(size=(leaves, 3)))
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    vertices = np.stack([center - 0.03 * u, center + 0.012 * v, center + 0.03 * u, center - 0.012 * v], axis=1)
    corners = 4 * np.arange(leaves)[:, None]
    triangles = np.concatenate([corners + [0, 1, 2], corners + [0, 2, 3]])
    write_ply(path, vertices.reshape(-1, 3), triangles)
    return len(triangles)


def water(path, n=96):
    """Waves over the floor of a box of 2 m, 0.1 m above it: 2 n^2 triangles with smooth normals. Returns how many."""
    x, z = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1), indexing="ij")
    waves = [(0.011, 9.0, 3.0, 0.3), (0.008, -4.0, 11.0, 1.9), (0.005, 15.0, -9.0, 0.8)]  # height, along x and z, phase
    y = 0.1 + sum(a * np.sin(kx * x + kz * z + p) for a, kx, kz, p in waves)
    slope = [sum(a * k[i] * np.cos(k[0] * x + k[1] * z + p) for a, *k, p in waves) for i in (0, 1)]
    normals = np.stack([-slope[0], np.ones_like(y), -slope[1]], axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    row, column = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    a = row * (n + 1) + column
    triangles = np.concatenate([np.stack(t, axis=2).reshape(-1, 3) for t in ((a, a + 1, a + n + 1), (a + 1, a + n + 2, a + n + 1))])
    vertices = np.concatenate([np.stack([x, y, z], axis=2), normals], axis=2).reshape(-1, 6)
    write_ply(path, vertices, triangles)
    return len(triangles)
