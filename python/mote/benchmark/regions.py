"""Regions of a picture: edges, media, shadows, and the rest, from layers of the references.

Each pixel is in one region, the first that holds:
  edges    another object, a turned normal or another depth in the 3 x 3 pixels around it
  media    more than half of its light was scattered in media
  shadows  less than a tenth of its light from surfaces came from a light directly
Radiances are means of both references over 3 x 3 pixels, so that noise changes few pixels.
"""
from __future__ import annotations

from typing import Dict

import numpy as np

from .._picture import Picture

NAMES = ("all", "edges", "media", "shadows", "rest")
FEWEST = 64     # pixels: smaller regions are not judged
TURNED = 0.85   # cosine between normals, some 30 degrees
DEEPER = 0.1    # relative to the depth


def neighbours(values: np.ndarray, reach: int = 1) -> np.ndarray:
    """(9, height, width, ...): the 3 x 3 pixels around each (reach 2: 5 x 5), those of the border repeated."""
    pad = np.pad(values, [(reach, reach), (reach, reach)] + [(0, 0)] * (values.ndim - 2), mode="edge")
    height, width, size = *values.shape[:2], 2 * reach + 1
    return np.stack([pad[y:y + height, x:x + width] for y in range(size) for x in range(size)])


def _layer(pictures, name: str) -> np.ndarray:
    """Mean of a layer over channels, pictures and 3 x 3 pixels; 0 where no picture has it."""
    found = [np.asarray(p[name], np.float64) for p in pictures if name in p]
    if not found:
        return np.zeros((pictures[0].height, pictures[0].width))
    mean = np.mean(found, axis=0)
    return neighbours(mean.mean(axis=2) if mean.ndim == 3 else mean).mean(axis=0)


def edges_of(picture: Picture) -> np.ndarray:
    """Where the first hit changes; nowhere for a picture without the layers of --auxiliary."""
    found = np.zeros((picture.height, picture.width), bool)
    if "ObjectId" in picture:
        ids = neighbours(np.asarray(picture["ObjectId"]))
        found |= (ids != ids[4]).any(axis=0)
    if "Ns" in picture:
        normals = neighbours(np.asarray(picture["Ns"], np.float64))
        length = np.linalg.norm(normals, axis=3)
        # Pixels at silhouettes and beside holes have short means; only what hits throughout has a turn.
        cosine = (normals * normals[4]).sum(axis=3) / np.maximum(length * length[4], 1e-12)
        found |= ((cosine < TURNED) & (length > 0.5) & (length[4] > 0.5)).any(axis=0)
    if "Depth" in picture:
        depth = neighbours(np.asarray(picture["Depth"], np.float64))
        with np.errstate(invalid="ignore"):
            jump = np.abs(depth - depth[4]) > DEEPER * np.minimum(depth, depth[4])
        found |= (jump | (np.isinf(depth) != np.isinf(depth[4]))).any(axis=0)
    return found


def regions_of(first: Picture, second: Picture) -> Dict[str, np.ndarray]:
    """Masks (height, width) by name, in the order of NAMES; those of less than FEWEST pixels are left out."""
    pictures = [first, second]
    emission, direct, indirect = (_layer(pictures, name) for name in ("emission", "direct", "indirect"))
    scattered = _layer(pictures, "single_scattering") + _layer(pictures, "multiple_scattering")
    total = _layer(pictures, "beauty")
    edges = edges_of(first)
    media = ~edges & (scattered > 0.5 * total)
    surface = direct + indirect
    shadows = ~edges & ~media & (surface > emission) & (direct < 0.1 * surface)
    masks = {"all": np.ones_like(edges), "edges": edges, "media": media, "shadows": shadows, "rest": ~edges & ~media & ~shadows}
    return {name: masks[name] for name in NAMES if np.count_nonzero(masks[name]) >= FEWEST}
