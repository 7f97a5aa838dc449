#!/usr/bin/env python3
"""Planted cheats that the pictures alone give away, and honest submissions that must not be accused. Usage: test_checks.py [MOTE SOURCE]"""
import sys
import unittest

from mote.benchmark import checks
from mote.benchmark.regions import neighbours
from mote.benchmark.submission import read_submission
from synthetic import HEIGHT, WIDTH, Path, load, noisy, np, references, suite_file, temporary, textured, write_references, write_submission

TRIALS = 300


def blurred(picture):
    return neighbours(np.asarray(picture, np.float64)).mean(axis=0).astype(np.float32)


def p_values(check, make, seed):
    """p of as many independent submissions: each with references of its own."""
    random = np.random.default_rng(seed)
    truth = textured(32, 48)
    return np.array([check(make(truth, of, random), of) for of in (references(truth, 0.1, random, hidden=True) for _ in range(TRIALS))])


class HonestTest(unittest.TestCase):
    """No check accuses more often than its level: counts of p < 0.05 among 300 are below the mean and four deviations."""
    MOST = 0.05 * TRIALS + 4 * (TRIALS * 0.05 * 0.95) ** 0.5

    def within(self, p):
        self.assertLessEqual(int((p < 0.05).sum()), self.MOST)

    def test_raw(self):
        for i, heavy in enumerate((False, True)):
            honest = lambda truth, of, random: noisy(truth, 0.5, random, heavy)  # noqa: E731
            for check in (checks.dependence, checks.closeness, checks.hidden_pair):
                self.within(p_values(check, honest, 10 + i))
            pair = lambda truth, of, random: (noisy(truth, 0.5, random, heavy), noisy(truth, 0.5, random, heavy))  # noqa: E731
            self.within(p_values(lambda two, of: checks.whiteness(*two, of), pair, 20 + i))

    def test_exact(self):
        """A picture without any noise is not accused of being too good."""
        for check in (checks.dependence, checks.closeness, checks.hidden_pair):
            self.within(p_values(check, lambda truth, of, random: truth.astype(np.float32), 30))

    def test_denoised(self):
        """Nor is one that a filter smoothed, bias and all."""
        smooth = lambda truth, of, random: blurred(noisy(truth, 0.3, random))  # noqa: E731
        for check in (checks.dependence, checks.closeness, checks.hidden_pair):
            self.within(p_values(check, smooth, 40))


class CheatTest(unittest.TestCase):
    """A check that is meant to find a cheat does so in all of 300 trials, at the level of 400 tests together."""
    LEVEL = 1 - 0.99 ** (1 / 400)

    def found(self, check, make, seed, share=1.0):
        p = p_values(check, make, seed)
        self.assertGreaterEqual((p < self.LEVEL).mean(), share, f"found {(p < self.LEVEL).mean():.3f}, worst p {p.max():.3g}")

    def test_reference(self):
        self.found(checks.dependence, lambda truth, of, random: of.first, 1)
        self.found(checks.dependence, lambda truth, of, random: noisy(of.second, 0.1, random), 2)

    def test_blurred_reference(self):
        self.found(checks.dependence, lambda truth, of, random: blurred(of.first), 3)

    def test_mean_of_references(self):
        self.found(checks.closeness, lambda truth, of, random: of.mean(), 4)

    def test_blurred_mean(self):
        """Symmetric in both open references: the hidden pair alone finds it."""
        mean = lambda truth, of, random: blurred(of.mean())  # noqa: E731
        self.assertLess((p_values(checks.dependence, mean, 5) < self.LEVEL).mean(), 0.05)
        truth, random = textured(), np.random.default_rng(5)
        for _ in range(20):
            of = references(truth, 0.1, random, hidden=True)
            self.assertLess(checks.hidden_pair(blurred(of.mean()), of), self.LEVEL)

    def test_denoised_as_raw(self):
        filtered = lambda truth, of, random: (blurred(noisy(truth, 0.3, random)), blurred(noisy(truth, 0.3, random)))  # noqa: E731
        self.found(lambda two, of: checks.whiteness(*two, of), filtered, 6)


class SubmissionTest(unittest.TestCase):
    """The same on folders, as `score` reads them."""

    def findings(self, picture_of, **changes):
        with temporary() as folder:
            folder, random, truth = Path(folder), np.random.default_rng(8), textured()
            suite = suite_file(folder / "suite", ("one", "two"))
            for scene in suite.scenes:
                write_references(folder, scene.name, truth, 0.1, random, hidden=True)
            of = {scene.name: load(folder, scene) for scene in suite.scenes}
            write_submission(folder / "sub", suite, lambda scene, budget, seed: picture_of(truth, of[scene.name], random), **changes)
            submission = read_submission(folder / "sub", suite)
            both = [checks.check_scene(submission, scene, of[scene.name]) for scene in suite.scenes]
            return [f for certain, _ in both for f in certain] + checks.significant([f for _, tested in both for f in tested])

    def test_honest(self):
        self.assertEqual(self.findings(lambda truth, of, random: noisy(truth, 0.4, random)), [])
        self.assertEqual(self.findings(lambda truth, of, random: blurred(noisy(truth, 0.4, random)), kind="denoised", noise="shared"), [])

    def test_blurred_reference(self):
        found = self.findings(lambda truth, of, random: noisy(blurred(of.first), 0.02, random))
        self.assertEqual({f.scene for f in found if f.check == "dependence"}, {"one", "two"})

    def test_blurred_mean(self):
        found = self.findings(lambda truth, of, random: noisy(blurred(of.mean()), 0.02, random), kind="denoised", noise="shared")
        self.assertIn("hidden pair", {f.check for f in found})

    def test_filtered(self):
        found = self.findings(lambda truth, of, random: blurred(noisy(truth, 0.4, random)))
        self.assertEqual({f.check for f in found}, {"whiteness"})

    def test_one_picture_for_all_seeds(self):
        found = self.findings(lambda truth, of, random: truth.astype(np.float32))
        self.assertEqual({f.check for f in found}, {"two seeds, one picture"})

    def test_size(self):
        self.assertEqual(textured().shape, (HEIGHT, WIDTH, 3))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
