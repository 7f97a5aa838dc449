#!/usr/bin/env python3
"""Cheats that rendering again finds: chosen seeds, misreported times. Usage: test_verify.py [MOTE SOURCE]"""
import sys
import unittest

from mote.benchmark import verify
from mote.benchmark.adapter import Adapter, Run
from mote.benchmark.submission import read_submission
from mote import Picture
from synthetic import Path, np, noisy, references, suite_file, temporary, textured, write_submission

SCENES = tuple(f"s{i}" for i in range(5))


class Formula(Adapter):
    """A renderer whose pictures follow from their seeds: noise that falls with the root of the passes."""

    def __init__(self, speed=1.0):
        self.random, self.speed = np.random.default_rng(99), speed

    def version(self):
        return "formula"

    @staticmethod
    def picture(scene, passes, seed):
        return noisy(textured(), 1.0 / np.sqrt(passes), np.random.default_rng([seed, passes, scene.number]))

    def render(self, job):
        runs = []
        for seed in job.seeds:
            Picture({"beauty": self.picture(job.scene, job.passes, seed)}).save(job.folder / f"{seed}.exr")
            wall = 0.9 * job.passes / 8 * self.speed * np.exp(0.02 * self.random.standard_normal())
            runs.append(Run(seed, f"{seed}.exr", job.passes, wall, wall, 0.0, 0.0))
        return runs


class VerifyTest(unittest.TestCase):
    def judged(self, picture_of, adapter=None, stick=(1.0, 1.01, 0.99, 1.0, 1.0), **changes):
        with temporary() as folder:
            suite = suite_file(Path(folder) / "suite", SCENES)
            random = np.random.default_rng(3)
            of = {name: references(textured(), 0.05, random) for name in SCENES}
            write_submission(Path(folder) / "sub", suite, lambda scene, budget, seed: picture_of(scene, int(8 * budget), seed, of), **changes)
            submission = read_submission(Path(folder) / "sub", suite)
            samples = [verify.render_sample(submission, scene, 1.0, adapter or Formula()) for scene in suite.scenes]
            return {f.check for f in verify.judge(submission, samples, of, stick)}

    @staticmethod
    def honest(scene, passes, seed, of):
        return Formula.picture(scene, passes, seed)

    @staticmethod
    def chosen(scene, passes, seed, of):
        """The best of 100 seeds, submitted as the one that is prescribed."""
        tried = [Formula.picture(scene, passes, 5000 + 100 * (seed % 1000) + i) for i in range(100)]
        return min(tried, key=lambda x: of[scene.name].errors([x])["squared_error"])

    def test_honest(self):
        self.assertEqual(self.judged(self.honest), set())

    def test_other_machine(self):
        """All is twice as slow here, the yardstick as well."""
        self.assertEqual(self.judged(self.honest, Formula(2.0), (2.0, 2.02, 1.98, 2.0, 2.0)), set())

    def test_other_bits(self):
        """The same noise with other rounding is a repetition."""
        slightly = lambda scene, passes, seed, of: Formula.picture(scene, passes, seed) * np.float32(1.00001)  # noqa: E731
        self.assertEqual(self.judged(slightly), set())

    def test_chosen_seed(self):
        found = self.judged(self.chosen)
        self.assertEqual(found, {"repetition", "fresh seeds"})

    def test_chosen_seed_without_repetition(self):
        self.assertEqual(self.judged(self.chosen, repeatable=False), {"fresh seeds"})

    def test_other_seed(self):
        self.assertEqual(self.judged(lambda scene, passes, seed, of: Formula.picture(scene, passes, seed + 1)), {"repetition"})

    def test_more_passes(self):
        """Twice the passes in the stated time."""
        found = self.judged(lambda scene, passes, seed, of: Formula.picture(scene, 2 * passes, seed), repeatable=False)
        self.assertEqual(found, {"fresh seeds"})

    def test_misreported_time(self):
        self.assertEqual(self.judged(self.honest, Formula(1.4)), {"times"})

    def test_misreported_time_of_a_faster_machine(self):
        """The same seconds here, on a machine that is twice as fast by the yardstick."""
        self.assertEqual(self.judged(self.honest, Formula(1.0), (0.5, 0.505, 0.495, 0.5, 0.5)), {"times"})


class StatisticTest(unittest.TestCase):
    def test_rank_sums(self):
        """All orders of two and two values: sums 3, 4, 5, 5, 6, 7."""
        exact = verify.rank_sums(2, 2)
        self.assertTrue(np.allclose(exact[3:8] * 6, [1, 1, 2, 1, 1]))
        self.assertAlmostEqual(float(exact.sum()), 1.0)

    def test_levels(self):
        """Of 400 honest samples no more have p < 0.05 than the mean and four deviations."""
        random = np.random.default_rng(5)
        p = [verify.fresh_seeds([(random.random(3), random.random(3)) for _ in range(4)]) for _ in range(400)]
        self.assertLessEqual(int(np.sum(np.array(p) < 0.05)), 20 + 4 * (400 * 0.05 * 0.95) ** 0.5)

    def test_equal_errors(self):
        self.assertAlmostEqual(verify.fresh_seeds([([1.0, 1.0], [1.0, 1.0])]), 1.0)

    def test_times(self):
        random, accused = np.random.default_rng(6), 0
        draw = lambda n, mean=1.0: mean * np.exp(0.03 * random.standard_normal(n))  # noqa: E731
        for _ in range(400):
            accused += verify.times(draw(8), draw(8), draw(5), draw(5)).p == 0.0
        self.assertLessEqual(accused, 0.025 * 400 + 4 * (400 * 0.025) ** 0.5)
        self.assertEqual(verify.times(draw(8), draw(8, 1.3), draw(5), draw(5)).p, 0.0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
