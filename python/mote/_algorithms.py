"""Methods over arrays and functions of another renderer."""
from __future__ import annotations

import math
from typing import Callable, Optional, Sequence, Tuple

import numpy as np

from . import _mote

Radiance = Sequence[float]
_NO_ITEM = 0xffffffff


def _floats(values, shape) -> np.ndarray:
    return np.ascontiguousarray(np.broadcast_to(np.asarray(values, np.float32), shape))


class LightTree:
    """A hierarchy over lights, of which one is sampled for a receiver in proportion to what it may contribute, unoccluded (Estevez
    and Kulla 2018).

    lower, upper: (n, 3), boxes that hold the lights [m]. intensity: (n), along the normal, mean of the channels [W/sr], above 0.
    normal: (n, 3), unit, lights shine within a right angle of it; zero, the default: to all sides.
    """

    def __init__(self, lower, upper, intensity, normal=0.0) -> None:
        shape = (len(intensity), 3)
        self._tree = _mote.light_tree(_floats(lower, shape), _floats(upper, shape), _floats(normal, shape),
                                      [float(i) for i in intensity])

    def __len__(self) -> int:
        return len(self._tree)

    def sample(self, position: Sequence[float], u: float, normal: Sequence[float] = (0, 0, 0)) -> Tuple[int, float]:
        """Index and probability of a light, sampled by u in [0, 1). normal: unit, on the side from which light counts; zero: from
        all sides."""
        return self._tree.sample(tuple(position), tuple(normal), u)

    def probability(self, position: Sequence[float], light: int, normal: Sequence[float] = (0, 0, 0)) -> float:
        """Probability of sample() returning this light; over all lights they sum to 1."""
        return self._tree.probability(tuple(position), tuple(normal), light)


class HostLight:
    """Indirect light in a scene of another renderer, whose rays are its functions, by one set of light paths.

    first_hit(origin, direction, length): the closest surface on a segment as (distance [m], geometric normal, material), or None;
    three numbers each, the direction is unit. find_occluded(origins, directions, lengths), arrays of (n, 3) and (n): a bool array,
    True where a surface is on the segment; optional, in place of first_hit for shadow rays. Both are called one at a time, from
    threads. reflectance: (materials, 3), diffuse, both sides alike. lamps: (n, 3), positions [m] of lights that shine to all sides,
    and intensities: (n, 3) [W/sr]. bounds: lower and upper corner of a box that holds all surfaces and lamps [m]. scattering,
    absorption: three numbers, of fog that fills all space [1/m], and anisotropy its mean cosine.

    method: "vpl", "ray_lights" (in fog), "photon_map". paths: number of light paths. Of VPLs: selection, a type of the scene
    reference, such as "stochastic_lightcuts"; bound of the geometry term [1/m^2]; compensation_steps of the light that it takes,
    -1: exact. neighbours: photons of an estimate. len() is the number of VPLs, ray lights with VPLs, or photons. Raises mote.Error.
    """

    def __init__(self, first_hit: Callable, *, reflectance, lamps, intensities, bounds, find_occluded: Optional[Callable] = None,
                 scattering: Radiance = (0, 0, 0), absorption: Radiance = (0, 0, 0), anisotropy: float = 0.0, method: str = "vpl",
                 selection: str = "all", paths: int = 1024, bound: float = math.inf, compensation_steps: int = 0,
                 neighbours: int = 50, seed: int = 1) -> None:
        rows = lambda values: np.ascontiguousarray(np.asarray(values, np.float32).reshape(-1, 3))
        triple = lambda values: tuple(map(float, values))
        occluded = find_occluded and (lambda *segments: np.ascontiguousarray(find_occluded(*segments), bool))
        self._light = _mote.HostLight(first_hit, occluded, rows(reflectance), rows(lamps), rows(intensities),
                                      tuple(map(triple, bounds)), triple(scattering), triple(absorption), float(anisotropy), method,
                                      selection, paths, float(bound), compensation_steps, neighbours, seed)

    def __len__(self) -> int:
        return len(self._light)

    def reflected(self, position, normal, material=0) -> np.ndarray:
        """Radiance (n, 3) that receivers reflect along their normals [W/(m^2 sr)], without what reaches them straight from lamps.

        position, normal: (n, 3), material: (n). Receivers that follow each other should be near each other: sixteen are gathered
        for at a time.
        """
        position = np.ascontiguousarray(position, np.float32)
        materials = np.ascontiguousarray(np.broadcast_to(np.asarray(material, np.uint32), len(position)))
        return self._light.reflected(position, _floats(normal, position.shape), materials)


