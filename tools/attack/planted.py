"""The worker with a fault planted in each of some integrators, for the test of the attack itself."""
import os
import signal
import time

import worker

SCALE, LIE = 1.1, 5.0


def scaled(picture):
    changed = picture.copy()
    changed["beauty"] = SCALE * picture["beauty"]
    return Stated(changed, picture.noise)


def with_nan(picture):
    changed = picture.copy()
    values = picture["beauty"].copy()
    values[0, 0] = float("nan")
    changed["beauty"] = values
    return Stated(changed, picture.noise)


class Stated:
    """A picture that states another noise."""

    def __init__(self, picture, noise):
        self.picture, self.noise = picture, noise

    def __getitem__(self, name):
        return self.picture[name]

    def __iter__(self):
        return iter(self.picture)


def crash(picture):
    os.kill(os.getpid(), signal.SIGSEGV)


def stay(picture):
    while True:
        time.process_time()


def fail(picture):
    raise RuntimeError("planted")


def fill_memory(picture):
    """A quarter of a gigabyte that is written to."""
    return Stated(picture, picture.noise) if b"x" * (1 << 28) else None


# What the attack must call each; the others must have no finding.
FAULTS = {"mote_bdpt": ("mean", scaled), "mote_vpl": ("signal", crash), "path": ("not_finite", with_nan),
          "mote_photon_map": ("time", stay), "mote_ray_lights": ("noise", lambda p: Stated(p, p.noise / LIE)),
          "mote_vsl": ("fault", fail), "mote_layers": ("memory", fill_memory)}


def draw(mote, scene, request, seed):
    picture = worker.render(mote, scene, request, seed)
    return FAULTS[request["integrator"]][1](picture) if request["integrator"] in FAULTS else picture


if __name__ == "__main__":
    worker.main(draw)
