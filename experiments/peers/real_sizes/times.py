"""Rows of errors, and the time to an error: between measured pictures, or beyond them where that is known to hold.

Errors are those of figures/measure.py, against two references of other seeds.
"""
import measure
import numpy as np

TARGETS = (0.05, 0.025, 0.01)


def broken_pixels(a, b):
    """Where one reference is a thousand times brighter than the other one is anywhere: that is no noise to average over."""
    bright = lambda x: np.abs(x).max(axis=2)
    x, y = bright(a), bright(b)
    return (x > 1000 * y.max()) | (y > 1000 * x.max()) | ~np.isfinite(x) | ~np.isfinite(y)


class References:
    """Two references, the variances of their means, and the pixels that count."""

    def __init__(self, pictures, variances):
        broken = broken_pixels(*pictures)
        self.broken = int(broken.sum())
        clean = lambda arrays: [np.where(broken[..., np.newaxis], 0.0, x) for x in arrays]
        self.pictures, self.options = clean(pictures), {"mask": ~broken, "variances": clean(variances)}

    def series_error(self, pictures):
        return measure.series_error(pictures, self.pictures, **self.options)

    def noise(self):
        """That of one reference, from how the two differ."""
        return self.series_error(self.pictures)["noise"]


def judged(references, runs, pictures):
    """Adds to every run its error, bias and their standard errors; returns the systematic error of the two longest runs,
    with its standard error."""
    mean = np.mean(references.pictures, axis=0)
    for run, picture in zip(runs, pictures):
        found = references.series_error([picture])
        run["error"], run["error_se"] = found["error"], found["error_standard_error"]
        run["bias"], run["bias_se"] = found["bias"], found["bias_standard_error"]
        plain = measure.module().compare(picture, mean)
        run["mean"], run["mean_se"] = plain["mean_difference"], plain["mean_difference_standard_error"]
        run["non_finite"] = int(np.count_nonzero(~np.isfinite(picture)))
        run["samples_per_s"] = run["passes"] * picture.shape[0] * picture.shape[1] / run["wall_s"]
    if len(runs) < 2:
        return 0.0, float("nan")
    shared = references.series_error(pictures[-2:])
    return shared["systematic"], shared["systematic_standard_error"]


def noise_alone(runs, systematic):
    """Copies of the runs whose errors are without the systematic one: for other renderers, where it is the difference of
    two models, not an error."""
    return [{**run, "error": float(np.sqrt(max(0.0, run["error"]**2 - systematic[0]**2)))} for run in runs]


def variance_time(runs, systematic):
    """Relative variance times seconds of the last image, and its standard error [s]: the seconds to an error of 100 %, by
    which unbiased methods compare whatever their time. `systematic`, (value, standard error), is taken off."""
    last = runs[-1]
    variance = max(0.0, last["error"]**2 - systematic[0]**2)
    return variance * last["wall_s"], 2 * last["error"] * last["error_se"] * last["wall_s"]


def time_to(target, runs, seconds, unbiased=True):
    """(seconds, how): `measured` between two images on a line in logarithms, `below` where the first has less error;
    beyond the last image `by slope`: -1/2 for unbiased methods, for others that of the last two images, at most as steep,
    since what a filter smooths away falls more slowly than noise; (None, `bias`) where it is flatter than -1/20.

    `seconds`: wall_s or cpu_s.
    """
    points = sorted((run[seconds], run["error"]) for run in runs if run["error"] > 0)
    if not points:
        return None, "not measured"
    if points[0][1] <= target:
        return points[0][0], "below"
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e1 <= target < e0:
            return float(t0 * (t1 / t0)**(np.log(e0 / target) / np.log(e0 / e1))), "measured"
    steepness = 0.5
    if not unbiased:
        (t0, e0), (t1, e1) = points[-2:] if len(points) > 1 else (points[0], points[0])
        steepness = min(0.5, np.log(e0 / e1) / np.log(t1 / t0)) if t1 > t0 else 0.0
    if steepness < 0.05:
        return None, "bias"
    last, error = points[-1]
    return float(last * (error / target)**(1 / steepness)), "by slope"
