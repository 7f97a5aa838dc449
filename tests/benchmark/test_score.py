#!/usr/bin/env python3
"""Scores of pictures in closed form: error, bias, regions, intervals, times, ranks. Usage: test_score.py [MOTE SOURCE]"""
import math
import sys
import unittest

from mote.benchmark.ranks import rank, ranks_of
from mote.benchmark.scoring import Interval, Score, measure, scores_of, shared_by_seeds, time_to
from mote.benchmark.submission import read_submission
from synthetic import (BUDGETS, HEIGHT, WIDTH, Path, load, noisy, np, references, suite_file, temporary, textured,
                       write_references, write_submission)


def score(seconds, error):
    return Score("s", 1.0, "all", Interval(error, error, error), Interval(0, 0, 0), (0, 0), (error**2,), seconds, 0)


class ScoreTest(unittest.TestCase):
    def test_closed_form(self):
        """A grey picture: the weights are equal, error^2 = bias^2 + noise^2 / passes, whatever noise the references have."""
        random = np.random.default_rng(1)
        truth, bias, noise = np.full((HEIGHT, WIDTH, 3), 0.5), -0.06, 0.4
        of = references(truth, 0.1, random)
        error, found, systematic, squares = measure([noisy((1 + bias) * truth, noise, random) for _ in range(4)], of)
        exact = math.hypot(bias, (1 + bias) * noise)
        self.assertTrue(error.low < exact < error.high, (error, exact))
        self.assertLess(error.high - error.low, 0.1 * exact)
        self.assertTrue(found.low < bias < found.high, found)
        self.assertLess(abs(systematic[0] - abs(bias)), 4 * systematic[1])
        self.assertEqual(len(squares), 4)

    def test_planted_errors(self):
        """The comparison above fails where the picture is 3 % off."""
        random = np.random.default_rng(2)
        truth = np.full((HEIGHT, WIDTH, 3), 0.5)
        _, found, _, _ = measure([noisy(1.03 * truth, 0.2, random) for _ in range(4)], references(truth, 0.05, random))
        self.assertGreater(found.low, 0.0)

    def test_coverage(self):
        """Intervals of 95 % hold the truth: no less often than 95 % less three standard deviations of 200 trials."""
        random, trials = np.random.default_rng(3), 200
        truth, bias, noise = np.full((24, 24, 3), 1.0), 0.05, 0.2
        exact, held, bias_held = math.hypot(bias, (1 + bias) * noise), 0, 0
        for _ in range(trials):
            error, found, _, _ = measure([noisy((1 + bias) * truth, noise, random) for _ in range(3)], references(truth, 0.1, random))
            held += error.low <= exact <= error.high
            bias_held += found.low <= bias <= found.high
        least = 0.95 * trials - 3 * math.sqrt(trials * 0.95 * 0.05)
        self.assertGreaterEqual(held, least)
        self.assertGreaterEqual(bias_held, least)

    def test_regions(self):
        """Noise in the shadow alone is found there alone."""
        random = np.random.default_rng(4)
        truth = np.full((HEIGHT, WIDTH, 3), 0.5)
        with temporary() as folder:
            folder = Path(folder)
            suite = suite_file(folder / "suite")
            write_references(folder, "plain", truth, 0.02, random)
            of = load(folder, suite.scene("plain"))
            self.assertEqual(list(of.regions), ["all", "edges", "shadows", "rest"])
            self.assertEqual(sum(int(m.sum()) for n, m in of.regions.items() if n != "all"), HEIGHT * WIDTH)
            self.assertEqual(int(of.regions["edges"].sum()), 2 * HEIGHT)
            left = np.arange(WIDTH) < WIDTH // 2 - 1  # means over 3 x 3 pixels light the column at the border

            def picture(scene, budget, seed):
                return np.where(left[None, :, None], noisy(truth, 0.3 / math.sqrt(budget), random), truth)

            write_submission(folder / "sub", suite, picture)
            submission = read_submission(folder / "sub", suite)
            found = {(s.budget, s.region): s for s in scores_of(submission, suite.scene("plain"), of)}
            for budget in BUDGETS:
                shadows, rest, whole = (found[budget, region] for region in ("shadows", "rest", "all"))
                self.assertTrue(shadows.error.low < 0.3 / math.sqrt(budget) < shadows.error.high, shadows)
                self.assertLess(rest.error.low, 0.01)
                self.assertLess(rest.error.high, 0.25 * shadows.error.value)
                self.assertAlmostEqual(whole.error.value, shadows.error.value / math.sqrt(2), delta=0.05 * shadows.error.value)

    def test_models(self):
        """A program whose pictures are all 8 % too bright is found; of 100 that are not, no more than 1 and four deviations are."""
        random, truth = np.random.default_rng(8), textured(32, 48)
        one = lambda factor: measure([noisy(factor * truth, 0.3, random) for _ in range(4)], references(truth, 0.1, random))  # noqa: E731
        for factor, most in ((1.08, None), (1.0, 1 + 4 * math.sqrt(0.99))):
            found = sum(shared_by_seeds(score(1.0, 0.1)._replace(systematic=one(factor)[2]), 1) for _ in range(100))
            self.assertTrue(found == 100 if most is None else found <= most, (factor, found))

    def test_late(self):
        with temporary() as folder:
            folder = Path(folder)
            suite = suite_file(folder / "suite")
            random, truth = np.random.default_rng(5), np.full((HEIGHT, WIDTH, 3), 0.5)
            write_references(folder, "plain", truth, 0.02, random)
            content = write_submission(folder / "sub", suite, lambda *_: noisy(truth, 0.1, random))
            content["pictures"][0]["wall_s"] = 1.01
            from synthetic import manifest
            manifest.write_manifest(folder / "sub", content)
            found = scores_of(read_submission(folder / "sub", suite), suite.scene("plain"), load(folder, suite.scene("plain")))
            self.assertTrue(all(s.failed == (s.budget == 1) for s in found))
            self.assertEqual(found[0].late, 1)

    def test_times(self):
        curve = [score(1.0, 0.1), score(4.0, 0.05)]
        self.assertEqual(time_to(0.05, curve, True), (4.0, "measured"))
        value, how = time_to(0.1 / math.sqrt(2), curve, True)
        self.assertAlmostEqual(value, 2.0)
        self.assertEqual(how, "measured")
        value, how = time_to(0.025, curve, True)
        self.assertAlmostEqual(value, 16.0)
        self.assertEqual(how, "extrapolated")
        self.assertEqual(time_to(0.2, curve, True), (1.0, "below"))
        self.assertEqual(time_to(0.025, curve, False)[1], "not reached")

    def test_ranks(self):
        self.assertEqual(ranks_of(np.array([3.0, 1.0, 1.0, np.inf])).tolist(), [3.0, 1.5, 1.5, 4.0])
        random = np.random.default_rng(6)
        scenes = [f"s{i}" for i in range(12)]
        better = {s: 1.0 + 0.01 * random.standard_normal(4) for s in scenes}
        worse = {s: 1.2 + 0.01 * random.standard_normal(4) for s in scenes}
        found = rank({"worse": worse, "better": better})
        self.assertEqual([r.method for r in found], ["better", "worse"])
        self.assertEqual((found[0].low, found[0].high), (1.0, 1.0))
        self.assertEqual(found[0].better["worse"], 1.0)

    def test_failure_shows(self):
        """A method that is best in eleven scenes and fails in the twelfth has the better mean rank, and the failure beside it."""
        scenes = [f"s{i}" for i in range(12)]
        found = rank({"brittle": {s: () if s == "s7" else (1.0, 1.1) for s in scenes}, "steady": {s: (2.0, 2.1) for s in scenes}})
        self.assertEqual(found[0].method, "brittle")
        self.assertEqual(found[0].failures, ("s7",))
        self.assertEqual(found[0].worst, ("s7", math.inf))
        self.assertGreater(found[0].high, found[0].rank)

    def test_no_difference(self):
        """Two methods that are equal on average: the interval holds 1.5 for at least 95 % less three deviations of 100 trials."""
        random, held = np.random.default_rng(7), 0
        for _ in range(100):
            errors = [{f"s{i}": 1.0 + 0.1 * random.standard_normal(4) for i in range(12)} for _ in range(2)]
            one = next(r for r in rank(dict(zip("ab", errors)), replicates=400) if r.method == "a")
            held += one.low <= 1.5 <= one.high
        self.assertGreaterEqual(held, 95 - 3 * math.sqrt(100 * 0.95 * 0.05))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