def epipolar(depth: np.ndarray, march: Callable[[float, float, float], Radiance], *, focal_length: float, lamp: Sequence[float],
             far_distance: float, centre: Optional[Sequence[float]] = None, lines: int = 512, samples: int = 16,
             tolerance: float = 0.05) -> Tuple[np.ndarray, int]:
    """Light that media scatter once towards a pinhole camera, (height, width, 3), from few rays along epipolar lines
    (docs/methods/epipolar.md); and the number of calls of `march`.

    depth: (height, width), along the camera's axis [m]; not above 0, or not finite: nothing is there, and the ray ends at
    far_distance [m]. march(x, y, distance): radiance, three numbers, scattered before the distance [m] into the ray through (x, y)
    [pixels; the middle of the first one is (0.5, 0.5)]. lamp: in camera space, x right, y down, z forward [m]. focal_length and
    centre (where the axis meets the picture, by default the middle) in pixels. lines: around the whole border. samples: of a line
    before it is refined. tolerance: of interpolation, relative. Raises ValueError.
    """
    depth = np.ascontiguousarray(depth, np.float32)
    height, width = depth.shape
    middle = tuple(map(float, centre)) if centre is not None else (width / 2, height / 2)
    return _mote.epipolar(depth, march, float(focal_length), tuple(map(float, lamp)), middle, float(far_distance), lines, samples,
                          float(tolerance))


def upsample(position: np.ndarray, normal: np.ndarray, shade: Callable[[int, int], Radiance], *, focal_length: float,
             spacing: int = 4, albedo: Optional[np.ndarray] = None) -> Tuple[np.ndarray, int]:
    """Light of all pixels, (height, width, 3), from those of a lattice by bilateral upsampling, and of those that no neighbour fits;
    and the number of calls of `shade`.

    position, normal: (height, width, 3), of first surfaces in the space of a pinhole camera at the origin [m]; normals are unit and
    towards the camera; positions that are not finite have no light. shade(x, y): radiance of the pixel in column x and row y, three
    numbers. spacing: one pixel of so many is shaded, in both directions. focal_length in pixels. albedo: what light is interpolated
    without; None: 1. Raises ValueError.
    """
    images = [None if image is None else np.ascontiguousarray(image, np.float32) for image in (position, normal, albedo)]
    return _mote.upsample(*images, float(focal_length), spacing, shade)


def count_visible(items: np.ndarray, rectangles: Sequence[Sequence[int]], count: Optional[int] = None) -> np.ndarray:
    """Number of pixels of an item in a rectangle, for each query (docs/methods/visibility.md).

    items: (height, width) integers, the item that a pixel shows; below 0: none. rectangles: (n, 5), rows of item, x0, y0, x1, y1:
    pixels x0 <= x < x1, y0 <= y < y1. count: number of items, by default as many as the picture or a query names.
    """
    items = np.asarray(items, np.int64)
    queries = np.ascontiguousarray(rectangles, np.int64).reshape(-1, 5)
    if count is None:
        count = 1 + max(int(items.max(initial=-1)), int(queries[:, 0].max(initial=-1)))
    if items.max(initial=-1) >= count:
        raise ValueError(f"the picture shows item {items.max()}, and there are {count}")
    return _mote.count_visible(np.where(items < 0, _NO_ITEM, items).astype(np.uint32), count, queries)


def micro_irradiance(corners: np.ndarray, triangles: np.ndarray, radiance: np.ndarray, position: np.ndarray, normal: np.ndarray, *,
                     points: int = 65536, side: int = 16, passes: int = 1, seed: int = 1) -> np.ndarray:
    """Irradiance (n, 3) of receivers [W/m^2] by micro-buffers (docs/methods/micro_rendering.md).

    corners: (m, 3) [m]; triangles: (k, 3), indices into them, counter-clockwise from the front, which alone sends light; radiance:
    (k, 3), of each front [W/(m^2 sr)]. position, normal: (n, 3), of the receivers. points: that represent the surfaces. side: texels
    of a buffer. passes: buffers of a receiver. Raises mote.Error.
    """
    rows = lambda values: np.ascontiguousarray(values, np.float32)
    return _mote.micro_irradiance(rows(corners), np.ascontiguousarray(triangles, np.uint32), rows(radiance), rows(position), rows(normal),
                                  points, side, passes, seed)


def bundle_links(corners: np.ndarray, triangles: np.ndarray, direction: Sequence[float], spacing: float,
                 offset: Sequence[float] = (0.5, 0.5)) -> Tuple[np.ndarray, np.ndarray]:
    """Pairs of triangles whose fronts see each other along a direction, (n, 2), and their areas perpendicular to it, (n) [m^2], by a
    global ray-bundle (docs/methods/ray_bundles.md): parallel rays, `spacing` [m] apart.

    corners: (m, 3) [m]; triangles: (k, 3), indices into them, counter-clockwise from the front. offset: of the rays, in [0, 1)^2 of
    the spacing; uniform, areas have no bias. Raises mote.Error.
    """
    return _mote.bundle_links(np.ascontiguousarray(corners, np.float32), np.ascontiguousarray(triangles, np.uint32),
                              tuple(map(float, direction)), float(spacing), tuple(map(float, offset)))
