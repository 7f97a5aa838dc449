"""What pictures of several seeds say: whether means agree with the reference's, and whether stated noise is the spread."""
import importlib
import math
import statistics
from dataclasses import dataclass

import numpy as np

from student import welch

FALSE_ALARMS = 0.01  # probability of any in a whole run, of means whose distribution is near normal
STAGES = (4, 8, 16, 32)
STAYS, STAYS_WHOLE = 0.01, 0.8  # a difference stays if its p with more passes is below, and what is left of it above: it was known to a tenth
CONTINUE = 0.1  # a pair whose smallest p is above this is not rendered again
# Spread between seeds over stated noise that is a finding, by the number of seeds: even if all pixels of a picture share one normal
# error, chi-square with n - 1 degrees of freedom exceeds (n - 1) ratio^2 with a probability below 3e-7. Below 2 it is none.
LIE = {4: 3.4, 8: 2.5, 16: 2.0}


def regions(picture):
    """Means of the whole picture and, where it has as many pixels, of its quarters."""
    height, width = picture.shape[:2]
    parts = [picture]
    if height >= 4 and width >= 4:
        y, x = height // 2, width // 2
        parts += [picture[:y, :x], picture[:y, x:], picture[y:, :x], picture[y:, x:]]
    return [float(np.mean(part, dtype=np.float64)) for part in parts]


@dataclass
class Difference:
    """Of the means of one region; p has Bonferroni's correction for the number of regions that were compared."""
    p: float
    t: float
    text: str
    relative: float
    absolute: float
    region: int


def compare_means(pictures, reference, bias, region=None):
    """The region that differs most, or a given one. The allowed bias is relative to the region or, since blur brings light from elsewhere, to the
    whole picture."""
    ours, theirs = ([regions(p) for p in series] for series in (pictures, reference))
    names = ("picture", "top left", "top right", "bottom left", "bottom right")
    rows, whole = [], abs(np.mean([means[0] for means in theirs]))
    for index, (name, a, b) in enumerate(zip(names, zip(*ours), zip(*theirs))):
        t, p, relative = welch(a, b, bias * max(abs(np.mean(b)), whole))
        text = f"{name}: mean {np.mean(a):.4g} against {np.mean(b):.4g} ({100 * relative:+.3g} %, t {t:.1f}, {len(a)} seeds)"
        rows.append(Difference(p, t, text, relative, np.mean(a) - np.mean(b), index))
    if region is not None:
        return rows[region]
    worst = min(rows, key=lambda row: (row.p, -row.t))
    worst.p = min(1.0, worst.p * len(rows))
    return worst


def threshold(stage, pairs):
    """Level of a stage of one pair."""
    return FALSE_ALARMS / pairs / 2 ** (stage + 1)


def noise_lies(pictures, noises):
    """(ratio, text) of the spread between seeds over the stated noise; None where one is not known."""
    known = [n for n in noises if n is not None and math.isfinite(n)]
    if len(known) < len(noises) or not any(np.any(p) for p in pictures):
        return None
    mote = importlib.import_module("mote")
    spread = mote.series_error(pictures, np.mean(pictures, axis=0, dtype=np.float64).astype(np.float32))["noise"]
    stated = math.sqrt(statistics.fmean(n * n for n in known))  # variances are what is estimated
    if not math.isfinite(spread) or spread < 1e-5:
        return None
    return spread / max(stated, 1e-9), f"stated noise {stated:.3g}, spread between {len(pictures)} seeds {spread:.3g}"
