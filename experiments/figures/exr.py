"""Reads the pictures of `mote` as layers, by the reader of files of our add-on for Blender, which needs NumPy alone."""
import importlib.util
from pathlib import Path

import numpy as np

_FILE = Path(__file__).resolve().parents[2] / "plugins" / "blender" / "mote_render" / "exr.py"
_spec = importlib.util.spec_from_file_location("mote_exr_file", _FILE)
_exr_file = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_exr_file)
read_header = _exr_file.read_header


def read_exr(path):
    """Its layers, by name: arrays of height * width * 3. The beauty is ''."""
    planes = _exr_file.read_exr(path)
    layers = {name.rpartition(".")[0] for name in planes if name.rpartition(".")[2] == "R"}
    return {layer: np.stack([planes[f"{layer}.{c}" if layer else c] for c in "RGB"], axis=2).astype(np.float64) for layer in layers}
