"""The light in scenes/corner.xml by quadrature, without mote.

Over directions the residual is bounded: with z the point seen from y in direction w,
    T_r L (y) = rho / pi int max(1 - b / G(y, z), 0) L(z) cos dw,
and T is the same with b = 0. Radiance is kept on grids whose lines crowd at both ends, as coordinate = 2 t^3 / (t^3 + (1 - t)^3)
with t even: beside an edge light is a smooth function of the cube root of the distance, and at the far ends, where the next
wall ends too, it drops within a distance as short as that to the edge.
"""
import numpy as np
from scipy.ndimage import map_coordinates, spline_filter

SIDE = 2.0  # of the walls [m]
LIGHT, INTENSITY = np.array([1.1, 1.2, 1.0]), 2.0
# Axis of the normal, and reflectance: floor, back wall, left wall.
WALLS = [(1, (0.7, 0.6, 0.5)), (2, (0.6, 0.6, 0.6)), (0, (0.5, 0.6, 0.7))]
AXES = [[k for k in range(3) if k != axis] for axis, _ in WALLS]


def directions(n):
    """n directions about the third axis, density cos / pi: a Fibonacci lattice."""
    u = (np.arange(n) + 0.5) / n
    phi = 2 * np.pi * np.arange(n) * 0.6180339887498949
    r = np.sqrt(u)
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u)], axis=1)


def even(coordinate):
    """The grid's parameter in [0, 1] of a coordinate in [0, SIDE]."""
    share = np.clip(coordinate / SIDE, 0, 1)
    a, b = np.cbrt(share), np.cbrt(1 - share)
    return a / (a + b)


class Grid:
    """A function on the three walls: values[wall, i, j, channel] at points(n)[i], points(n)[j]."""

    def __init__(self, values):
        self.values, self.n = values, values.shape[1] - 1
        self.splines = [[spline_filter(wall[..., channel], mode="mirror") for channel in range(3)] for wall in values]

    def __call__(self, wall, a, b):
        """At coordinates along the two axes of one wall: cubic splines in the even parameters."""
        place = np.stack([even(a) * self.n, even(b) * self.n])
        return np.stack([map_coordinates(spline, place, mode="mirror", prefilter=False) for spline in self.splines[wall]],
                        axis=-1)


def points(n):
    """Positions of the grid's lines [m], moved off the ends by less than single precision resolves."""
    t = np.arange(n + 1) / n
    return np.clip(SIDE * t ** 3 / (t ** 3 + (1 - t) ** 3), 1e-7, SIDE - 1e-7)


def transported(light, bound, n, count):
    """T_r of light on a grid of n intervals, with the residual of this bound [1/m^2]; bound 0: T itself."""
    local = directions(count)
    coordinate = points(n)
    result = np.zeros((3, n + 1, n + 1, 3))
    for wall, (axis, reflectance) in enumerate(WALLS):
        w = np.empty_like(local)
        w[:, axis], w[:, AXES[wall][0]], w[:, AXES[wall][1]] = local[:, 2], local[:, 0], local[:, 1]
        for i, a in enumerate(coordinate):
            p = np.zeros((n + 1, 3))
            p[:, AXES[wall][0]], p[:, AXES[wall][1]] = a, coordinate
            result[wall, i] = np.array(reflectance) * gathered(light, p, w, wall, bound)
    return Grid(result)


def gathered(light, p, w, own, bound):
    """Mean over directions w of the residual's share times the radiance that comes from there."""
    sums = np.zeros((len(p), 3))
    others = [k for k in range(3) if k != own]
    with np.errstate(divide="ignore"):
        # Towards which of the other two walls, and how far: only downwards along its axis.
        distance = np.stack([np.where(w[:, WALLS[k][0]] < 0, -p[:, None, WALLS[k][0]] / w[None, :, WALLS[k][0]], np.inf)
                             for k in others])
    nearest = np.argmin(distance, axis=0)
    cosine = w[:, WALLS[own][0]]
    for index, k in enumerate(others):
        r, c = np.nonzero((nearest == index) & np.isfinite(distance[index]))
        d = distance[index][r, c]
        a, b = (p[r, axis] + d * w[c, axis] for axis in AXES[k])
        inside = (a <= SIDE) & (b <= SIDE)
        r, c, d, a, b = r[inside], c[inside], d[inside], a[inside], b[inside]
        geometry = cosine[c] * -w[c, WALLS[k][0]] / d ** 2
        share = np.maximum(1 - bound / geometry, 0) if bound > 0 else np.ones_like(d)
        lit = share > 0
        value = share[lit, None] * light(k, a[lit], b[lit])
        for channel in range(3):
            sums[:, channel] += np.bincount(r[lit], value[:, channel], len(p))
    return sums / len(w)


def direct(wall, a, b):
    """T L_e."""
    axis, reflectance = WALLS[wall]
    d = np.empty(np.shape(a) + (3,))
    d[..., axis], d[..., AXES[wall][0]], d[..., AXES[wall][1]] = LIGHT[axis], LIGHT[AXES[wall][0]] - a, LIGHT[AXES[wall][1]] - b
    return np.array(reflectance) / np.pi * (INTENSITY * d[..., axis] / np.sum(d * d, axis=-1) ** 1.5)[..., None]


def reflected(n=16, count=1024, bounces=7):
    """R = sum_k T^k T L_e: all light that surfaces reflect. A bounce leaves a quarter of it, about."""
    light, total = direct, np.zeros((3, n + 1, n + 1, 3))
    for _ in range(bounces):
        light = transported(light, 0.0, n, count)
        total += light.values
    indirect = Grid(total)
    return lambda wall, a, b: direct(wall, a, b) + indirect(wall, a, b)


def picture(light, width, height, samples=4):
    """As the camera of the scene sees it, the mean over `samples` squared points a pixel: height * width * 3."""
    eye, target, up = np.array([3.6, 2.9, 3.6]), np.array([0.75, 0.7, 0.75]), np.array([0.0, 1.0, 0.0])
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up) / np.linalg.norm(np.cross(forward, up))
    above = np.cross(right, forward)
    tangent = np.tan(np.radians(48) / 2)  # of half the width
    place = lambda size: (np.arange(size * samples) + 0.5) / samples - 0.5 * size
    x, y = np.meshgrid(place(width) * 2 * tangent / width, place(height) * 2 * tangent / width)
    w = forward + x[..., None] * right - y[..., None] * above
    colour = np.zeros_like(w)
    best = np.full(x.shape, np.inf)
    for wall, (axis, _) in enumerate(WALLS):
        d = -eye[axis] / w[..., axis]
        p = eye + d[..., None] * w
        seen = (d > 0) & (d < best) & np.all((p > -1e-9) & (p <= SIDE), axis=2)
        colour[seen] = light(wall, p[seen][:, AXES[wall][0]], p[seen][:, AXES[wall][1]])
        best[seen] = d[seen]
    return colour.reshape(height, samples, width, samples, 3).mean(axis=(1, 3))
