#!/usr/bin/env python3
"""The Python module: scenes, renders, layers, errors, interruption, arrays, and the bits of the command.

Usage: module_test.py MOTE (the command); PYTHONPATH holds the folder of the package.
"""
import ast
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import mote
import numpy as np

SCENE = """<scene version="3.0.0">
  <default name="paths" value="64"/>
  <integrator type="mote_vpl"><integer name="paths" value="$paths"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="50"/>
    <transform name="to_world"><lookat origin="0, 1, 4" target="0, 0.5, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="30"/></film>
  </sensor>
  <shape type="rectangle">
    <transform name="to_world"><scale value="3"/><rotate x="1" angle="-90"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.8, 0.8"/></bsdf>
  </shape>
  <shape type="sphere"><point name="center" x="0" y="0.5" z="0"/><float name="radius" value="0.5"/>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.3, 0.2"/></bsdf>
  </shape>
  <emitter type="point"><point name="position" x="1" y="3" z="2"/><rgb name="intensity" value="20, 18, 15"/></emitter>
</scene>
"""
T = mote.ScalarTransform4f
ROOT = Path(__file__).resolve().parents[2]


def dictionary():
    """Dictionary of the scene SCENE."""
    return {
        "type": "scene",
        "integrator": {"type": "mote_vpl", "paths": 64},
        "sensor": {"type": "perspective", "fov": 50,
                   "to_world": T().look_at(origin=[0, 1, 4], target=[0, 0.5, 0], up=[0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": 40, "height": 30}},
        "white": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.8, 0.8, 0.8]}},
        "floor": {"type": "rectangle", "to_world": T().rotate([1, 0, 0], -90).scale(3),
                  "bsdf": {"type": "ref", "id": "white"}},
        "ball": {"type": "sphere", "center": [0, 0.5, 0], "radius": 0.5,
                 "bsdf": {"type": "diffuse", "reflectance": np.array([0.7, 0.3, 0.2])}},
        "lamp": {"type": "point", "position": [1, 3, 2], "intensity": [20, 18, 15]},
    }


def same_bits(a, b):
    return set(a) == set(b) and all(np.array_equal(a[name].view(np.uint32), b[name].view(np.uint32)) for name in a)


class ManualPages(unittest.TestCase):
    def test_page_of_a_type(self):
        page = mote.manual("volpath")
        parameters = {p["name"]: p for p in page["parameters"]}
        self.assertEqual((page["category"], parameters["max_depth"]["default"]), ("integrator", "-1"))
        self.assertEqual((parameters["vpl_bound"]["lower"], parameters["vpl_bound"]["unit"]), (0.0, "1/m^2"))
        self.assertEqual(mote.manual("roughplastic", "bsdf")["parameters"][6]["choices"], ["beckmann", "ggx"])
        for p in page["parameters"]:
            self.assertIn(p["name"], str(page))

    def test_unknown_type(self):
        with self.assertRaisesRegex(mote.Error, "volpathh"):
            mote.manual("volpathh")


class ModuleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = Path(cls.folder.name) / "scene.xml"
        cls.path.write_text(SCENE, encoding="utf-8")
        cls.scene = mote.load(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def command(self, *options, name="picture.exr"):
        path = Path(self.folder.name) / name
        subprocess.run([MOTE, "render", self.path, "-o", path, "--quiet", *options], check=True, stdout=subprocess.DEVNULL)
        return mote.Picture.load(path)

    def test_bits_of_the_command(self):
        theirs = self.command("--passes", "3", "--seed", "7", "-D", "paths=32", "-D", "film.width=24", "--auxiliary",
                              "--denoise=bmfr")
        scene = mote.load(self.path, paths=32, define={"film.width": 24})
        for threads in (1, 2):
            ours = mote.render(scene, passes=3, seed=7, threads=threads, auxiliary=True, denoise="bmfr")
            self.assertTrue(same_bits(ours, theirs))
            self.assertGreater(len(ours), 10)
        self.assertEqual(ours.metadata["sceneHash"], theirs.metadata["sceneHash"])
        self.assertFalse(same_bits(mote.render(scene, passes=3, seed=8, auxiliary=True, denoise="bmfr"), theirs))

    def test_bits_of_tiny_numbers(self):
        """Bits of a scene with lights so far off that numbers become denormal: threads must treat them alike."""
        path = ROOT / "experiments" / "figures" / "scenes" / "sun_mirror_wall.xml"
        define = {"resx": 64, "resy": 64}
        for integrator in ("volpath", "mote_bdpt"):
            out = Path(self.folder.name) / "tiny.exr"
            subprocess.run([MOTE, "render", path, "-o", out, "--quiet", "--passes", "2", "--integrator", integrator,
                            "-D", "resx=64", "-D", "resy=64"], check=True, stdout=subprocess.DEVNULL)
            scene = mote.load(path, integrator=integrator, define=define)
            for threads in (1, 2):
                self.assertTrue(same_bits(mote.render(scene, passes=2, threads=threads), mote.Picture.load(out)))

    def test_layers(self):
        picture = mote.render(self.scene, passes=2, seed=1, auxiliary=True)
        self.assertEqual(picture["beauty"].shape, (30, 40, 3))
        self.assertEqual(picture["beauty"].dtype, np.float32)
        self.assertEqual(picture["Depth"].shape, (30, 40))
        parts = [picture[name] for name in ("emission", "direct", "indirect_bounded")]
        self.assertTrue(np.array_equal(parts[0] + parts[1] + parts[2], picture["beauty"]))
        self.assertEqual(picture.channels["N"], ["X", "Y", "Z"])
        self.assertEqual((picture.passes, picture.width, picture.height, picture.interrupted), (2, 40, 30, False))
        self.assertEqual(picture.statistics["passes"], 2)
        self.assertEqual(picture.metadata["seed"], "1")
        self.assertIn("indirect_bounded", repr(picture))
        self.assertTrue(picture._repr_png_().startswith(b"\x89PNG"))
        with self.assertRaisesRegex(KeyError, "did you mean 'beauty'"):
            picture["beuaty"]

    def test_files(self):
        picture = mote.render(self.scene, passes=2)
        path = Path(self.folder.name) / "saved.exr"
        picture.save(path)
        read = mote.Picture.load(path)
        self.assertEqual(set(read), set(picture))
        self.assertTrue(all(np.array_equal(read[name], picture[name]) for name in picture))
        with self.assertRaises(mote.Error):
            mote.Picture.load(Path(self.folder.name) / "nothing.exr")

    def test_plan(self):
        plan = self.scene.plan()
        self.assertEqual(plan["integrator"], "mote_vpl")
        self.assertTrue(all(set(entry) == {"topic", "choice", "reason", "cure"} for entry in plan["runs"]))
        said = subprocess.run([MOTE, "plan", self.path], check=True, capture_output=True, text=True).stdout
        self.assertEqual(str(plan), said)

    def test_errors(self):
        with self.assertRaises(mote.Error) as raised:
            mote.load_string("<scene version='3.0.0'>\n<shape type='sphre'/>\n<bsdf type='difuse'/></scene>", name="a.xml")
        self.assertEqual((raised.exception.file, raised.exception.line), ("a.xml", 2))
        self.assertRegex(str(raised.exception), "did you mean 'sphere'")
        self.assertEqual([e[2] for e in raised.exception.errors], [2, 3])
        with self.assertRaisesRegex(mote.Error, "did you mean 'width'"):
            mote.load(self.path, define={"film.widht": 3})
        with self.assertRaisesRegex(mote.Error, "did you mean 'mote_vpl'"):
            mote.load(self.path, integrator="mote_vlp")
        for wrong in ({"passes": 0}, {"noise": -1.0}, {"threads": -1}, {"resume": True}):
            with self.assertRaises(ValueError):
                mote.render(self.scene, **wrong)
        with self.assertRaisesRegex(mote.Error, "did you mean 'bmfr'"):
            mote.render(self.scene, denoise="bmrf")
        # The text is that of the command.
        bad = Path(self.folder.name) / "bad.xml"
        bad.write_text(SCENE.replace("rectangle", "rectangel"), encoding="utf-8")
        said = subprocess.run([MOTE, "plan", bad], capture_output=True, text=True, check=False).stderr
        with self.assertRaises(mote.Error) as raised:
            mote.load(bad)
        self.assertIn(str(raised.exception), said)

    def test_dictionary(self):
        ours = mote.render(mote.Scene(dictionary()), passes=2, seed=3)
        theirs = mote.render(mote.load_string(SCENE), passes=2, seed=3)
        self.assertTrue(same_bits(ours, theirs))
        for change, place, word in (({"ball": {"type": "sphere", "raduis": 1}}, "scene.ball", "radius"),
                                    ({"ball": {"type": "shpere"}}, "scene.ball", "sphere"),
                                    ({"floor": {"type": "rectangle", "bsdf": {"type": "ref", "id": "whte"}}},
                                     "scene.floor", "white")):
            with self.assertRaisesRegex(mote.Error, f"did you mean '{word}'") as raised:
                mote.Scene({**dictionary(), **change})
            self.assertEqual(raised.exception.file, place)
        with self.assertRaisesRegex(mote.Error, "scene.ball.radius"):
            mote.Scene({**dictionary(), "ball": {"type": "sphere", "radius": [1, 2]}})

    def test_arrays(self):
        """A rectangle of arrays is the rectangle; grids count."""
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
        mesh = {"type": "arraymesh", "positions": corners, "triangles": [[0, 1, 2], [2, 3, 0]],
                "normals": np.tile([0, 0, 1], (4, 1)), "uvs": [[0, 0], [1, 0], [1, 1], [0, 1]]}
        floor = {**dictionary()["floor"], **mesh}
        ours = mote.render(mote.Scene({**dictionary(), "floor": floor}), passes=2)
        self.assertTrue(same_bits(ours, mote.render(mote.Scene(dictionary()), passes=2)))

        def fog(density):
            box = {"type": "cube", "bsdf": {"type": "null"},
                   "interior": {"type": "heterogeneous", "albedo": 0.5,
                                "sigma_t": {"type": "arraygrid", "data": np.full((2, 3, 4), density)}}}
            scene = mote.Scene({**dictionary(), "integrator": {"type": "volpath"}, "box": box})
            return mote.render(scene, passes=1)["beauty"]
        self.assertFalse(np.array_equal(fog(0.5), fog(1.0)))
        with self.assertRaisesRegex(mote.Error, "floor.*triangle 0 refers to vertex 4"):
            mote.Scene({**dictionary(), "floor": {**floor, "triangles": [[0, 1, 4]]}})
        with self.assertRaises(ValueError):
            mote.Scene({**dictionary(), "floor": {**floor, "positions": corners[:, :2]}})

    def test_progress_and_callback(self):
        reported, shown = [], []
        main = threading.get_ident()

        def progress(p):
            self.assertEqual(threading.get_ident(), main)
            reported.append(p["passes"])
        picture = mote.render(self.scene, seconds=0.4, progress=progress, callback=lambda p: shown.append(p["beauty"]))
        self.assertEqual(reported, sorted(reported))
        self.assertEqual(reported[-1], picture.passes)
        self.assertTrue(shown and shown[0].shape == (30, 40, 3) and np.isfinite(shown[0]).all())
        stopped = mote.render(self.scene, passes=1 << 29, progress=lambda p: p["passes"] < 3)
        self.assertTrue(stopped.interrupted and stopped.passes >= 3)

        def fails(_):
            raise RuntimeError("of a callback")
        with self.assertRaisesRegex(RuntimeError, "of a callback") as raised:
            mote.render(self.scene, passes=1 << 29, progress=fails)
        self.assertGreater(raised.exception.picture.passes, 0)

    def test_files_of_others(self):
        """A checkpoint replaces and removes nothing but its own."""
        precious = Path(self.folder.name) / "precious"
        precious.write_text("a diary")
        with self.assertRaisesRegex(mote.Error, "precious"):
            mote.render(self.scene, passes=1, checkpoint=precious)
        self.assertEqual(precious.read_text(), "a diary")
        empty = Path(self.folder.name) / "empty"
        empty.mkdir()
        with self.assertRaisesRegex(mote.Error, "empty"):
            mote.render(self.scene, passes=1, checkpoint=empty)
        self.assertTrue(empty.is_dir())
        with self.assertRaisesRegex(mote.Error, "/dev/null"):
            mote.render(self.scene, passes=1, checkpoint="/dev/null")

    def test_bystanders(self):
        """Beside what is named nothing is written or removed, whatever it is called."""
        folder = Path(self.folder.name) / "bystanders"
        folder.mkdir()
        named = {"c", "p.exr"}
        names = {base + ending for base in ("c", "p", "p.exr") for ending in
                 ("", ".exr", ".png", ".part", ".1-0.part", ".checkpoint", ".json", ".film", "_denoised.exr")} - named
        for name in names:
            (folder / name).write_text(f"this is {name}")
        stopped = mote.render(self.scene, passes=1 << 29, checkpoint=folder / "c", checkpoint_every=0.0,
                              progress=lambda p: p["passes"] < 2)
        self.assertTrue((folder / "c").exists())
        picture = mote.render(self.scene, passes=stopped.passes + 1, checkpoint=folder / "c", resume=True, auxiliary=False)
        for _ in range(2):
            mote.denoise(picture).save(folder / "p.exr")
        self.assertEqual({p.name for p in folder.iterdir()}, names | {"p.exr"})
        for name in names:
            self.assertEqual((folder / name).read_text(), f"this is {name}")

    def test_arguments(self):
        picture = mote.Picture({"beauty": np.ones((2, 3, 3))})
        with self.assertRaises(ValueError):
            picture["beauty"][0, 0] = 2
        picture["beauty"] = picture["beauty"] * 2
        self.assertTrue((picture["beauty"] == 2).all())
        with self.assertRaises(TypeError):
            picture.save(None)
        with self.assertRaises(ValueError):
            picture.save(str(Path(self.folder.name) / "a\0b.exr"))
        with self.assertRaises(ValueError):
            mote.load("scene\0.xml")
        with self.assertRaisesRegex(mote.Error, "p.jpg"):
            picture.save(Path(self.folder.name) / "p.jpg")
        self.assertFalse((Path(self.folder.name) / "p.jpg").exists())
        for every in (float("nan"), -1.0, float("inf")):
            with self.assertRaises(ValueError):
                mote.render(self.scene, passes=1, checkpoint_every=every)
        with self.assertRaisesRegex(ValueError, "fewer features"):
            list(mote.denoise_sequence([np.ones((4, 4, 3))], []))
        scene = dictionary()
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
        for triangles in ([[0, 1, 1 << 32]], [[0, 1, -1]], [[0, 1, 2.9]]):
            scene["mesh"] = {"type": "arraymesh", "positions": corners, "triangles": np.array(triangles)}
            with self.assertRaisesRegex(mote.Error, "triangles"):
                mote.Scene(scene)

    def test_oidn_of_this_interpreter(self):
        """The package pyoidn is that of the running interpreter, which need not be the python3 of the path."""
        library = "libOpenImageDenoise.so.2"
        site = Path(self.folder.name) / "site"
        (site / "pyoidn" / "oidn" / "lib").mkdir(parents=True)
        (site / "pyoidn" / "__init__.py").write_text("raise ImportError('found, not imported')")
        shutil.copy(Path(MOTE).parent / "stand_ins" / library, site / "pyoidn" / "oidn" / "lib" / library)
        picture = mote.render(self.scene, passes=1)
        before = {name: os.environ.pop(name, None) for name in ("MOTE_OIDN", "MOTE_PYTHON", "PYTHONPATH")}
        os.environ["MOTE_PYTHON"] = "/bin/false"
        sys.path.insert(0, str(site))
        try:
            for denoised in (mote.denoise(picture, "oidn"), mote.render(self.scene, passes=1, denoise="oidn")):
                self.assertIn("OpenImageDenoise 9.8.7", denoised.metadata["denoised"])
        finally:
            sys.path.remove(str(site))
            os.environ.pop("MOTE_PYTHON")
            os.environ.update({name: value for name, value in before.items() if value is not None})

    def test_memory(self):
        """What does not fit is a MemoryError before the first pass, with what would."""
        limits = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, limits[1]))
        try:
            scene = mote.load(self.path, integrator="path", define={"film.width": 16384, "film.height": 16384})
            begin = time.monotonic()
            with self.assertRaisesRegex(MemoryError, "film of 16384 x 16384 pixels .* at most [0-9]+ x [0-9]+ pixels"):
                mote.render(scene, passes=1, auxiliary=True)
            self.assertLess(time.monotonic() - begin, 5.0)
            floor = {"type": "arraygrid", "data": np.broadcast_to(np.float32(1), (1, 1, 2_000_000_000))}
            with self.assertRaisesRegex(MemoryError, "grid"):
                mote.Scene({**dictionary(), "box": {"type": "cube", "interior": {"type": "heterogeneous",
                                                                                 "sigma_t": floor}}})
        finally:
            resource.setrlimit(resource.RLIMIT_AS, limits)

    def test_interrupt_and_resume(self):
        checkpoint = Path(self.folder.name) / "render.checkpoint"
        begin = []

        def press():
            begin.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)
        timer = threading.Timer(0.3, press)
        timer.start()
        with self.assertRaises(KeyboardInterrupt) as raised:
            mote.render(self.scene, passes=1 << 29, seed=5, checkpoint=checkpoint)
        self.assertLess(time.monotonic() - begin[0], 2.0)
        timer.join()
        partial = raised.exception.picture
        self.assertTrue(partial.interrupted and partial.passes > 0)
        whole = mote.render(self.scene, passes=partial.passes + 2, seed=5, checkpoint=checkpoint, resume=True)
        self.assertEqual(whole.statistics["resumed_at"], partial.passes)
        self.assertTrue(same_bits(whole, mote.render(self.scene, passes=partial.passes + 2, seed=5)))
        self.assertFalse(checkpoint.exists())

    def test_threads(self):
        """Two renders at once, and the interpreter continues meanwhile."""
        pictures, ticks = {}, 0
        threads = [threading.Thread(target=lambda i=i: pictures.update({i: mote.render(self.scene, passes=20, seed=2)}))
                   for i in range(2)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            ticks += 1
            time.sleep(0.001)
        self.assertGreater(ticks, 2)
        self.assertTrue(same_bits(pictures[0], pictures[1]))

    def test_measuring(self):
        picture = self.command("--passes", "4", "--seed", "1", name="a.exr")
        reference = self.command("--passes", "32", "--seed", "2", name="b.exr")
        said = json.loads(subprocess.run([MOTE, "compare", Path(self.folder.name) / "a.exr", Path(self.folder.name) / "b.exr",
                                          "--json"], check=True, capture_output=True, text=True).stdout)["metrics"]
        ours = mote.compare(picture, reference)
        for name, metric in said.items():
            self.assertAlmostEqual(ours[name], metric["value"], delta=1e-6 * abs(ours[name]), msg=name)
        self.assertEqual(set(said), set(mote.metric_definitions()))
        plain = mote.compare(picture["beauty"], reference["beauty"])
        self.assertEqual(plain["mse"], ours["mse"])
        self.assertTrue(np.isnan(plain["noise"]) and ours["noise"] > 0)
        with self.assertRaises(ValueError):
            mote.compare(picture["beauty"], reference["beauty"][1:])

    def test_series_error(self):
        pictures = [mote.render(self.scene, passes=4, seed=seed) for seed in (1, 2)]
        reference, second = (mote.render(self.scene, passes=32, seed=seed) for seed in (3, 4))
        for references in ([reference], [reference, second]):
            one = mote.series_error(pictures[:1], *references)
            self.assertAlmostEqual(one["error"], mote.compare(pictures[0], *references)["error"], delta=1e-6)
            self.assertTrue(np.isnan(one["noise"]))
        both = mote.series_error(pictures, reference, second)
        self.assertGreater(both["noise"], 2 * both["systematic"])
        mask = np.zeros(reference["beauty"].shape[:2])
        mask[: len(mask) // 2] = 1
        half = mote.series_error(pictures[:1], reference, second, mask=mask)
        errors = mote.pixel_errors(pictures[0], reference, second, mask=mask)
        self.assertAlmostEqual(errors[mask > 0].mean(), half["squared_error"], delta=1e-9)
        self.assertEqual(np.count_nonzero(errors[mask == 0]), 0)
        with self.assertRaises(ValueError):
            mote.series_error(pictures, reference["beauty"][1:])

    def test_ssbc_and_denoise(self):
        picture = mote.render(self.scene, passes=4, auxiliary=True)
        path, out = (Path(self.folder.name) / name for name in ("aux.exr", "ssbc.exr"))
        picture.save(path)
        subprocess.run([MOTE, "ssbc", path, "-o", out, "--bound", "0.5"], check=True, stdout=subprocess.DEVNULL)
        theirs, ours = mote.Picture.load(out), mote.ssbc(mote.Picture.load(path), bound=0.5)
        self.assertTrue(np.array_equal(ours["beauty"], theirs["beauty"]))
        self.assertTrue((ours["compensation_surface"] > 0).any())
        light = picture["beauty"] - picture["emission"]
        plain = mote.ssbc(light, bound=0.5, position=picture["Center.P"], normal=picture["Center.N"],
                          albedo=picture["Center.DiffuseAlbedo"],
                          world_to_camera=[float(x) for x in picture.metadata["worldToCamera"].split()])
        self.assertTrue(np.allclose(plain["compensation_surface"], ours["compensation_surface"], rtol=1e-5, atol=1e-7))
        with self.assertRaisesRegex(mote.Error, "bound"):
            mote.ssbc(light)
        denoised = mote.denoise(picture)["denoised"]
        self.assertFalse(np.array_equal(denoised, picture["beauty"]))
        features = {name: picture[name] for name in ("Albedo", "Ns", "P", "Variance")}
        self.assertTrue(np.isfinite(mote.denoise(picture["beauty"], features=features)["denoised"]).all())

    def test_denoised_sequences(self):
        frames = [mote.render(self.scene, passes=2, seed=seed, auxiliary=True) for seed in (1, 2, 3)]
        # Reference: the frames denoised by the command.
        folder = Path(self.folder.name) / "frames"
        folder.mkdir()
        for i, frame in enumerate(frames):
            frame.save(folder / f"f.{i:04d}.exr")
        subprocess.run([MOTE, "denoise", folder / "f.####.exr", "-o", folder / "d.####.exr", "--method", "bmfr"],
                       check=True, stdout=subprocess.DEVNULL)
        theirs = [mote.Picture.load(folder / f"d.{i:04d}.exr")["denoised"] for i in range(3)]
        for frame, of_command in zip(mote.denoise_sequence(mote.Picture.load(folder / f"f.{i:04d}.exr") for i in range(3)), theirs):
            self.assertTrue(np.array_equal(frame["denoised"], of_command))
        ours = list(mote.denoise_sequence(frames))  # whose cameras are known better than a file's float32 says
        for frame, of_command in zip(ours, theirs):
            self.assertTrue(np.allclose(frame["denoised"], of_command, rtol=1e-5, atol=1e-6))
        self.assertNotIn("denoised", frames[0])
        alone = next(mote.denoise_sequence(frames[2:]))["denoised"]
        self.assertFalse(np.array_equal(ours[2]["denoised"], alone))
        # Arrays: nothing moves, which the motion says.
        still = np.zeros((*frames[0]["beauty"].shape[:2], 3), np.float32)
        features = [{**{name: f[name] for name in ("Albedo", "Ns", "P")}, "MotionVector": still} for f in frames]
        plain = list(mote.denoise_sequence([f["beauty"] for f in frames], features))
        self.assertFalse(np.array_equal(plain[2]["denoised"], next(mote.denoise_sequence([frames[2]["beauty"]],
                                                                                         features[2:]))["denoised"]))
        with self.assertRaisesRegex(mote.Error, "already"):
            list(mote.denoise_sequence(ours))

    def test_trade(self):
        methods = [{"name": "paths", "integrator": "path"}, {"name": "points", "integrator": "mote_vpl"}]
        summary = mote.trade(self.path, methods, output=Path(self.folder.name) / "trade", passes=2, seeds=1,
                             reference=self.reference(), resolve=0.5)
        self.assertEqual({m["name"] for m in summary["methods"]}, {"paths", "points"})
        self.figures(Path(self.folder.name) / "trade")
        with self.assertRaisesRegex(mote.Error, "did you mean"):
            mote.trade(self.path, [{"name": "x", "integrator": "paht"}], output=Path(self.folder.name) / "other", passes=1)

    def figures(self, trade):
        """Figures of a trade, with another renderer among the methods; the bars are those of Student's t."""
        from mote import plot
        columns = "method,seed,passes,wall_s,error,final\n"
        rows = [f"other,{seed},4,{seconds},{error},1\n" for seed, seconds, error in ((1, 1, 0.1), (2, 2, 0.2), (3, 3, 0.3))]
        (trade / "other.peer.csv").write_text(columns + "".join(rows))
        point, = plot.curves(trade)["other"]
        half = 4.303 * 0.1 / 3 ** 0.5
        self.assertTrue(np.allclose(point, (2, 0.2, 0.2 - half, 0.2 + half, 3)))
        self.assertTrue(np.allclose(plot.curves(trade, "range")["other"], (2, 0.2, 0.1, 0.3, 3)))
        style = {"methods": {"paths": {"hide": True}, "other": {"label": "Other 100 %", "color": "#123456"}}, "order": ["other"]}
        plot.plot(trade, trade / "figure.tex", style)
        text = (trade / "figure.tex").read_text()
        self.assertIn("\\definecolor{mote0}{HTML}{123456}", text)
        self.assertLess(text.index("Other 100 \\%"), text.index("{points}"))
        self.assertNotIn("{paths}", text)
        # Bars that reach zero leave the axis, which ends below a third of the lowest mean.
        self.assertIn(f"ymin={100 * 0.9 * self.lowest(plot, trade):.3g}", text)
        self.assertIn("bars 95 \\%", text)
        # A method's colour is that of its place in the methods file, whether methods before it have points or not.
        self.assertEqual(self.colours(plot, trade, "both"), {"paths": "0072B2", "points": "D55E00", "other": "009E73"})
        (trade / "trade.csv").rename(trade / "all.csv")
        lines = (trade / "all.csv").read_text().splitlines()
        (trade / "trade.csv").write_text("\n".join([lines[0], *(line for line in lines[1:] if line.startswith("points"))]) + "\n")
        self.assertEqual(self.colours(plot, trade, "one"), {"points": "D55E00", "other": "009E73"})
        (trade / "all.csv").rename(trade / "trade.csv")
        with self.assertRaisesRegex(ValueError, "nothing to draw"):
            plot.plot(trade, trade / "none.tex", {"methods": {name: {"hide": True} for name in ("paths", "points", "other")}})
        for wrong in ({"colour": 1}, {"methods": {"pahts": {}}}, {"methods": {"paths": {"colour": ""}}}, {"bars": "some"}):
            with self.assertRaises(ValueError):
                plot.plot(trade, trade / "none.tex", wrong)
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            return
        for name, begin in (("figure.pdf", b"%PDF"), ("figure.svg", b"<?xml")):
            plot.plot(trade, trade / name, style)
            self.assertTrue((trade / name).read_bytes().startswith(begin))

    def lowest(self, plot, trade):
        points = [p for name, of in plot.curves(trade).items() if name != "paths" for p in of]
        return min(max(p.lower, p.error / 3) for p in points)

    def colours(self, plot, trade, name):
        """Colours of a figure without a style, by the legend's entries."""
        import re
        plot.plot(trade, trade / f"{name}.tex")
        text = (trade / f"{name}.tex").read_text()
        return dict(zip(re.findall("legendentry{(.*)}", text), re.findall("{HTML}{(.*)}", text)))

    def test_trade_of_scenes(self):
        """A scene with its changes, of a file, of text and of a dictionary: the errors of the same renders are the same."""
        files = {}
        for name, scene in (("file", mote.load(self.path)), ("text", mote.load_string(SCENE)), ("dictionary", mote.Scene(dictionary()))):
            scene["integrator"]["paths"] = 32
            output = Path(self.folder.name) / f"trade_{name}"
            summary = mote.trade(scene, [{"name": "points", "integrator": "mote_vpl"}], output=output, passes=2, seeds=1,
                                 resolve=1)
            self.assertEqual(len(summary["methods"]), 1)
            files[name] = output
        self.assertNotIn("array", (files["text"] / "scene.xml").read_text())
        self.assertIn('value="32"', (files["dictionary"] / "scene.xml").read_text())
        with self.assertRaisesRegex(mote.Error, "arrays"):
            ball = {"type": "arraymesh", "positions": np.eye(3), "triangles": [[0, 1, 2]]}
            mote.trade(mote.Scene({**dictionary(), "mesh": ball}), output=Path(self.folder.name) / "none", passes=1)

    def test_changes(self):
        """Parameters by name: read, set, completed; the bits are those of a scene loaded with the same changes."""
        scene = mote.Scene(dictionary())
        self.assertEqual(set(scene), {"integrator", "sensor", "white", "floor", "ball", "lamp"})
        self.assertEqual(scene["lamp"]["position"], (1, 3, 2))
        self.assertEqual(scene["ball"].radius, 0.5)
        self.assertEqual(scene["sensor"]["film"]["width"], 40)
        self.assertIs(scene["integrator"]["hide_emitters"], False)  # a default
        self.assertIn("intensity", scene["lamp"]._ipython_key_completions_())
        self.assertIn("position", dir(scene["lamp"]))
        scene["lamp"]["position"] = (0, 4, 2)
        scene["ball"].radius = 0.25
        scene["floor"].to_world = T().rotate([1, 0, 0], -90).scale(4)
        self.assertEqual(scene["lamp"].position, (0, 4, 2))
        other = dictionary()
        other["lamp"]["position"], other["ball"]["radius"] = [0, 4, 2], 0.25
        other["floor"]["to_world"] = T().rotate([1, 0, 0], -90).scale(4)
        self.assertTrue(same_bits(mote.render(scene, passes=1), mote.render(mote.Scene(other), passes=1)))
        with self.assertRaisesRegex(mote.Error, "position"):
            scene["lamp"]["positoin"] = (0, 0, 0)
        with self.assertRaises(KeyError):
            scene["lump"]
        with self.assertRaises(AttributeError):
            scene["lamp"].nothing
        self.assertEqual(scene["lamp"].position, (0, 4, 2))
        self.assertIn("lamp", scene._repr_html_())
        self.assertIn("<pre>", scene.plan()._repr_html_())
        file = mote.load(self.path)
        file["emitter"]["position"] = (0, 4, 2)
        again = mote.load(self.path, define={"emitter.position": (0, 4, 2)})
        self.assertEqual(file.hash, again.hash)

    def test_grids_stay(self):
        """A changed lamp does not read a grid again: its reader is gone by then. A changed file is read again."""
        grid = Path(self.folder.name) / "ramp.vdb"
        shutil.copy(ROOT / "tests/blender/ramp.vdb", grid)
        fog = {"type": "cube", "interior": {"type": "heterogeneous", "sigma_t": {"type": "vdbvolume", "filename": str(grid)}}}
        scene = mote.Scene({**dictionary(), "fog": fog})
        os.environ["MOTE_GRID_READER"] = "/nowhere"
        try:
            scene["lamp"]["position"] = (0, 4, 2)
            os.utime(grid, (1, 1))
            with self.assertRaises(mote.Error):
                scene["lamp"]["position"] = (0, 5, 2)
        finally:
            del os.environ["MOTE_GRID_READER"]
        self.assertEqual(scene["lamp"]["position"], (0, 4, 2))

    def test_pictures_of_files(self):
        """What a file keeps of a picture, and previews."""
        picture = mote.render(mote.load(self.path), passes=3)
        folder = Path(self.folder.name)
        picture.save(folder / "kept.exr")
        kept = mote.Picture.load(folder / "kept.exr")
        self.assertEqual((kept.passes, kept.interrupted), (3, False))
        self.assertAlmostEqual(kept.noise, picture.noise, delta=1e-5 * picture.noise)
        self.assertEqual(kept.layers, picture.layers)
        self.assertNotEqual(kept.layers, sorted(kept.layers))
        self.assertLessEqual(set(picture.metadata), set(kept.metadata))
        self.assertEqual(kept._ipython_key_completions_(), kept.layers)
        picture.save(folder / "kept.png")
        self.assertEqual((folder / "kept.png").read_bytes(), picture.png())
        shown = picture.srgb("direct", exposure=0.0)
        self.assertEqual((shown.shape, shown.dtype), ((30, 40, 3), np.uint8))
        expected = np.clip(picture["direct"], 0, 1)
        expected = np.where(expected <= 0.0031308, 12.92 * expected, 1.055 * expected ** (1 / 2.4) - 0.055)
        self.assertLessEqual(np.abs(shown - 255 * expected).max(), 0.51)
        for name in ("kept.jpg", "missing/kept.png"):
            with self.assertRaises(mote.Error):
                picture.save(folder / name)

    def test_command(self):
        """python -m mote is the command."""
        said = subprocess.run([sys.executable, "-m", "mote", "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said, f"mote {mote.__version__}\n")

    def test_plugins(self):
        """MOTE_PLUGINS holds for the module too, with the bits of the command."""
        os.environ["MOTE_PLUGINS"] = str(Path(MOTE).parent / "stand_ins" / "my_integrator.so")
        try:
            ours = mote.render(mote.load(self.path, integrator="my_ambient_occlusion"), passes=2, seed=5)
            theirs = self.command("--integrator", "my_ambient_occlusion", "--passes", "2", "--seed", "5")
        finally:
            del os.environ["MOTE_PLUGINS"]
        self.assertTrue(same_bits(ours, theirs))
        self.assertIn("indirect_ambient", ours)
        plugin = Path(MOTE).parent / "stand_ins" / "my_integrator.so"
        named = mote.load(self.path, integrator="my_ambient_occlusion", plugins=[plugin])
        self.assertTrue(same_bits(ours, mote.render(named, passes=2, seed=5)))
        with self.assertRaisesRegex(mote.Error, "my_ambient_occlusion"):
            mote.load(self.path, integrator="my_ambient_occlusion")

    def reference(self):
        path = Path(self.folder.name) / "reference.exr"
        subprocess.run([MOTE, "trade", self.path, "--make-reference", path, "--passes", "256", "--resolve", "0.5",
                        "--quiet"], check=True, stdout=subprocess.DEVNULL)
        return path

    def test_transform(self):
        self.assertTrue(np.allclose(T().translate([1, 2, 3]).inverse().matrix @ [1, 2, 3, 1], [0, 0, 0, 1]))
        self.assertTrue(np.allclose(T().rotate([0, 0, 1], 90).matrix @ [1, 0, 0, 1], [0, 1, 0, 1]))
        self.assertTrue(np.allclose((T().translate([1, 0, 0]) @ T().scale(2)).matrix @ [1, 1, 1, 1], [3, 2, 2, 1]))

    def test_names_at_first_use(self):
        """`import mote` loads neither NumPy nor the compiled module; dir(), type checkers and the table of modules have the same names."""
        fresh = lambda words: subprocess.run([sys.executable, "-B", "-c", words], check=True, capture_output=True, text=True).stdout.split()
        self.assertEqual(fresh("import sys, mote; print([n for n in ('numpy', 'typing', 'mote._mote') if n in sys.modules])"), ["[]"])
        self.assertEqual(fresh("import mote; print('render' in dir(mote), hasattr(mote, 'rendr'), bool(mote.__version__))"),
                         ["True", "False", "True"])
        # The first name in use is one whose own module does not import the errors.
        self.assertEqual(fresh("import mote\ntry: mote.metric_definitions() and mote.load('no.xml')\nexcept mote.Error: print('Error')"), ["Error"])
        block = next(node for node in ast.parse(Path(mote.__file__).read_text(encoding="utf-8")).body if isinstance(node, ast.If))
        declared = {line.module: [name.name for name in line.names] for line in block.body}
        self.assertEqual(declared.pop("_mote"), ["version"])
        self.assertEqual(declared, mote._MODULES)
        self.assertEqual(sorted(sum(declared.values(), [])), sorted(mote.__all__))
        self.assertLessEqual({*mote.__all__, "__version__"}, set(dir(mote)))

    def test_documentation(self):
        """Every public name says what it is, and type checkers find types."""
        for name in mote.__all__:
            self.assertGreater(len(getattr(mote, name).__doc__ or ""), 40, name)
        package = Path(mote.__file__).parent
        self.assertTrue((package / "py.typed").is_file())
        self.assertIn("def render", (package / "_mote.pyi").read_text(encoding="utf-8"))


if __name__ == "__main__":
    MOTE = sys.argv.pop(1)
    unittest.main()
