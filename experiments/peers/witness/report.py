"""The table, and the pictures of a scene side by side."""
from pathlib import Path

import mitsuba as mi
import numpy as np

HEAD = ("| scene | mote | Mitsuba | difference | worst z | critical z | verdict |\n"
        "|---|---|---|---|---|---|---|")


def verdict(result):
    if not result.agrees:
        return "DISAGREE"
    return "agree" if result.sensitive else "TOO NOISY"


def row(name, result):
    return (f"| {name} | {result.mean[0]:.5g} | {result.mean[1]:.5g} | "
            f"{100 * result.difference:+.2f} ± {100 * result.error:.2f} % | {result.worst_z:.2f} | "
            f"{result.critical_z:.2f} | {verdict(result)} |")


def _enlarged(picture, factor):
    return np.kron(picture, np.ones((factor, factor, 1)))


def _tone(picture, white):
    """Linear to 8-bit sRGB; `white` is shown as 1."""
    c = np.clip(picture / white, 0.0, 1.0)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def _z_picture(z_map, height, width, critical):
    """Red where the second is brighter, blue where it is darker; full colour at the critical value."""
    block = -(-height // z_map.shape[0])
    z = _enlarged(z_map.mean(axis=2, keepdims=True), block)[:height, :width] / critical
    return np.concatenate([0.5 + 0.5 * z, np.full_like(z, 0.5), 0.5 - 0.5 * z], axis=2).clip(0.0, 1.0)


def write_pictures(folder, name, first, second, result):
    """EXRs of both means, and one PNG: mote, Mitsuba, and z by blocks."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    a, b = first.mean(axis=0), second.mean(axis=0)
    for which, picture in (("mote", a), ("mitsuba", b)):
        mi.Bitmap(picture.astype(np.float32)).write(str(folder / f"{name}_{which}.exr"))
    white = max(np.percentile(a, 97), 1e-9)
    factor = max(1, 256 // max(a.shape[:2]))
    views = [_tone(a, white), _tone(b, white), _z_picture(result.z_map, *a.shape[:2], result.critical_z)]
    sheet = np.concatenate([_enlarged(v, factor) for v in views], axis=1)
    mi.Bitmap((255.0 * sheet + 0.5).astype(np.uint8)).write(str(folder / f"{name}.png"))
