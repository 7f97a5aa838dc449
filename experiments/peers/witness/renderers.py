"""Pictures of one scene by mote and by Mitsuba 3, as arrays [n, height, width, 3]."""
import subprocess
import time
from pathlib import Path

import mitsuba as mi
import numpy as np


def seed_list(n, offset=0):
    """Seeds that are far apart, so that no renderer's counters overlap."""
    return [int(s) for s in np.random.SeedSequence(2026).generate_state(n + offset)[offset:]]


def run_mote(mote, *arguments):
    """Raises RuntimeError with mote's own line when it fails."""
    done = subprocess.run([str(mote), *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip() or f"mote ended with {done.returncode}")
    return done.stdout


def export(mote, scene, defines, folder):
    """Writes the scene for Mitsuba; returns the list of what was dropped or changed."""
    options = [word for define in defines for word in ("-D", define)]
    run_mote(mote, "export", scene, "--to", "mitsuba3", "-o", folder, *options)
    return (Path(folder) / "dropped.txt").read_text().splitlines()


def read_exr(path):
    """The beauty, [height, width, 3]."""
    bitmap = mi.Bitmap(str(path))
    layers = dict(bitmap.split())
    beauty = layers.get("<root>", bitmap)
    return np.array(beauty.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False))


def mote_pictures(mote, scene, defines, passes, n, folder):
    options = [word for define in defines for word in ("-D", define)]
    picture, pictures = Path(folder) / "mote.exr", []
    for seed in seed_list(n):
        run_mote(mote, "render", scene, "-o", picture, "--seed", seed, "--passes", passes, "--quiet", *options)
        pictures.append(read_exr(picture))
    return np.stack(pictures)


def load_mitsuba(folder):
    return mi.load_file(str(Path(folder) / "scene.xml"))


def mitsuba_picture(scene, passes, seed):
    return np.array(mi.render(scene, spp=passes, seed=seed % 2**32))[..., :3]


def mitsuba_pictures(scene, passes, n):
    return np.stack([mitsuba_picture(scene, passes, seed) for seed in seed_list(n, offset=n)])


def seconds_of(action):
    start = time.monotonic()
    result = action()
    return result, time.monotonic() - start
