"""Checks of a submission against what a cheater would do, from the pictures alone. Each has a level that follows from its
statistic; together they accuse an honest submission once in a hundred.

A picture x that was rendered is independent of the noise of references a, b. One that was made of them contains it. With r(m) what is
left of x after its least-squares fit by the 5 x 5 pixels of a picture m around each, smoothed over 3 x 3 pixels:
  dependence    sum of <r((a + b) / 2), a - b> over pixels. Exchanging a and b in a pixel changes the sign of its term alone, and
                both are equally probable where x is independent. Finds what was made of one of the two.
  closeness     sum of <x - a, x - b>, whose mean is a square, so not below 0. Finds the mean of both.
  hidden pair   sum of <r(d), (a + b) / 2 - c> with two unpublished references: mean 0, and above it for what was
                made of a and b in whatever way, such as their mean, blurred.
A picture that is declared raw, of independent pixels, has noise without correlation between neighbours:
  whiteness     sum of <d, d'> over disjoint pairs of neighbours, d the difference of two seeds. Finds filters.
Sums of terms whose signs are random have p <= exp(-z^2 / 2), z^2 = (sum)^2 / sum of squares, whatever their size
(Hoeffding 1963, Theorem 2): bright pixels cannot make an honest picture suspect.
"""
from __future__ import annotations

import math
from typing import Callable, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .references import References
from .regions import neighbours
from .submission import Submission
from .suite import Scene

LEVEL = 0.01


class Finding(NamedTuple):
    """scene, check: what was tested. p: probability of a value as far off for an honest submission."""
    scene: str
    check: str
    p: float
    text: str


def scale_of(picture: np.ndarray) -> np.ndarray:
    """1 / radiance (height, width, 1), by the mean of 3 x 3 pixels, so that bright ones do not decide alone."""
    light = neighbours(np.abs(picture.astype(np.float64)).mean(axis=2)).mean(axis=0)
    return 1.0 / np.maximum(light + 0.1 * light.mean(), 1e-30)[..., None]


def _z(terms: np.ndarray) -> float:
    squares = float((terms * terms).sum())
    return float(terms.sum()) / math.sqrt(squares) if squares > 0 else 0.0


def _by_signs(z: float) -> float:
    """Bound of the probability of z or more by terms with random signs."""
    return math.exp(-0.5 * z * z) if z > 0 else 1.0


def _normal(z: float) -> float:
    """Probability of z or more of a sum of many terms of mean 0."""
    return 0.5 * math.erfc(z / math.sqrt(2.0))


def unexplained(picture: np.ndarray, by: np.ndarray, u: np.ndarray) -> np.ndarray:
    """What is left of a picture after its fit by the 5 x 5 pixels of another, times u, smoothed: without it the bias of a blur
    would hide the noise that a blur leaves."""
    basis = np.concatenate([neighbours(by, 2) * u, np.ones_like(by)[None] * u]).reshape(26, -1)
    target = (picture * u).ravel()
    # Normal equations: 26 unknowns, and a basis of radiances between 0 and about 1.
    moments = basis @ basis.T
    weights = np.linalg.lstsq(moments, basis @ target, rcond=1e-10)[0]
    return neighbours((target - weights @ basis).reshape(picture.shape)).mean(axis=0)


def dependence(picture: np.ndarray, references: References) -> float:
    a, b, u = references.first.astype(np.float64), references.second.astype(np.float64), scale_of(references.mean())
    terms = (unexplained(picture, 0.5 * (a + b), u) * (a - b) * u).sum(axis=2)
    return min(1.0, 2.0 * _by_signs(abs(_z(terms))))


def closeness(picture: np.ndarray, references: References) -> float:
    a, b, u = references.first.astype(np.float64), references.second.astype(np.float64), scale_of(references.mean())
    return _normal(-_z(((picture - a) * u * (picture - b) * u).sum(axis=2)))


def hidden_pair(picture: np.ndarray, references: References) -> Optional[float]:
    if references.hidden is None:
        return None
    m, hidden = references.mean().astype(np.float64), [h.astype(np.float64) for h in references.hidden]
    # The scale is that of d alone, so that it has no noise of m or c.
    tests = [(c, d, scale_of(d)) for c, d in (hidden, hidden[::-1])]
    return min(1.0, 2.0 * min(_normal(_z((unexplained(picture, d, u) * (m - c) * u).sum(axis=2))) for c, d, u in tests))


def whiteness(first: np.ndarray, second: np.ndarray, references: References) -> float:
    d = (first.astype(np.float64) - second) * scale_of(references.mean())
    across = (d[:, 0:-1:2] * d[:, 1::2]).sum(axis=2)
    down = (d[0:-1:2] * d[1::2]).sum(axis=2)
    return min(1.0, 2.0 * min(_by_signs(_z(across)), _by_signs(_z(down))))


_TEXTS = {
    "two seeds, one picture": "seeds {detail} have the same pixels at {budget:g} s",
    "dependence": "at {budget:g} s the picture contains the noise of one of the open references: it was made of it",
    "closeness": "at {budget:g} s the picture is nearer to both open references than their noise lets any other picture be",
    "hidden pair": "at {budget:g} s the picture shares noise with the open references: it was made of them",
    "whiteness": "declared raw with independent noise, but at {budget:g} s neighbouring pixels share theirs: it was filtered",
}


def _tests(pictures: Sequence[np.ndarray], references: References, filtered: bool) -> List[Tuple[str, Callable[[], Optional[float]]]]:
    mean = np.mean(np.asarray(pictures, np.float64), axis=0)
    tests: List[Tuple[str, Callable[[], Optional[float]]]] = [
        ("dependence", lambda: dependence(mean, references)), ("closeness", lambda: closeness(mean, references)),
        ("hidden pair", lambda: hidden_pair(mean, references))]
    if not filtered and len(pictures) > 1:
        tests.append(("whiteness", lambda: whiteness(pictures[0], pictures[1], references)))
    return tests


def check_scene(submission: Submission, scene: Scene, references: References) -> Tuple[List[Finding], List[Finding]]:
    """Findings that are certain, and those whose p is compared with the level of all tests together."""
    certain, tested = [], []
    filtered = submission.kind != "raw" or submission.noise != "independent"
    for budget in scene.budgets:
        entries = submission.at(scene.name, budget)
        pictures = [submission.picture(e) for e in entries]
        for i, second in enumerate(pictures):
            for k in range(i):
                if np.array_equal(pictures[k], second):
                    detail = f"{entries[k].seed} and {entries[i].seed}"
                    name = "two seeds, one picture"
                    certain.append(Finding(scene.name, name, 0.0, _TEXTS[name].format(budget=budget, detail=detail)))
        for name, test in _tests(pictures, references, filtered) if pictures else []:
            p = test()
            if p is not None:
                tested.append(Finding(scene.name, name, p, _TEXTS[name].format(budget=budget, detail="")))
    return certain, tested


def significant(tested: Sequence[Finding], level: float = LEVEL) -> List[Finding]:
    """Those that an honest submission has with a probability of `level`, all tests together (Sidak 1967)."""
    single = 1.0 - (1.0 - level) ** (1.0 / max(len(tested), 1))
    return [finding for finding in tested if finding.p < single]
