#!/usr/bin/env python3
"""Damaged submissions are refused with file and reason, and the nearest right word. Usage: test_submission.py [MOTE SOURCE]"""
import contextlib
import io
import json
import sys
import unittest

from mote.benchmark.__main__ import main
from mote.benchmark.problem import BenchmarkError
from mote.benchmark.submission import read_submission
from synthetic import Path, manifest, noisy, np, suite_file, temporary, textured, write_references, write_submission


class DamageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = temporary()
        cls.folder = Path(cls.temporary.name)
        cls.suite = suite_file(cls.folder / "suite")
        cls.random = np.random.default_rng(1)
        write_references(cls.folder / "references", "plain", textured(), 0.1, cls.random)
        cls.sub = cls.folder / "sub"
        cls.content = json.dumps(write_submission(cls.sub, cls.suite, lambda *_: noisy(textured(), 0.3, cls.random)))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def setUp(self):
        manifest.write_manifest(self.sub, json.loads(self.content))

    def refused(self, change, *words):
        """`change` damages the manifest; the reasons hold the words and begin with a file of the submission."""
        content = json.loads(self.content)
        change(content)
        manifest.write_manifest(self.sub, content)
        self.refused_as_it_is(*words)

    def refused_as_it_is(self, *words):
        with self.assertRaises(BenchmarkError) as raised:
            read_submission(self.sub, self.suite)
        for line in raised.exception.lines:
            self.assertTrue(line.startswith(str(self.sub)), line)
        for word in words:
            self.assertIn(word, str(raised.exception))

    def picture(self, key, value):
        def change(content):
            content["pictures"][2][key] = value
        return change

    def top(self, key, value):
        return lambda content: content.update({key: value})

    def test_whole(self):
        self.assertEqual(len(read_submission(self.sub, self.suite).entries), 8)

    def test_json(self):
        (self.sub / "submission.json").write_text('{"format": 1,,}')
        self.refused_as_it_is("submission.json:1:14: no JSON")
        (self.sub / "submission.json").unlink()
        self.refused_as_it_is("cannot be read")

    def test_keys(self):
        self.refused(self.top("methd", "x"), "unknown 'methd' (did you mean 'method'?)")
        self.refused(lambda c: c.pop("threads", c.pop("kind")), "'kind' is missing")
        self.refused(self.top("kind", "denoisd"), "kind 'denoisd' (did you mean 'denoised'?)")
        self.refused(self.top("unbiased", 1), "'unbiased' is 1, and must be true or false")
        self.refused(self.top("suite", "other 1"), "of the suite 'other 1', not of 'synthetic 1'")
        self.refused(self.top("format", 2), "format 2, and this program reads 1")
        self.refused(self.picture("wall", 1.0), "picture 3: unknown 'wall' (did you mean 'wall_s'?)")

    def test_pictures(self):
        self.refused(self.picture("scene", "plane"), "picture 3: no scene 'plane' (did you mean 'plain'?)")
        self.refused(self.picture("budget_s", 2), "2 s is no budget of plain")
        self.refused(self.picture("seed", 77), "seed 77 is not prescribed")
        self.refused(lambda c: c["pictures"][2].update(seed=1000, file=c["pictures"][0]["file"]), "two pictures of one seed",
                     "no picture of seed 1002")
        self.refused(lambda c: c["pictures"].pop(), "no picture of seed 1003, and is not in left_out")
        self.refused(self.picture("file", "../other.exr"), "leads out of the submission")
        self.refused(self.picture("file", "plain/1/1092.exr"), "1092.exr: is not there (did you mean '1002.exr'?)")
        self.refused(self.picture("started", "noon"), "no time such as")

    def test_times(self):
        self.refused(self.picture("wall_s", -1.0), "no number of seconds")
        # 1.7 s of processors in 0.4 s of two threads.
        self.refused(self.picture("wall_s", 0.4), "do not fit into 0.4 s", "2 threads")
        content = json.loads(self.content)
        self.refused(self.picture("started", content["pictures"][1]["started"]), "before", "can have ended")

    def test_files(self):
        path = self.sub / "plain/1/1002.exr"
        whole = path.read_bytes()
        try:
            path.write_bytes(whole[:len(whole) // 2])
            self.refused_as_it_is("1002.exr")
            path.write_bytes(b"no picture")
            self.refused_as_it_is("1002.exr")
            broken = textured().astype(np.float32)
            broken[3, 4, 1] = np.nan
            from mote import Picture
            Picture({"beauty": broken}).save(path)
            self.refused_as_it_is("1 pixels are not finite")
            Picture({"beauty": textured()[:32].astype(np.float32)}).save(path)
            self.refused_as_it_is("96 x 32 pixels, and the suite has 96 x 64")
            Picture({"beauty": textured().astype(np.float32)}, {"seed": "7"}).save(path)
            self.refused_as_it_is("the file says seed 7, the manifest 1002")
        finally:
            path.write_bytes(whole)

    def test_left_out(self):
        content = json.loads(self.content)
        content["pictures"] = [p for p in content["pictures"] if p["budget_s"] == 4]
        content["left_out"] = [{"scene": "plain", "budget_s": 1, "reason": "one pass takes 2 s"}]
        manifest.write_manifest(self.sub, content)
        self.assertEqual(len(read_submission(self.sub, self.suite).entries), 4)

    def run_main(self, *arguments):
        out, said = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(said):
            try:
                code = main([str(a) for a in arguments])
            except SystemExit as stopped:
                code = stopped.code
        return code, out.getvalue(), said.getvalue()

    def test_command(self):
        common = ["--suite", self.folder / "suite", "--references", self.folder / "references", "-o", self.folder / "scores"]
        code, out, said = self.run_main("score", self.sub, *common)
        self.assertEqual(code, 0, said)
        self.assertIn("| formula |", out)
        page = (self.folder / "scores" / "benchmark.html").read_text()
        self.assertIn("formula", page)
        self.assertEqual(page.count("<img"), 3)
        rows = (self.folder / "scores" / "scores.csv").read_text().splitlines()
        self.assertEqual(len(rows) - rows.index(next(r for r in rows if r.startswith("method,"))) - 1, 2 * 4)
        manifest.write_manifest(self.sub, {**json.loads(self.content), "kind": "rw"})
        code, _, said = self.run_main("score", self.sub, *common)
        self.assertEqual(code, 1)
        self.assertTrue(said.startswith("mote: ") and "kind 'rw' (did you mean 'raw'?)" in said, said)
        self.assertEqual(self.run_main("scor")[0], 2)
        code, _, said = self.run_main("scenes", "plin", "--suite", self.folder / "suite")
        self.assertEqual((code, "no scene 'plin' (did you mean 'plain'?)" in said), (1, True), said)
        code, _, said = self.run_main("score", self.sub, "--suite", self.folder / "suite", "--references", self.folder)
        self.assertEqual(code, 1)

    def test_missing_references(self):
        code, _, said = self.run_main("score", self.sub, "--suite", self.folder / "suite", "--references", self.folder)
        self.assertEqual((code, "plain_a.exr: is not there: 'python -m mote.benchmark references plain' makes it" in said), (1, True), said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
