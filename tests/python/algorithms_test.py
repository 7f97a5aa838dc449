#!/usr/bin/env python3
"""Methods over arrays of another renderer: light hierarchy, epipolar sampling, upsampling, visibility queries.

Usage: algorithms_test.py; PYTHONPATH holds the folder of the package.
"""
import math
import unittest

import mote
import numpy as np


def eye_rays(width, height, focal_length):
    """(height, width, 3), with z = 1."""
    y, x = np.mgrid[0:height, 0:width] + 0.5
    return np.stack([(x - width / 2) / focal_length, (y - height / 2) / focal_length, np.ones_like(x)], axis=2)


class LightTreeTest(unittest.TestCase):
    lights = [(float(i), 0, 2) for i in range(21)]
    tree = mote.LightTree(lights, lights, [1 + i % 3 for i in range(21)], [(0, 0, -(i % 2)) for i in range(21)])

    def test_probabilities(self):
        here, up = (3, 0.5, 0), (0, 0, 1)
        p = [self.tree.probability(here, i, up) for i in range(len(self.tree))]
        self.assertAlmostEqual(sum(p), 1, places=6)
        self.assertGreater(p[3], 5 * p[20])
        sampled = np.bincount([self.tree.sample(here, (i + 0.5) / 2000, up)[0] for i in range(2000)], minlength=21)
        for times, probability in zip(sampled, p):  # evenly spread u: off by their ends
            self.assertLessEqual(abs(times - 2000 * probability), 2)

    def test_wrong_arguments(self):
        for wrong in (lambda: mote.LightTree([], [], []), lambda: mote.LightTree([(0, 0, 0)], [(0, 0, 0)], [0]),
                      lambda: self.tree.sample((0, 0, 0), 1.0), lambda: self.tree.probability((0, 0, 0), 21)):
            self.assertRaises((ValueError, IndexError), wrong)


class EpipolarTest(unittest.TestCase):
    def test_fog_before_a_wall_with_a_step(self):
        width, height, focal_length, lamp = 80, 60, 80, np.array([0.4, 0.2, 2.5])
        depth = np.full((height, width), 4.0)
        depth[:, :50] = 6
        depth[:20, 50:] = math.inf
        calls = []

        def march(x, y, distance):
            calls.append((x, y))
            direction = np.array([(x - width / 2) / focal_length, (y - height / 2) / focal_length, 1])
            t = distance * (np.arange(50) + 0.5) / 50
            r = np.linalg.norm(t[:, None] * direction / np.linalg.norm(direction) - lamp, axis=1)
            light = 0.05 * float(np.sum(np.exp(-0.05 * (t + r)) / r**2)) * distance / 50
            return light, light, 0.0

        light, marched = mote.epipolar(depth, march, focal_length=focal_length, lamp=lamp, far_distance=10, lines=96)
        self.assertEqual((light.shape, marched), ((height, width, 3), len(calls)))
        self.assertLess(marched, width * height / 2)
        length = np.linalg.norm(eye_rays(width, height, focal_length), axis=2)
        ends = np.where(np.isfinite(depth), depth * length, 10)
        truth = np.array([[march(x + 0.5, y + 0.5, ends[y, x]) for x in range(width)] for y in range(height)])
        self.assertLess(np.abs(light - truth).sum(), 0.01 * truth.sum())

    def test_what_march_raises_is_raised(self):
        def broken(x, y, distance):
            raise KeyError("mine")
        with self.assertRaises(KeyError):
            mote.epipolar(np.ones((4, 4)), broken, focal_length=4, lamp=(0, 0, 1), far_distance=2)
        with self.assertRaises(ValueError):
            mote.epipolar(np.ones((4, 4)), lambda x, y, d: (0, 0, 0), focal_length=4, lamp=(0, 0, 0), far_distance=2)


class UpsamplingTest(unittest.TestCase):
    def test_two_planes(self):
        rays = eye_rays(48, 48, 48)
        floor = rays[..., 1] > 0.25
        position = rays * np.where(floor, 1 / np.where(floor, rays[..., 1], 1), 4)[..., None]
        normal = np.where(floor[..., None], (0, -1, 0), (0, 0, -1))
        truth = np.where(floor, 2.0, 1.0)
        light, shaded = mote.upsample(position, normal, lambda x, y: [truth[y, x]] * 3, focal_length=48, spacing=3)
        np.testing.assert_allclose(light, truth[..., None] * np.ones(3), atol=1e-3)
        self.assertLess(shaded, 48 * 48 / 4)
        with self.assertRaises(ValueError):
            mote.upsample(position, normal, lambda x, y: (0, 0, 0), focal_length=48, spacing=0)


