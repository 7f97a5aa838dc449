"""Bidirectional paths beside paths from the eye alone, in the scenes of both figures of Sun 2020 and some more: relative RMSE
against two independent references, processor time, rays."""
from pathlib import Path

import numpy as np
from measure import series_error
from occluders import water

SCENES = Path(__file__).resolve().parent / "scenes"
SUN = {"two spheres": "sun_two_spheres", "mirror wall": "sun_mirror_wall", "water caustic": "sun_water_caustic"}
OTHERS = {"lamp under a shade": "lamp_shade", "door ajar": "door_ajar", "glass in fog": "glass_in_fog"}
EYE, BOTH = "volpath", "mote_bdpt"


def scene_of(mote, name):
    """The scene's path, and the settings that it needs besides."""
    if name == "smoke room":
        return "smoke_room", {}
    file = {**SUN, **OTHERS}[name]
    if file != "sun_water_caustic":
        return SCENES / f"{file}.xml", {}
    mesh = mote.folder / "water.ply"
    water(mesh)
    return SCENES / f"{file}.xml", {"water": mesh.resolve()}


def render(mote, name, integrator, size, passes, seed, what, **settings):
    scene, needed = scene_of(mote, name)
    settings = {f"integrator.{k}": v for k, v in settings.items()}
    width, height = (size * 8 // 5, size) if name == "smoke room" else (size, size)
    return mote.render(scene, f"{what}_{integrator}_{name}".replace(" ", "_"),
                       {"integrator": integrator, "resx": width, "resy": height, **needed, **settings}, passes, seed=seed,
                       threads=1)


def usual_pixels(a, b):
    """All pixels but the brightest 0.1 % of the references: a caustic's grains, lamps."""
    light = ((a + b) / 2).clip(min=0).max(axis=2)
    return light <= np.quantile(light, 0.999)


def errors(mote, name, size, passes, seeds, references):
    """By integrator: squared relative RMSE and processor seconds of a picture, as means over seeds, with the square's standard
    error; and the pictures. `passes` and `seeds` of each; `references` passes of bidirectional paths, twice."""
    a, b = (render(mote, name, BOTH, size, references, seed, "reference")[""] for seed in (101, 102))
    found = {}
    for integrator in (EYE, BOTH):
        pictures = [render(mote, name, integrator, size, passes[integrator], s, "test") for s in seeds]
        e = [series_error([p[""]], [a, b], usual_pixels(a, b))["squared_error"] for p in pictures]
        found[integrator] = {"error": np.mean(e), "sigma": np.std(e, ddof=1) / len(e) ** 0.5,
                             "seconds": np.mean([p.cpu for p in pictures]), "pictures": pictures,
                             "rays": np.mean([sum(p.statistics["rays"].values()) for p in pictures]) / passes[integrator]}
    found["reference"] = 0.5 * (a + b)
    return found
