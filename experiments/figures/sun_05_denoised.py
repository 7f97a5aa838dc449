#!/usr/bin/python3
"""Bidirectional paths, denoised by block-wise feature regression: Sun 2020, Figs. 5.11 to 5.13.

Three Cornell boxes represent those of the paper: two mirroring spheres, a mirror for a back wall, and water that throws
caustics. Each is rendered by `mote_bdpt` with one sample a pixel and with many, and denoised (`mote denoise --method
bmfr`, beside OpenImageDenoise where it is installed). The error is that of `mote compare`, a root of squares relative to
the reference. What is to be kept is measured by edges: in a piece of the picture that holds the caustic, the shadows or
the reflections, g is the slope of the luminance's gradient over the reference's (1: edges as they are, 0: none) and c
the cosine between both (1: edges and nothing else); claimed where there are many samples, as in the paper, which accumulates frames. The numbers of
OpenImageDenoise are for comparison alone. A full run takes
about 6 minutes on two cores, --quick one.

    experiments/figures/sun_05_denoised.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from claims import Claims
from exr import read_exr
from occluders import water
from panels import TITLE, Canvas, mark, show
from renders import luminance, main, write_csv

SCENES = Path(__file__).resolve().parent / "scenes"
# Effects that the paper says are kept, and where they are: columns and rows as fractions of the image.
KEPT = {"two_spheres": {"contact shadows": ((0.15, 0.9), (0.78, 0.95)), "reflections": ((0.23, 0.48), (0.6, 0.85))},
        "mirror_wall": {"reflections": ((0.22, 0.78), (0.22, 0.6))},
        "water_caustic": {"caustics": ((0.0, 0.2), (0.2, 0.8))}}
METHODS = ("bmfr", "oidn")


def run(mote, *arguments):
    return subprocess.run([mote.program, *map(str, arguments)], capture_output=True, text=True)


def denoised(mote, path, method):
    """The picture beside which the denoised layer stands; nothing where the method is not installed."""
    output = path.with_name(f"{path.stem}_{method}.exr")
    if not (mote.redraw and output.is_file()):
        result = run(mote, "denoise", "--method", method, path, output, "--quiet")
        if result.returncode:
            if method == "oidn" and "is not installed" in result.stderr:
                return None
            raise RuntimeError(result.stderr)
    return output


def error(mote, path, layer, reference):
    result = run(mote, "compare", path, reference, "--json", "--layer", layer)
    if result.returncode:
        raise RuntimeError(result.stderr)
    return json.loads(result.stdout)["metrics"]["error"]["value"]


def piece(picture, where):
    (x0, x1), (y0, y1) = where
    height, width = picture.shape[:2]
    return slice(int(y0 * height), int(y1 * height)), slice(int(x0 * width), int(x1 * width))


def edges(picture, reference, where):
    """Slope and cosine of the gradients of what an eye would see: brightness on a scale of roots."""
    cut = piece(reference, where)
    gradients = [np.stack(np.gradient(np.sqrt(np.maximum(luminance(p[cut]), 0)))).ravel() for p in (picture, reference)]
    g, r = gradients
    return g @ r / (r @ r), g @ r / np.sqrt((g @ g) * (r @ r))


def measure(mote, name, side, passes, clean_passes):
    scene, settings = SCENES / f"sun_{name}.xml", {"resx": side, "resy": side}
    if name == "water_caustic":
        settings["water"] = (mote.folder / "water.ply").resolve()
        water(settings["water"])
    mote.render(scene, f"{name}_reference", settings, clean_passes, seed=77)
    path = mote.folder / f"{name}_reference_77.exr"
    truth = read_exr(path)[""]
    result = {"reference": truth, "passes": {}}
    for n in (1, passes):
        mote.render(scene, f"{name}_{n}", settings, n, auxiliary=True)
        noisy = mote.folder / f"{name}_{n}_1.exr"
        files = {"raw": (noisy, "")} | {m: (f, "denoised") for m in METHODS if (f := denoised(mote, noisy, m))}
        result["passes"][n] = {kind: {
            "picture": (picture := read_exr(file)[layer]), "error": error(mote, file, f"{layer}:" if layer else "", path),
            "edges": {what: edges(picture, truth, where) for what, where in KEPT[name].items()}}
            for kind, (file, layer) in files.items()}
    return result


def draw(results, path):
    """A line a scene: one sample raw and denoised, many raw and denoised, and the reference."""
    width = 300
    canvas = Canvas(5 * (width + 6) - 4, len(results) * (width + TITLE + 6))
    for row, (name, r) in enumerate(results.items()):
        truth, y = r["reference"], row * (width + TITLE + 6) + TITLE
        exposure = 0.8 / np.percentile(luminance(truth), 95)
        shown = [(r["passes"][n][kind], f"{n} a pixel, {'raw' if kind == 'raw' else 'BMFR'}: {r['passes'][n][kind]['error']:.1%}")
                 for n in r["passes"] for kind in ("raw", "bmfr")]
        for column, (p, text) in enumerate(shown):
            show(canvas.panel(1 + column * (width + 6), y, width, width), p["picture"], exposure, text)
        axes = canvas.panel(1 + 4 * (width + 6), y, width, width)
        show(axes, truth, exposure, f"{name.replace('_', ' ')}: reference")
        for where in KEPT[name].values():
            mark(axes, piece(truth, where))
    canvas.save(path.with_suffix(".png"))


def figure(mote, quick, output):
    side, passes, clean_passes = (96, 8, 32) if quick else (240, 16, 128)
    claims, rows = Claims(), []
    results = {name: measure(mote, name, side, passes, clean_passes) for name in KEPT}
    for name, r in results.items():
        title = name.replace("_", " ")
        for n, kinds in r["passes"].items():
            for kind, k in kinds.items():
                print(f"{title}, {n} a pixel, {kind}: error {k['error']:.1%}; " +
                      ", ".join(f"{what}: slope {s:.2f}, cosine {c:.2f}" for what, (s, c) in k["edges"].items()))
                rows += [[title, n, kind, float(k["error"]), what, *map(float, e)] for what, e in k["edges"].items()]
            raw, bmfr = kinds["raw"], kinds["bmfr"]
            ratio = bmfr["error"] / raw["error"]
            claims.check(f"{title}, {n} a pixel: the error is less than the raw one's", f"{ratio:.2f}", ratio < 1)
            if n == 1 and not quick:  # there a block is a third of the picture
                claims.check(f"{title}: with one sample a pixel BMFR leaves a quarter of the squared error at most",
                             f"{ratio ** 2:.3f} of the square, {ratio:.3f} of its root", ratio ** 2 <= 0.25)
            for what in raw["edges"] if n > 1 else ():
                (s0, c0), (s1, c1) = raw["edges"][what], bmfr["edges"][what]
                claims.check(f"{title}, {n} a pixel: {what} are clearer than before (cosine of the gradients)",
                             f"{c0:.2f} before, {c1:.2f} after", c1 > c0)
                claims.check(f"{title}, {n} a pixel: {what} are kept, at half the raw picture's contrast or more",
                             f"{s1 / s0:.2f}", s1 >= 0.5 * s0)  # the reference's noise takes from the slope of both
    write_csv(output.with_suffix(".csv"), ["scene", "samples_a_pixel", "picture", "error", "kept", "slope", "cosine"], rows)
    draw(results, output)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
