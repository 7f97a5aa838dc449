"""Student's t for means of two series, and the levels of a sequential test.

A pair of series is tested at 4, 8, 16, ... seeds. Stage k may use the part 2^-(k+1) of the pair's level, so the probability of
any false alarm is at most the level, however the pairs are stopped in between (union bound). With N pairs each has 1/N of the
level of the whole run.
"""
import math
import statistics


def incomplete_beta(a, b, x):
    """Regularized, by Lentz's continued fraction."""
    if x <= 0.0 or x >= 1.0:
        return float(x >= 1.0)
    if x > (a + 1.0) / (a + b + 2.0):
        return 1.0 - incomplete_beta(b, a, 1.0 - x)
    front = math.exp(math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)) / a
    tiny, c, d = 1e-300, 1.0, 1.0 / max(1.0 - (a + b) * x / (a + 1.0), 1e-300)
    result = d
    for m in range(1, 400):
        for term in (m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                     -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))):
            d = 1.0 / (1.0 + term * d or tiny)
            c = 1.0 + term / c or tiny
            result *= c * d
        if abs(c * d - 1.0) < 1e-12:
            break
    return front * result


def two_sided_p(t, freedom):
    """Probability of at least |t| under Student's distribution."""
    return incomplete_beta(freedom / 2.0, 0.5, freedom / (freedom + t * t)) if math.isfinite(t) else 0.0


def mean_and_square_error(values):
    """The mean, and the square of its standard error."""
    return statistics.fmean(values), statistics.variance(values) / len(values)


ROUNDING = 1e-5  # relative: sums of float32 pictures


def welch(first, second, margin=0.0):
    """(t, p, relative difference) of the means of `first` against `second`; differences up to `margin` count as none."""
    (a, va), (b, vb) = mean_and_square_error(first), mean_and_square_error(second)
    difference = max(0.0, abs(a - b) - margin - ROUNDING * max(abs(a), abs(b)))
    relative = (a - b) / abs(b) if b else math.copysign(math.inf, a - b) if a != b else 0.0
    if difference == 0.0:
        return 0.0, 1.0, relative
    if va + vb == 0.0:
        return math.inf, 0.0, relative
    t = difference / math.sqrt(va + vb)
    freedom = (va + vb) ** 2 / (va ** 2 / (len(first) - 1) + vb ** 2 / (len(second) - 1))
    return t, two_sided_p(t, freedom), relative
