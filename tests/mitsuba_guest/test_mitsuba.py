#!/usr/bin/env python3
"""mote's integrators as Mitsuba's: every one registered, the bits of the command, errors with names.

Usage: test_mitsuba.py MOTE SOURCE_DIR     LEFT OUT where `import mitsuba` does not work.
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

MOTE, SOURCE = sys.argv[1], Path(sys.argv[2])
try:
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
except ImportError:
    print("LEFT OUT: no Python package 'mitsuba' (PyPI)")
    sys.exit(0)
mi.set_log_level(mi.LogLevel.Error)
import numpy as np  # noqa: E402
sys.path.insert(0, str(SOURCE / "python"))
os.environ["MOTE_COMMAND"] = MOTE
import mote.mitsuba as guest  # noqa: E402


def scene_of(integrator, **more):
    look = mi.ScalarTransform4f().look_at(origin=[0.1, 1, 4], target=[0, 0.2, 0], up=[0, 1, 0])
    return {"type": "scene", "integrator": integrator,
            "sensor": {"type": "perspective", "fov": 41.7, "to_world": look,
                       "film": {"type": "hdrfilm", "width": 20, "height": 14, "rfilter": {"type": "box"}}},
            "ball": {"type": "sphere", "bsdf": {"type": "roughplastic", "alpha": 0.13,
                                                "diffuse_reflectance": {"type": "rgb", "value": [0.1, 0.37, 0.6]}}},
            "floor": {"type": "rectangle", "to_world": mi.ScalarTransform4f().rotate([1, 0, 0], -90).scale(5),
                      "bsdf": {"type": "diffuse"}},
            "sky": {"type": "constant", "radiance": 0.7}, **more}


def by_command(scene, passes, seed):
    with tempfile.TemporaryDirectory() as folder:
        guest.export(scene, f"{folder}/s.xml")
        subprocess.run([MOTE, "render", "s.xml", "--passes", str(passes), "--seed", str(seed), "--quiet", "-o", "a.exr"],
                       cwd=folder, check=True, stdout=subprocess.DEVNULL)
        return guest._channels(f"{folder}/a.exr")


class Guest(unittest.TestCase):
    def test_every_integrator_of_mote_is_registered(self):
        formats = subprocess.run([MOTE, "formats"], capture_output=True, text=True, check=True).stdout
        part = formats.split("\n## Integrators\n")[1].split("\n## ")[0]
        ours = set(re.findall(r"^### `(\w+)`", part, re.M))
        self.assertEqual({guest.RENAMED.get(t, t) for t in guest.TYPES}, ours)
        for kind in guest.TYPES:
            self.assertIn(kind, str(mi.load_dict({"type": kind})))

    def test_the_picture_has_the_bits_of_the_command(self):
        for integrator in ({"type": "mote_path", "max_depth": 3}, {"type": "mote_vpl", "paths": 30}):
            scene = mi.load_dict(scene_of(integrator))
            picture = np.array(mi.render(scene, spp=3, seed=5))
            command = by_command(scene, 3, 5)
            self.assertEqual(picture.shape, (14, 20, 3))
            self.assertGreater(picture.min(), 0.0)
            self.assertTrue(np.array_equal(picture, np.array(command[""])))
            self.assertFalse(np.array_equal(picture, np.array(by_command(scene, 3, 6)[""])))
            layers = scene.integrator().layers
            self.assertEqual(set(layers), set(command))
            self.assertIn("direct", layers)

    def test_objects_that_integrators_hold(self):
        plain = {"type": "mote_vpl", "paths": 30, "bound": 0.5}
        held = {**plain, "compensation": {"type": "screen_space", "steps": 1, "media": {"type": "none"}},
                "visibility": {"type": "imperfect_shadow_map", "points": 300}}
        scene = mi.load_dict(scene_of(held))
        picture = np.array(mi.render(scene, spp=2, seed=5))
        self.assertTrue(np.array_equal(picture, np.array(by_command(scene, 2, 5)[""])))
        self.assertIn("compensation_surface", scene.integrator().layers)
        self.assertFalse(np.array_equal(picture, np.array(mi.render(mi.load_dict(scene_of(plain)), spp=2, seed=5))))
        # A file of mote's, as it stands; a definition reaches what is held.
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "s.xml").write_text("""<scene version="3.0.0"><default name="steps" value="1"/>
                <integrator type="mote_vpl"><integer name="paths" value="30"/><float name="bound" value="0.5"/>
                <compensation type="screen_space"><integer name="steps" value="$steps"/>
                  <compensation name='media' type='none'/></compensation>
                <visibility type="traced"/></integrator>
                <sensor type="perspective"><transform name="to_world"><lookat origin="0, 1, 4" target="0, 0, 0"
                  up="0, 1, 0"/></transform><film type="hdrfilm"><integer name="width" value="20"/>
                <integer name="height" value="14"/></film></sensor><shape type="sphere"/>
                <shape type="rectangle"><transform name="to_world"><translate z="-1"/></transform></shape>
                <emitter type="constant"/></scene>""")
            loaded = mi.load_file(f"{folder}/s.xml", steps=2)
            picture = np.array(mi.render(loaded, spp=2))
            subprocess.run([MOTE, "render", "s.xml", "--passes", "2", "-D", "steps=2", "--quiet", "-o", "a.exr"], cwd=folder,
                           check=True, stdout=subprocess.DEVNULL)
            command = guest._channels(f"{folder}/a.exr")
            self.assertTrue(np.array_equal(picture, np.array(command[""])))
            self.assertIn("compensation_surface", command)
        with self.assertRaisesRegex(RuntimeError, "did you mean 'exact'"):
            mi.render(mi.load_dict(scene_of({**plain, "compensation": {"type": "exct"}})), spp=1)

    def test_the_picture_is_that_of_mitsuba(self):
        mine = np.array(mi.render(mi.load_dict(scene_of({"type": "mote_path"})), spp=256), dtype=float)
        theirs = np.array(mi.render(mi.load_dict(scene_of({"type": "path"})), spp=256), dtype=float)
        # Pixels are independent of each other in both, so the spread of their differences gives the standard error.
        difference = (mine - theirs).mean(axis=2)
        error = difference.std(ddof=1) / np.sqrt(difference.size)
        self.assertLess(abs(difference.mean()), 4.0 * error)

    def test_files_and_parameters(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "s.xml").write_text("""<scene version="3.0.0"><default name="kind" value="path"/>
                <integrator type="$kind"/><sensor type="perspective"><film type="hdrfilm">
                <integer name="width" value="9"/><integer name="height" value="7"/></film></sensor>
                <shape type="ply"><string name="filename" value="one.ply"/></shape>
                <emitter type="constant"/></scene>""")
            Path(folder, "one.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                               "property float y\nproperty float z\nelement face 1\n"
                                               "property list uchar int vertex_indices\nend_header\n"
                                               "-1 -1 4\n1 -1 4\n0 1 4\n3 0 1 2\n")
            scene = mi.load_file(f"{folder}/s.xml", kind="mote_volpath")
            self.assertEqual(np.array(mi.render(scene, spp=1)).shape, (7, 9, 3))
            guest.export(scene, f"{folder}/e.xml")
            self.assertIn(f"{folder}/one.ply", Path(folder, "e.xml").read_text())

    def test_unknown_things_are_named(self):
        for more, name in (({"extra": {"type": "sphere", "bsdf": {"type": "hair"}}}, "hair"),
                           ({"sky": {"type": "sunsky"}}, "sunsky")):
            with self.assertRaisesRegex(RuntimeError, name):
                mi.render(mi.load_dict(scene_of({"type": "mote_path"}, **more)), spp=1)
        with self.assertRaisesRegex(RuntimeError, "pathes"):
            mi.render(mi.load_dict(scene_of({"type": "mote_vpl", "pathes": 3})), spp=1)
        scene = mi.load_dict(scene_of({"type": "path"}))
        with self.assertRaisesRegex(RuntimeError, "one of mote's integrators"):
            mi.render(scene, integrator=mi.load_dict({"type": "mote_path"}), spp=1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
