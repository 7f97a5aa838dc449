"""A prototype of an integrator: direct light, and ambient occlusion in place of indirect light.

    mote render scene.xml --plugin python_integrator.so --integrator python -D integrator.file=ambient_occlusion.py
"""
import numpy as np


class Integrator:
    distance, ambient = 0.5, 0.1

    def radiance(self, scene, origins, directions, seed):
        """Radiance (n, 3) along n rays. Random numbers come from `seed` alone, so that a pass has the same bits again."""
        random = np.random.default_rng(seed)
        hit = scene.first_hit(origins, directions)
        there = np.isfinite(hit.t)
        light = scene.light(hit.position, random.random((len(origins), 3)))
        cosine = np.clip((light.direction * hit.normal).sum(1), 0, None) * there
        seen = scene.visible(hit.position, light.direction, light.distance)
        direct = hit.albedo / np.pi * light.weight * (cosine * seen)[:, None]
        around = self.cosine_directions(hit.normal, random)
        open_sky = scene.visible(hit.position, around, np.full(len(origins), self.distance)) & there
        return hit.emitted + direct + hit.albedo * self.ambient * open_sky[:, None]

    @staticmethod
    def cosine_directions(normal, random):
        """A point on the unit sphere around the tip of the normal: its direction has the density cosine / pi."""
        z, angle = 1 - 2 * random.random(len(normal)), 2 * np.pi * random.random(len(normal))
        r = np.sqrt(1 - z * z)
        to = normal + np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)
        return to / np.maximum(np.linalg.norm(to, axis=1, keepdims=True), 1e-6)
