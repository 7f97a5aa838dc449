"""Errors of a submission by scene, budget and region, all in the measure of mote.series_error()."""
from __future__ import annotations

import math
from statistics import NormalDist
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .._measuring import pixel_errors
from ..plot import student
from .references import References
from .submission import Submission
from .suite import Scene, Suite


class Interval(NamedTuple):
    value: float
    low: float
    high: float


class Score(NamedTuple):
    """error: relative RMSE of one picture; bias: signed, relative; both with the ends of an interval of 95 % confidence.
    systematic: relative RMSE that all seeds share, and its standard error. squares: squared errors by seed; empty
    where no picture is in time. late: pictures that took longer than the budget."""
    scene: str
    budget: float
    region: str
    error: Interval
    bias: Interval
    systematic: Tuple[float, float]
    squares: Tuple[float, ...]
    seconds: float
    late: int

    @property
    def failed(self) -> bool:
        return not self.squares


NONE = Interval(math.nan, math.nan, math.nan)


def _half_width(values: Sequence[float], of_references: float) -> float:
    """Half of an interval of 95 %: Student's t over seeds, and what the references and pixels leave, 1.96 times.

    `of_references` is taken from the scatter over pixels of the seeds' mean, whose own noise is in it, so that the
    interval is rather too long.
    """
    n = len(values)
    spread = student(n - 1) * float(np.std(values, ddof=1)) / math.sqrt(n) if n > 1 else 0.0
    return math.hypot(spread, 1.96 * of_references)


def _root(square: float) -> float:
    return math.sqrt(max(square, 0.0))


def measure(pictures: Sequence[np.ndarray], references: References, mask: Optional[np.ndarray] = None
            ) -> Tuple[Interval, Interval, Tuple[float, float], Tuple[float, ...]]:
    """Error, bias, systematic error and the squared errors by picture, in the pixels of a mask."""
    one = lambda picture: references.errors([picture], mask)  # noqa: E731
    each = [one(picture) for picture in pictures]
    squares = tuple(float(e["squared_error"]) for e in each)
    mean = np.mean(np.asarray(pictures, np.float64), axis=0).astype(np.float32)
    counted = pixel_errors(mean, references.first, references.second, mask=mask)
    counted = counted[mask] if mask is not None else counted.ravel()
    scatter = float(np.std(counted, ddof=1)) / math.sqrt(counted.size)
    square, half = float(np.mean(squares)), _half_width(squares, scatter)
    error = Interval(_root(square), _root(square - half), _root(square + half))
    biases = [float(e["bias"]) for e in each]
    wide = _half_width(biases, float(one(mean)["bias_standard_error"]))
    middle = float(np.mean(biases))
    shared = references.errors(list(pictures), mask)
    return (error, Interval(middle, middle - wide, middle + wide),
            (float(shared["systematic"]), float(shared["systematic_standard_error"])), squares)


def scores_of(submission: Submission, scene: Scene, references: References) -> List[Score]:
    """One score for each budget and region of a scene. Pictures that are late count as none: so does their budget."""
    scores = []
    for budget in scene.budgets:
        entries = submission.at(scene.name, budget)
        late = sum(e.wall_s > budget for e in entries)
        if not entries or late:
            scores += [Score(scene.name, budget, region, NONE, NONE, (math.nan, math.nan), (), math.nan, late)
                       for region in references.regions]
            continue
        pictures = [submission.picture(e) for e in entries]
        seconds = float(np.mean([e.wall_s for e in entries]))
        for region, mask in references.regions.items():
            scores.append(Score(scene.name, budget, region, *measure(pictures, references, None if region == "all" else mask),
                                seconds, 0))
    return scores


def time_to(target: float, scores: Sequence[Score], unbiased: bool) -> Tuple[float, str]:
    """Seconds to an error, and how they are known: "measured" between two budgets, "below" where the first picture has less,
    "extrapolated" by 1/sqrt(t) for unbiased methods; (NaN, "not reached") else."""
    points = sorted((s.seconds, s.error.value) for s in scores if not s.failed and s.error.value > 0)
    if not points:
        return math.nan, "not measured"
    if points[0][1] <= target:
        return points[0][0], "below"
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= target < e0:
            return t0 * (t1 / t0) ** (math.log(e0 / target) / math.log(e0 / e1)), "measured"
    last, error = points[-1]
    return (last * (error / target) ** 2, "extrapolated") if unbiased else (math.nan, "not reached")


def shared_by_seeds(score: Score, tests: int) -> bool:
    """Does the systematic error exceed chance, at a level of 1 % for so many tests together (Sidak 1967)? Of the squares, whose
    noise has mean 0: series_error() states the root, and how far the root of the upper end is from it."""
    value, error = score.systematic
    spread = (value + error) ** 2 - value ** 2
    return value ** 2 > NormalDist().inv_cdf(0.99 ** (1.0 / tests)) * spread


def model_difference(submission: Submission, scores: Sequence[Score], scene: str) -> float:
    """Systematic error of a raw, unbiased method where it exceeds chance: scene or models of its program differ, or it is biased,
    since time reduces noise and not this. 0 where it does not show, and where the noise of neighbouring pixels is not independent,
    as the standard error presumes."""
    if submission.kind != "raw" or submission.noise != "independent" or not submission.unbiased:
        return 0.0
    whole = [s for s in scores if s.region == "all" and not s.failed]
    own = [s for s in whole if s.scene == scene]
    if not own:
        return 0.0
    longest = max(own, key=lambda s: s.budget)
    return longest.systematic[0] if shared_by_seeds(longest, len({s.scene for s in whole})) else 0.0


def all_scores(submission: Submission, suite: Suite, references: Dict[str, References]) -> List[Score]:
    return [score for scene in suite.scenes if scene.name in references
            for score in scores_of(submission, scene, references[scene.name])]
