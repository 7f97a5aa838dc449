"""Error of a picture against two independent references, free of the noise of both; numpy alone.

As core/metrics/relative_error.h measures: with <a, b> the mean over channels of a b, r the mean of the references A and
B, w = 1 / (|r|^2 + (m / 10)^2), where |r|^2 is that of the neighbourhood (`weights`), and m^2 its median,

    norm         = sum w <A, B>                                                          (1)
    error^2      = sum w <X - A, X - B> / norm                                           (2)
    bias         = sum w (<A, X - B> + <B, X - A>) / 2 / norm                            (3)
    systematic^2 = sum w (<X - A, Y - B> + <X - B, Y - A>) / 2 / norm                    (4)

A and B are independent of each other and of X: the noise of the references has the mean 0 in all of them, and no
variance has to be subtracted. X and Y in (4) are two independent pictures by the same method: what they have in common
is no noise. Standard errors are jackknives over blocks of pixels: what changes the whole picture at once, such as a few
virtual point lights, they do not see.
"""
import numpy as np

BLOCKS = 20   # along each side of the picture
REACH = 2     # neighbours within 5 x 5 pixels


def dot(a, b):
    return (a * b).mean(axis=2)


def weights(reference, variance):
    """Of each pixel. |r|^2 is the mean of its neighbours' alone: a weight that knew of the pixel's own noise would make
    Eq. (2) too large by three halves of the square of both noises. Only a pixel that is brighter for certain, by three
    standard deviations, such as a lamp of its own, has its own |r|^2."""
    squares, (height, width) = dot(reference, reference), reference.shape[:2]
    total, count = np.zeros((height, width)), np.zeros((height, width))
    for dy in range(-REACH, REACH + 1):
        for dx in range(-REACH, REACH + 1):
            if dx == dy == 0:
                continue
            here = np.s_[max(0, -dy):height - max(0, dy), max(0, -dx):width - max(0, dx)]
            there = np.s_[max(0, dy):height + min(0, dy), max(0, dx):width + min(0, dx)]
            total[here] += squares[there]
            count[here] += 1
    certain = np.maximum(np.sqrt(squares) - 3.0 * np.sqrt(variance.mean(axis=2)), 0.0)
    level = np.maximum(total / count, certain**2)
    return 1.0 / (level + 0.01 * np.median(level[level > 0]))


def by_blocks(values):
    """Sums over BLOCKS x BLOCKS parts of the picture."""
    rows, columns = (np.linspace(0, n, min(BLOCKS, n) + 1).astype(int)[:-1] for n in values.shape)
    return np.add.reduceat(np.add.reduceat(values, rows, axis=0), columns, axis=1).ravel()


def ratio_and_error(numerator, denominator):
    """sum / sum, and its standard error by leaving out one block at a time."""
    n, left_out = len(numerator), (numerator.sum() - numerator) / (denominator.sum() - denominator)
    return numerator.sum() / denominator.sum(), np.sqrt((n - 1) / n * ((left_out - left_out.mean())**2).sum())


def broken_pixels(a, b):
    """Where one reference is a thousand times brighter than the other one is anywhere: that is no noise to average over."""
    bright = lambda x: np.abs(x).max(axis=2)
    x, y = bright(a), bright(b)
    return (x > 1000 * y.max()) | (y > 1000 * x.max()) | ~np.isfinite(x) | ~np.isfinite(y)


class Judge:
    def __init__(self, first, second, first_variance, second_variance):
        """References and the variances of their means, arrays [height, width, 3]."""
        self.a, self.b = first.astype(float), second.astype(float)
        broken = broken_pixels(self.a, self.b)
        self.broken = int(broken.sum())   # pixels that are left out of everything
        for values in (self.a, self.b, variance := 0.25 * (first_variance + second_variance)):
            values[broken] = 0.0
        self.w = np.where(broken, 0.0, weights(0.5 * (self.a + self.b), variance))
        self.norm = by_blocks(self.w * dot(self.a, self.b))

    def ratio(self, values):
        return ratio_and_error(by_blocks(self.w * values), self.norm)

    def squared_error(self, x):
        """Eq. (2) and its standard error; the estimate of a small error can be negative."""
        return self.ratio(dot(x - self.a, x - self.b))

    def bias(self, x):
        """Eq. (3) and its standard error."""
        return self.ratio(0.5 * (dot(self.a, x - self.b) + dot(self.b, x - self.a)))

    def mean_difference(self, x):
        """Of the mean radiance, relative to that of the references, without weights; and its standard error."""
        r = 0.5 * (self.a + self.b)
        there = self.w > 0
        return ratio_and_error(by_blocks((x - r).mean(axis=2) * there), by_blocks(r.mean(axis=2) * there))

    def squared_systematic(self, x, y):
        """Eq. (4) and its standard error."""
        return self.ratio(0.5 * (dot(x - self.a, y - self.b) + dot(x - self.b, y - self.a)))

    def reference_noise(self):
        """Of one reference, by the difference of both: sqrt(sum w |A - B|^2 / 2 / norm)."""
        return float(np.sqrt(max(0.0, self.ratio(0.5 * dot(self.a - self.b, self.a - self.b))[0])))


def root(squared, error):
    """(value, standard error) of a square to those of its root; below its own standard error the root is 0."""
    value = np.sqrt(max(squared, 0.0))
    return value, error / (2 * value) if squared > error else np.sqrt(error)
