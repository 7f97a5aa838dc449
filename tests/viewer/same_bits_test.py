"""A picture saved from the viewer equals `mote render` with the printed command, by many methods, after a knob was
turned, the camera moved, and a light's or a medium's scale changed; another seed has other bits.

Usage: same_bits_test.py MOTE BOX SMOKE_ROOM SMOKE      (two scenes, and a grid)
"""
import os
import sys
import tempfile

from reproduced import same_bits
from view_program import Program

mote, box, smoke, grid = (os.path.abspath(path) for path in sys.argv[1:5])
SMALL = ["-D", "film.width=40", "-D", "film.height=24", "--passes", "3"]
VPL = ["--integrator", "mote_vpl", "-D", "integrator.paths=40", "-D", "integrator.selection="]
# scene, options, knob of the integrator and its value
CASES = [
    (box, ["--integrator", "path"], "max_depth", "5"),
    (box, ["--integrator", "mote_bdpt"], "max_depth", "5"),
    (box, ["--integrator", "mote_photon_map", "-D", "integrator.photon_paths=2000"], "neighbours", "20"),
    (box, [*VPL[:-1], "integrator.selection=lightcuts"], "paths", "60"),
    (box, [*VPL[:-1], "integrator.selection=matrix"], "bound", "1"),
    (box, ["--integrator", "mote_layers"], "max_depth", "6"),
    (smoke, ["--integrator", "volpath"], "max_depth", "8"),
    (smoke, ["--integrator", "mote_bdpt"], "max_depth", "4"),
    (smoke, ["--integrator", "mote_photon_map", "-D", "integrator.photon_paths=2000"], "single_scattering", "photons"),
    (smoke, [*VPL[:-1], "integrator.selection=resampling"], "scattering_points", "3"),
    (smoke, [*VPL[:-1], "integrator.selection=multidimensional_lightcuts"], "compensation", "none"),
    (smoke, ["--integrator", "mote_layers"], "max_depth", "6"),
]


def knob(scene, kind, name):
    """The path of a knob, with its value."""
    for group in scene["knobs"]["A"]:
        for k in group["knobs"]:
            if group["kind"] == kind and k["name"] in name:
                return k["path"], k["value"]
    raise KeyError(f"no knob {name} of a {kind}")


def half(value):
    return " ".join(str(0.5 * float(x)) for x in value.replace(",", " ").split())


def change(client, scene, name, value):
    """A knob of the integrator, the camera, and the power of a light or the density of a medium."""
    has_medium = any(group["kind"] == "medium" for group in scene["knobs"]["A"])
    path, before = knob(scene, "medium", ["scale"]) if has_medium else knob(scene, "emitter", ["radiance"])
    camera = scene["camera"]
    view = [camera["origin"][0] + 0.1, *camera["origin"][1:], *camera["target"], *camera["up"]]
    client.send({"type": "set", "define": {f"integrator.{name}": value}})
    client.send({"type": "camera", "view": view})
    client.send({"type": "set", "define": {path: half(before)}})
    return path


def saved_and_command(client):
    client.send({"type": "save", "picture": "A"})
    saved = client.wait_for(lambda h: h["type"] == "file")[1]
    client.send({"type": "reproduce", "picture": "A"})
    return saved, client.wait_for(lambda h: h["type"] == "reproduce")[0]["command"]


def check(holds, what):
    print(("ok      " if holds else "FAILED  ") + what, flush=True)
    if not holds:
        sys.exit(1)


def main():
    for scene_file, options, name, value in CASES:
        grids = ["-D", f"smoke={grid}"] if scene_file == smoke else []
        with Program(mote, scene_file, *SMALL, *grids, *options) as program, tempfile.TemporaryDirectory() as folder:
            client = program.connect()
            scene, _ = client.wait_for(lambda h: h["type"] == "scene")
            first, _ = client.frame(lambda h: h["finished"], 200)
            path = change(client, scene, name, value)
            client.frame(lambda h: h["finished"] and h["change"] >= first["change"] + 3, 200)
            saved, command = saved_and_command(client)
            check(same_bits(mote, command, saved, folder), f"{os.path.basename(scene_file)} {options[1]}: {' '.join(command.split()[3:])}")
            check(path in command and "sensor.to_world" in command and f"integrator.{name}={value}" in command, "with all changes")
            other = command.replace("--seed 0", "--seed 1")
            check(not same_bits(mote, other, saved, folder), "which another seed has not")
    print("passed")


main()
