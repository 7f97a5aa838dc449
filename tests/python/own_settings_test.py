#!/usr/bin/env python3
"""Tests of a figure's settings by its command line (experiments/figures/own_settings.py). Usage: own_settings_test.py MOTE"""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "experiments" / "figures"))
from own_settings import OwnSettings  # noqa: E402


class OwnSettingsTest(unittest.TestCase):
    def test_places(self):
        own = OwnSettings(["--bound", "5", "--resx=32", "--film.height", "8", "--filter"], MOTE)
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.xml"
            scene.write_text('<scene><integrator type="mote_vpl"/><integer name="width" value="$resx"/></scene>')
            self.assertEqual(own.added_to(scene, {"integrator": "path", "a": 1}),
                             {"integrator": "path", "a": 1, "resx": "32", "film.height": "8"})
            with self.assertRaisesRegex(ValueError, "--bound, --filter"):
                own.check()
            self.assertEqual(own.added_to(scene, {"integrator.bound": 9}),
                             {"integrator.bound": "5", "resx": "32", "film.height": "8", "integrator.filter": "true"})
            own.check()
        self.assertEqual(own.suffix(), "_bound=5_resx=32_film.height=8_filter=true")

    def test_names(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.xml"
            scene.write_text('<scene><integer name="width" value="$resx"/></scene>')
            OwnSettings(["--bound", "5", "--resx", "32", "--film.height", "8"], MOTE).check_names([scene])
            for unknown in ("bounds", "res"):
                with self.assertRaisesRegex(ValueError, f"no --{unknown}:"):
                    OwnSettings([f"--{unknown}", "5"], MOTE).check_names([scene])

    def test_words(self):
        self.assertFalse(OwnSettings([], MOTE))
        with self.assertRaises(ValueError):
            OwnSettings(["5"], MOTE)


if __name__ == "__main__":
    MOTE = sys.argv.pop(1)
    unittest.main()
