#!/usr/bin/env python3
"""The whole way on a small suite by mote itself: references, run, score, verify; programs that are not there. Usage: test_run.py MOTE SOURCE"""
import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from mote import Picture
from mote.benchmark.__main__ import main
from mote.benchmark.adapter import load_adapter
from mote.benchmark.problem import BenchmarkError
from mote.benchmark.running import next_passes
from mote.benchmark.suite import load_suite
from synthetic import SOURCE, Path, temporary

METHODS = [{"name": "paths", "program": "mote", "kind": "raw", "noise": "independent", "unbiased": True, "settings": {"integrator": "path"}},
           {"name": "lights", "program": "mote", "kind": "raw", "noise": "shared", "unbiased": False, "settings": {"integrator": "mote_vpl"}},
           {"name": "absent", "program": "pbrt", "kind": "raw", "noise": "independent", "unbiased": True},
           {"name": "broken", "program": "broken", "kind": "raw", "noise": "independent", "unbiased": True}]
BROKEN = """from mote.benchmark.adapter import Adapter


class Renderer(Adapter):
    def version(self):
        return "0"

    def render(self, job):
        raise RuntimeError("it found no light")
"""


class RunTest(unittest.TestCase):
    def command(self, *arguments, expected=0):
        out, said = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(said):
            code = main([str(a) for a in arguments])
        self.assertEqual(code, expected, out.getvalue() + said.getvalue())
        return out.getvalue(), said.getvalue()

    def test_all(self):
        os.environ.pop("PBRT", None)
        with temporary() as name:
            folder = Path(name)
            shutil.copytree(Path(SOURCE) / "benchmark" / "adapters", folder / "adapters")
            (folder / "adapters" / "broken.py").write_text(BROKEN)
            suite = json.loads((Path(SOURCE) / "benchmark" / "suite.json").read_text())
            box = next(s for s in suite["scenes"] if s["name"] == "cornell_box")
            box.update(file=str(Path(SOURCE) / "scenes" / "cornell_box.xml"), width=48, height=48, budgets=[0.2, 0.6])
            box["reference"]["passes"] = 128
            missing = dict(box, name="missing", file="missing.xml", made_by="nothing makes it")
            suite.update(scenes=[box, missing], seeds=3)
            (folder / "suite.json").write_text(json.dumps(suite))
            (folder / "methods.json").write_text(json.dumps(METHODS))
            common = ["--suite", folder, "--references", folder / "references"]
            out, said = self.command("references", *common, "-t", 2, "--hidden")
            self.assertIn("left out: missing", said)
            log = json.loads((folder / "references" / "references.json").read_text())["scenes"]["cornell_box"]
            self.assertEqual(sorted(log), ["a", "b", "c", "d", "noise"])
            self.assertLess(log["noise"]["all"], 0.1)
            self.assertGreater(log["a"]["seconds"], 0)
            out, said = self.command("run", *common, "-t", 2, "-o", folder / "subs")
            self.assertIn("absent: left out: pbrt-v4 is not installed", said)
            self.assertIn("missing.xml is not there: nothing makes it", said)
            self.assertIn("broken: cornell_box: failed: it found no light", said)
            subs = [folder / "subs" / name for name in ("paths", "lights", "broken")]
            out, _ = self.command("score", *subs, *common, "-o", folder / "scores")
            self.assertIn("raw: ranks over 1 scenes", out)
            self.assertIn("cornell_box: failed | cornell_box |", out)
            before = {p: p.stat().st_mtime_ns for p in subs[0].rglob("*.exr")}
            self.assertEqual(len(before), 6)
            self.command("run", *common, "-t", 2, "-o", folder / "subs", "paths")
            self.assertEqual(before, {p: p.stat().st_mtime_ns for p in subs[0].rglob("*.exr")})
            # What is here is repeated bit by bit; times depend on the load of the machine, which is not tested.
            _, _ = main_of_verify(subs[0], common)

    def test_cluster(self):
        """References by the workers of a Dask cluster have the bits of this machine's."""
        try:
            from distributed import LocalCluster
        except ImportError:
            self.skipTest("LEFT OUT: no package 'distributed' in this Python")
        os.environ["MOTE_COMMAND"] = os.environ["MOTE"]
        with temporary() as name, LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None, silence_logs=50) as local:
            folder = Path(name)
            suite = json.loads((Path(SOURCE) / "benchmark" / "suite.json").read_text())
            box = next(s for s in suite["scenes"] if s["name"] == "cornell_box")
            box.update(file=str(Path(SOURCE) / "scenes" / "cornell_box.xml"), width=32, height=32)
            box["reference"]["passes"] = 32
            suite.update(scenes=[box])
            (folder / "suite.json").write_text(json.dumps(suite))
            self.command("references", "--suite", folder, "--references", folder / "one", "-t", 1)
            self.command("references", "--suite", folder, "--references", folder / "many", "--scheduler", local.scheduler_address)
            for letter in "ab":
                one, many = (Picture.load(folder / of / f"cornell_box_{letter}.exr") for of in ("one", "many"))
                self.assertTrue((one["beauty"] == many["beauty"]).all())
            log = json.loads((folder / "many" / "references.json").read_text())["scenes"]["cornell_box"]
            self.assertEqual(len(log["a"]["machines"]), 1)

    def test_passes(self):
        """Late pictures get fewer passes, early ones more, others are kept; one pass is never less."""
        self.assertEqual(next_passes(100, 1.2, 1.0), 75)
        self.assertEqual(next_passes(2, 1.01, 1.0), 1)
        self.assertEqual(next_passes(1, 3.0, 1.0), 1)
        self.assertEqual(next_passes(100, 0.44, 1.0), 200)
        self.assertEqual(next_passes(100, 0.7, 1.0), 100)
        self.assertEqual(next_passes(1, 0.55, 1.0), 1)

    def test_two_sided(self):
        """Opaque surfaces get two sides and keep their name, glass stays."""
        with temporary() as name:
            folder = Path(name)
            (folder / "from.xml").write_text("""<scene><bsdf type="diffuse" id="wall"/><bsdf type="dielectric" id="glass"/>
                <shape type="obj"><string name="filename" value="a.obj"/><ref id="wall"/><medium type="homogeneous"/></shape>
                <shape type="sphere"><bsdf type="plastic"/></shape></scene>""")
            subprocess.run([sys.executable, str(Path(SOURCE) / "benchmark" / "two_sided.py"), "from.xml", "to.xml"], cwd=folder, check=True)
            scene = ElementTree.parse(folder / "to.xml").getroot()
            outer = [(b.get("type"), b.get("id"), [(c.get("type"), c.get("id")) for c in b]) for b in scene.findall("bsdf")]
            self.assertEqual(outer, [("twosided", "wall", [("diffuse", None)]), ("dielectric", "glass", [])])
            mesh, ball = scene.findall("shape")
            self.assertEqual((mesh.find("string").get("value"), mesh.find("bsdf")), (str((folder / "a.obj").resolve()), None))
            self.assertEqual(ball.find("bsdf/bsdf").get("type"), "plastic")

    def test_suite(self):
        """The suite of the tree: scenes that are part of it exist, every program has an adapter, words are complete."""
        suite = load_suite(Path(SOURCE) / "benchmark")
        self.assertGreaterEqual(len(suite.scenes), 15)
        for scene in suite.scenes:
            self.assertTrue(scene.file.is_file() or "generated" in scene.file.parts or scene.origin, scene.file)
            self.assertTrue(scene.tests.endswith("."), scene.name)
        seeds = [s for scene in suite.scenes for s in suite.seeds_of(scene)]
        self.assertEqual(len(set(seeds)), len(seeds))
        for method in json.loads((Path(SOURCE) / "benchmark" / "methods.json").read_text()):
            load_adapter(Path(SOURCE) / "benchmark" / "adapters", method["program"]).missing()
        with self.assertRaisesRegex(BenchmarkError, "no adapter 'mitsba' .did you mean 'mitsuba'"):
            load_adapter(Path(SOURCE) / "benchmark" / "adapters", "mitsba")


def main_of_verify(folder, common):
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        code = main(["verify", str(folder), "cornell_box", *map(str, common)])
    lines = [line for line in out.getvalue().splitlines() if "REFUSED" in line and "times:" not in line]
    assert not lines, lines
    return code, out.getvalue()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
