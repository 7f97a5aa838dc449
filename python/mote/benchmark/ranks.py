"""Ranks of methods over scenes, with intervals by the bootstrap over scenes and seeds.

A mean rank hides a failure; the worst scene and the number of failures stand beside it.
"""
from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence, Tuple

import numpy as np

REPLICATES = 2000


class Rank(NamedTuple):
    """rank: mean over scenes, 1 the least error; low, high: 95 % of the replicates. worst: the scene where the error is the
    largest multiple of the best method's, and that multiple; infinite where the method failed. failures: scenes
    without a picture in time. better: share of replicates in which the mean rank is less than that of each other method."""
    method: str
    rank: float
    low: float
    high: float
    worst: Tuple[str, float]
    failures: Tuple[str, ...]
    better: Dict[str, float]


def ranks_of(errors: np.ndarray) -> np.ndarray:
    """Ranks along the first axis, from 1; equal ones share the mean of their ranks. Infinite: none."""
    less = (errors[:, None] > errors[None]).sum(axis=1)
    equal = (errors[:, None] == errors[None]).sum(axis=1)
    return less + 0.5 * (equal + 1.0)


def _table(squares: Dict[str, Dict[str, Sequence[float]]], scenes: List[str]) -> List[List[np.ndarray]]:
    return [[np.asarray(of.get(scene, ()), float) for scene in scenes] for of in squares.values()]


def _mean_error(seeds: np.ndarray, random: np.random.Generator, replicates: int) -> np.ndarray:
    """Mean squared errors of resampled seeds; infinite for a method without a picture in time."""
    if not seeds.size:
        return np.full(replicates, np.inf)
    return seeds[random.integers(0, seeds.size, (replicates, seeds.size))].mean(axis=1)


def rank(squares: Dict[str, Dict[str, Sequence[float]]], replicates: int = REPLICATES, seed: int = 1) -> List[Rank]:
    """squares: by method and scene the squared errors of the seeds. Methods in order of their mean rank."""
    methods = list(squares)
    scenes = sorted({scene for of in squares.values() for scene in of})
    if not methods or not scenes:
        return []
    random, table = np.random.default_rng(seed), _table(squares, scenes)
    exact = np.array([[s.mean() if s.size else np.inf for s in row] for row in table])
    resampled = np.array([[_mean_error(s, random, replicates) for s in row] for row in table])  # method, scene, replicate
    by_scene = ranks_of(resampled)
    chosen = random.integers(0, len(scenes), (len(scenes), replicates))
    means = np.take_along_axis(by_scene, chosen[None], axis=1).mean(axis=1)
    plain, ratio = ranks_of(exact).mean(axis=1), _ratios(exact)
    found = []
    for i, method in enumerate(methods):
        worst = int(np.argmax(ratio[i]))
        low, high = np.percentile(means[i], [2.5, 97.5])
        found.append(Rank(method, float(plain[i]), float(low), float(high), (scenes[worst], float(ratio[i, worst])),
                          tuple(s for s, e in zip(scenes, exact[i]) if np.isinf(e)),
                          {other: float(np.mean(means[i] < means[k])) for k, other in enumerate(methods) if k != i}))
    return sorted(found, key=lambda r: r.rank)


def _ratios(squares: np.ndarray) -> np.ndarray:
    """Errors as multiples of the least one of each scene: 1 where all failed. Squares that noise made negative are the
    least."""
    errors = np.sqrt(np.maximum(squares, 1e-12))
    best = errors.min(axis=0)
    with np.errstate(invalid="ignore"):
        return np.where(np.isinf(best), 1.0, errors / best)
