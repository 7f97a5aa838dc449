"""Renders a sample of a submission's pictures again: is it repeatable, were its seeds chosen, are its times true?

  repetition   the same seed again. Where the picture is that of the manifest, it is nearer to the submitted one than a picture of
               another seed in more than half of the pixels (a test of signs); bits need not be equal on another machine.
  fresh seeds  seeds that are sampled now. If those of the submission were not chosen, all orders of their errors are equally
               probable: an exact test of rank sums, scene by scene (van Elteren 1960), one-sided.
  times        logarithms of the seconds here over those stated, less those of the yardstick: Welch's t, one-sided.
"""
from __future__ import annotations

import math
import secrets
import tempfile
from pathlib import Path
from typing import Dict, List, NamedTuple, Sequence

import numpy as np

from .._picture import Picture
from ..plot import student
from .adapter import Adapter, Job
from .checks import LEVEL, Finding, scale_of
from .references import References
from .submission import Entry, Submission
from .suite import Scene

SIMILAR = 0.05  # ratio of times by which machines and their load may differ without an accusation


class Sample(NamedTuple):
    """A scene and budget rendered again: the first submitted picture, the same seed again, and fresh ones with their seconds."""
    scene: Scene
    entries: List[Entry]
    submitted: List[np.ndarray]
    again: np.ndarray
    fresh: List[np.ndarray]
    seconds: List[float]


def render_sample(submission: Submission, scene: Scene, budget: float, adapter: Adapter) -> Sample:
    """Raises RuntimeError in the program's words."""
    entries = submission.at(scene.name, budget)
    threads, passes = submission.machine["threads"], entries[0].passes
    with tempfile.TemporaryDirectory(prefix="mote_") as folder:
        job = Job(scene, submission.settings, passes, [entries[0].seed], threads, Path(folder))
        read = lambda runs: [np.asarray(Picture.load(job.folder / r.file)["beauty"]) for r in runs]  # noqa: E731
        first = adapter.render(job)
        again = read(first)[0]
        # Consecutive, as adapters need them, and below 2^20: some programs count up to their seed.
        start = 100000 + secrets.randbelow(1 << 20)
        runs = adapter.render(job._replace(seeds=list(range(start, start + len(entries)))))
        return Sample(scene, entries, [submission.picture(e) for e in entries], again, read(runs),
                      [r.wall_s for r in first + runs])


def repetition(submitted: np.ndarray, again: np.ndarray, other: np.ndarray, references: References) -> float:
    """Probability of so many pixels in which the repetition is nearer than another seed, if both are alike: small where the
    picture was repeated."""
    if np.array_equal(submitted, again):
        return 0.0
    u = scale_of(references.mean())
    same, different = ((np.abs((submitted.astype(np.float64) - x) * u)).sum(axis=2) for x in (again, other))
    nearer, counted = int((same < different).sum()), int((same != different).sum())
    if not counted:
        return 1.0
    z = (nearer - 0.5 * counted) / math.sqrt(0.25 * counted)
    return 0.5 * math.erfc(z / math.sqrt(2.0))


def rank_sums(first: int, second: int) -> np.ndarray:
    """Probability of each sum of the ranks of `first` values among all, from 0: every order is equally probable."""
    counts = np.zeros((first + 1, 1 + (first + second) * (first + second + 1) // 2))
    counts[0, 0] = 1.0
    for value in range(1, first + second + 1):
        for n in range(first, 0, -1):
            counts[n, value:] += counts[n - 1, :counts.shape[1] - value]
    return counts[first] / counts[first].sum()


def fresh_seeds(pairs: Sequence[Sequence[Sequence[float]]]) -> float:
    """pairs: errors as submitted and by fresh seeds, scene by scene. Probability of so small ranks of the submitted ones."""
    total, sums = np.ones(1), 0
    for submitted, fresh in pairs:
        order = np.concatenate([submitted, fresh])
        sums += int(sum((order <= e).sum() for e in submitted))  # equal errors have the highest rank: no reason for suspicion
        total = np.convolve(total, rank_sums(len(submitted), len(fresh)))
    return float(total[:sums + 1].sum())


def times(stated: Sequence[float], here: Sequence[float], stick_there: Sequence[float], stick_here: Sequence[float]) -> Finding:
    """p is 0 where the seconds here, corrected for the machine, exceed those stated by more than chance and SIMILAR do."""
    log = lambda values: np.log(np.asarray(values, float))  # noqa: E731
    groups = [log(here), log(stated), log(stick_here), log(stick_there)]
    ratio = float(groups[0].mean() - groups[1].mean() - groups[2].mean() + groups[3].mean())
    variances = [g.var(ddof=1) / len(g) if len(g) > 1 else 0.0 for g in groups]
    error = math.sqrt(sum(variances))
    freedom = error ** 4 / max(sum(v * v / (len(g) - 1) for v, g in zip(variances, groups) if len(g) > 1), 1e-300)
    limit = math.log1p(SIMILAR) + student(max(1, int(freedom))) * error
    text = f"the same pictures take {math.exp(ratio):.2f} times the stated seconds (limit {math.exp(limit):.2f})"
    return Finding("", "times", 0.0 if ratio > limit else 1.0, text)


def judge(submission: Submission, samples: Sequence[Sample], references: Dict[str, References], stick_here: Sequence[float]
          ) -> List[Finding]:
    """What is wrong with the sample."""
    found, pairs, ratios = [], [], []
    for s in samples:
        of = references[s.scene.name]
        if submission.repeatable:
            p = repetition(s.submitted[0], s.again, s.fresh[0], of)
            if p > LEVEL / len(samples):
                found.append(Finding(s.scene.name, "repetition", p, f"{s.entries[0].file} is not what seed {s.entries[0].seed} with "
                                     f"{s.entries[0].passes} passes gives"))
        error = lambda picture: float(of.errors([picture])["squared_error"])  # noqa: E731
        pairs.append(([error(x) for x in s.submitted], [error(x) for x in s.fresh]))
        ratios.append((s.seconds, [e.wall_s for e in s.entries]))
    p = fresh_seeds(pairs)
    if p < LEVEL:
        found.append(Finding("", "fresh seeds", p, f"submitted pictures are better than those of fresh seeds (probability {p:.2g}): their "
                             "seeds were chosen"))
    # Seconds relative to the mean of each scene: scenes differ, and their means have all of the ratio.
    here = [t / float(np.exp(np.mean(np.log(stated)))) for seconds, stated in ratios for t in seconds]
    stated = [t / float(np.exp(np.mean(np.log(own)))) for _, own in ratios for t in own]
    slow = times(stated, here, submission.yardstick, stick_here)
    return found + ([slow] if slow.p == 0.0 else [])
