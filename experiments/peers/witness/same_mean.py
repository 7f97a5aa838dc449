"""Do two sets of independent pictures have the same expectation?

The rule of tests/support/render_statistics.cpp: two-sided z-tests of every block of pixels and channel, and of the
picture's mean, at a level of 1 % for all of them together (Sidak). Variances are measured over the pictures of a set,
which are independent; pixels of one picture need not be. Sets are smaller here than there, so that the variances
are uncertain themselves: Welch's t is brought to the z of the same probability by the formula of Wallace 1959.
"""
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

BLOCK = 4  # pixels


@dataclass
class Result:
    mean: tuple          # of both pictures, over pixels and channels
    difference: float    # (second - first) / first
    error: float         # its standard error
    worst_z: float
    critical_z: float
    z_map: np.ndarray    # [block_y, block_x, channel], signed: second minus first
    sensitive: bool      # the planted error would have been found, upwards and downwards

    @property
    def agrees(self):
        return self.worst_z <= self.critical_z


def block_means(pictures):
    """[n, height, width, 3] -> [n, blocks_y, blocks_x, 3]; the last blocks may be smaller."""
    n, height, width, channels = pictures.shape
    ys, xs = range(0, height, BLOCK), range(0, width, BLOCK)
    result = np.empty((n, len(ys), len(xs), channels))
    for i, y in enumerate(ys):
        for j, x in enumerate(xs):
            result[:, i, j] = pictures[:, y:y + BLOCK, x:x + BLOCK].mean(axis=(1, 2))
    return result


def _z(a, b):
    """Signed z of the difference of means; a and b hold one sample a row."""
    va, vb = a.var(axis=0, ddof=1) / len(a), b.var(axis=0, ddof=1) / len(b)
    mean_a, mean_b = a.mean(axis=0), b.mean(axis=0)
    floor = 1e-10 * (mean_a**2 + mean_b**2) + 1e-30  # blocks without noise must not fail by rounding
    t = (mean_b - mean_a) / np.sqrt(va + vb + floor)
    freedom = (va + vb + floor) ** 2 / (va**2 / (len(a) - 1) + vb**2 / (len(b) - 1) + floor**2)
    return np.sign(t) * (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t**2 / freedom))


def critical_value(tests, level=0.01):
    single = 1.0 - (1.0 - level) ** (1.0 / tests)
    return NormalDist().inv_cdf(1.0 - 0.5 * single)


def _worst(a_blocks, b_blocks, a_whole, b_whole):
    z_map, z_whole = _z(a_blocks, b_blocks), _z(a_whole, b_whole)
    return z_map, max(np.abs(z_map).max(), np.abs(z_whole).max())


def same_mean(first, second, planted=0.03):
    """Pictures as [n, height, width, 3]. Raises ValueError for values that are not finite: nothing is masked.

    The test is repeated with the second set made darker and brighter by the factor `planted`: where that is not
    found, agreement means nothing.
    """
    for name, pictures in (("first", first), ("second", second)):
        bad = np.count_nonzero(~np.isfinite(pictures))
        if bad:
            raise ValueError(f"{bad} values of the {name} set are not finite")
    a, b = block_means(first.astype(float)), block_means(second.astype(float))
    whole_a, whole_b = first.mean(axis=(1, 2), dtype=float), second.mean(axis=(1, 2), dtype=float)
    z_map, worst = _worst(a, b, whole_a, whole_b)
    critical = critical_value(z_map.size + 3)
    found = [_worst(a, b * s, whole_a, whole_b * s)[1] for s in (1.0 - planted, 1.0 + planted)]
    grey_a, grey_b = whole_a.mean(axis=1), whole_b.mean(axis=1)
    mean_a, mean_b = grey_a.mean(), grey_b.mean()
    error = np.sqrt(grey_a.var(ddof=1) / len(grey_a) + grey_b.var(ddof=1) / len(grey_b))
    return Result((mean_a, mean_b), mean_b / mean_a - 1.0, error / mean_a, worst, critical, z_map,
                  min(found) > critical)


def self_check():
    """The test must pass for equal pictures and fail for planted errors; raises AssertionError otherwise."""
    random = np.random.default_rng(7)
    truth = random.uniform(0.2, 1.0, (24, 24, 3))

    def draw(picture):
        return picture * random.gamma(20.0, 1.0 / 20.0, (64, 24, 24, 3))

    first, same = draw(truth), draw(truth)
    result = same_mean(first, same)
    assert result.agrees and result.sensitive, "two equal pictures do not agree"
    for factor in (0.97, 0.98, 1.02, 1.03):
        assert not same_mean(first, same * factor).agrees, f"a factor of {factor} was not found"
    stained = truth.copy()
    stained[8:12, 4:8, 1] *= 1.1
    assert not same_mean(first, draw(stained)).agrees, "one block of one channel 10 % too bright was not found"
    same[3, 2, 1, 0] = np.nan
    try:
        same_mean(first, same)
    except ValueError:
        return
    raise AssertionError("a NaN was masked")
