"""Transforms for scenes of dictionaries, as Mitsuba's ScalarTransform4f has them."""
from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np


def _vector(value: Any) -> np.ndarray:
    return np.broadcast_to(np.asarray(value, dtype=float), (3,))


class Transform:
    """A 4 x 4 matrix that acts on column vectors.

    Each method returns this transform times another one, so that the last one written acts first, as in Mitsuba 3:
    Transform().translate([0, 1, 0]).rotate([0, 1, 0], 45) turns first and moves then. `@` composes.
    """

    def __init__(self, matrix: Optional[Any] = None) -> None:
        self.matrix = np.eye(4) if matrix is None else np.array(matrix, dtype=float).reshape(4, 4)

    def __matmul__(self, other: Any) -> Transform:
        return Transform(self.matrix @ (other.matrix if isinstance(other, Transform) else np.asarray(other, float)))

    def translate(self, v: Any) -> Transform:
        """By a vector [m]."""
        m = np.eye(4)
        m[:3, 3] = _vector(v)
        return self @ Transform(m)

    def scale(self, v: Any) -> Transform:
        """By a number, or one for each axis."""
        return self @ Transform(np.diag([*_vector(v), 1.0]))

    def rotate(self, axis: Any, angle: float) -> Transform:
        """Counter-clockwise about an axis, by degrees."""
        x, y, z = _vector(axis) / np.linalg.norm(axis)
        k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        radians = math.radians(angle)
        m = np.eye(4)
        m[:3, :3] += math.sin(radians) * k + (1 - math.cos(radians)) * (k @ k)  # Rodrigues
        return self @ Transform(m)

    def look_at(self, origin: Any, target: Any, up: Any = (0, 1, 0)) -> Transform:
        """A camera's frame: +Z towards the target, +X to the left of the picture."""
        origin, target, up = _vector(origin), _vector(target), _vector(up)
        forward = (target - origin) / np.linalg.norm(target - origin)
        left = np.cross(up / np.linalg.norm(up), forward)
        left /= np.linalg.norm(left)
        m = np.eye(4)
        m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = left, np.cross(forward, left), forward, origin
        return self @ Transform(m)

    def inverse(self) -> Transform:
        return Transform(np.linalg.inv(self.matrix))

    def __repr__(self) -> str:
        return f"Transform({self.matrix.tolist()})"


ScalarTransform4f = Transform