class VisibilityTest(unittest.TestCase):
    items = np.array([[0, 0, 1], [-1, 0, 1]])

    def test_counts(self):
        counts = mote.count_visible(self.items, [(0, 0, 0, 3, 2), (0, 1, 0, 3, 2), (1, 2, 0, 9, 9), (2, 0, 0, 3, 2)])
        self.assertEqual(counts.tolist(), [3, 2, 2, 0])
        self.assertEqual(mote.count_visible(self.items, []).tolist(), [])

    def test_items_that_there_are_none_of(self):
        with self.assertRaises(ValueError):
            mote.count_visible(self.items, [(0, 0, 0, 3, 2)], count=1)
        with self.assertRaises(IndexError):
            mote.count_visible(self.items, [(2, 0, 0, 3, 2)], count=2)


class HostLightTest(unittest.TestCase):
    """A closed unit cube: walls receive power / (area (1 - reflectance)), of which power / area is direct."""

    @staticmethod
    def first_hit(origin, direction, length):
        ends = [((d > 0) - o) / d if d else math.inf for o, d in zip(origin, direction)]
        distance = min(ends)
        axis = ends.index(distance)
        return (distance, tuple(float(k == axis) for k in range(3)), 0) if 0 < distance < length else None

    def light(self, **settings):
        return mote.HostLight(settings.pop("first_hit", self.first_hit), reflectance=[(0.5, 0.5, 0.5)], lamps=[(0.4, 0.5, 0.6)],
                              intensities=[(2, 2, 2)], bounds=((0, 0, 0), (1, 1, 1)), **settings)

    def test_energy(self):
        rng, means = np.random.default_rng(7), []
        for seed in range(8):
            light = self.light(paths=128, seed=seed, find_occluded=lambda o, d, lengths: np.zeros(len(lengths), bool))
            axes, upper = np.arange(96) % 3, np.arange(96) // 3 % 2
            position, normal = rng.random((96, 3)), np.zeros((96, 3))
            position[np.arange(96), axes], normal[np.arange(96), axes] = upper, 1 - 2 * upper
            means.append(light.reflected(position, normal).mean() * math.pi / 0.5)
            self.assertGreater(len(light), 128)
        error = np.std(means, ddof=1) / len(means) ** 0.5
        expected = 4 * math.pi * 2 / 6
        self.assertLess(abs(np.mean(means) - expected), 5.4 * error)  # Student's t, 7 degrees of freedom: 0.1 %
        self.assertLess(error, 0.05 * expected)

    def test_errors(self):
        with self.assertRaisesRegex(mote.Error, "did you mean 'lightcuts'"):
            self.light(selection="lightcut")

        def broken(origin, direction, length):
            raise KeyError("mine")
        with self.assertRaises(KeyError):
            self.light(first_hit=broken)
        with self.assertRaises(ValueError):
            self.light(paths=16, find_occluded=lambda o, d, lengths: [True]).reflected([(0.5, 0.5, 0)], [(0, 0, 1)])


class TrianglesTest(unittest.TestCase):
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    triangles = [(0, 1, 2), (0, 2, 3), (4, 6, 5), (4, 7, 6)]

    def test_square_above_a_receiver(self):
        p = math.sqrt(1.25)
        closed_form = 4 * 0.5 / p * math.atan(0.5 / p)  # Howell's catalogue, B-3
        found = mote.micro_irradiance(self.corners, self.triangles, [(0, 0, 0)] * 2 + [(1, 2, 0)] * 2, [(0.5, 0.5, 0.01)], [(0, 0, 1)],
                                      points=8000, side=32, passes=4)
        self.assertTrue(0.99 * closed_form < found[0, 0] < 1.2 * closed_form)  # discs of points reach beyond the edge
        np.testing.assert_allclose(found[0], found[0, 0] * np.array([1, 2, 0]), rtol=1e-5)

    def test_squares_linked(self):
        pairs, areas = mote.bundle_links(self.corners, self.triangles, (0, 0, 1), 0.01)
        self.assertLess(abs(areas.sum() - 1), 0.04)
        self.assertTrue((pairs[:, 0] < 2).all() and (pairs[:, 1] >= 2).all())
        with self.assertRaisesRegex(mote.Error, "names corner 9"):
            mote.bundle_links(self.corners, [(0, 1, 9)], (0, 0, 1), 0.01)


if __name__ == "__main__":
    unittest.main()
