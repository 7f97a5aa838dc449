#!/usr/bin/python3
"""The order of each technique's bias in its radius: mote_upbp with one technique against volpath.

Usage: upbp_radii.py [--mote build/release/bin/mote] [--seeds 12] [--passes 60] [--quick]
A point light in fog without an end, one metre behind the camera (surf: above a plane): no edge of anything is near, where
bias would be of first order. Kernels do not shrink (alpha = 1). The bias is that of the mean of single scattering (surf:
direct light) over the image, at four radii that see the same light paths; b = c r^p is fitted to them, and the standard
error of p is that of a jackknife over seeds. The script fails where p is not 2 within three standard errors and 0.15 (the
next term, of r^4, is a tenth of the first at the largest radius), and where the same test would not refuse 1 and 3.
"""
import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
from exr import read_exr

RADII = np.array([0.5, 0.4, 0.3, 0.2])  # [m]
EDGE = 20.0  # half of the cube's [m]
BOUNDS = EDGE * np.sqrt(3.0)
SIZE = 48
BEAMS = min(1.0, 100.0 / min(2000, SIZE * SIZE))  # radius of bb1d over that of the others
TECHNIQUES = ("surf", "pp3d", "pb2d", "bb1d")

HEAD = f"""<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="50"/>
<transform name="to_world"><lookat origin="0, 0, 0" target="0, 0, 1" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="{SIZE}"/><integer name="height" value="{SIZE}"/></film></sensor>"""
LIGHT = """<emitter type="point"><point name="position" x="0" y="0" z="{z}"/><rgb name="intensity" value="10"/></emitter>"""
FOG = f"""<shape type="cube"><transform name="to_world"><scale value="{EDGE}"/></transform><bsdf type="null"/>
<medium type="homogeneous" name="interior"><float name="sigma_t" value="0.5"/><float name="albedo" value="0.8"/></medium></shape>"""
PLANE = f"""<shape type="rectangle"><transform name="to_world"><scale value="{EDGE}"/><rotate y="1" angle="180"/>
<translate z="2"/></transform><bsdf type="diffuse"/></shape>"""


def scene(technique):
    if technique == "surf":
        return HEAD + LIGHT.format(z=0.8) + PLANE + "</scene>"
    return HEAD + LIGHT.format(z=-1) + FOG + "</scene>"


def render(args, folder, technique, integrator, passes, seed, settings=()):
    """Mean of the layer over the image."""
    xml, exr = folder / f"{technique}.xml", folder / "p.exr"
    xml.write_text(scene(technique))
    subprocess.run([args.mote, "render", xml, "--integrator", integrator, "--quiet", "--passes", str(passes), "--seed", str(seed),
                    *(word for s in settings for word in ("-D", f"integrator.{s}")), "-o", exr], check=True)
    return read_exr(exr)["direct" if technique == "surf" else "single_scattering"].mean()


def bounds_of(technique):
    """Radius of the scene's bounds [m]."""
    return EDGE * np.sqrt(2.0) if technique == "surf" else BOUNDS


def biases(args, folder, technique):
    """Relative, of every seed (rows) and radius."""
    depth = "max_depth=2"
    truth = np.mean([render(args, folder, technique, "volpath", args.passes, s, [depth]) for s in range(1001, 1005)])
    only = [f"{t}={'true' if t == technique else 'false'}" for t in ("bpt", *TECHNIQUES)]
    rows = []
    for seed in range(1, args.seeds + 1):
        row = []
        for r in RADII:
            radius = r / bounds_of(technique) / (BEAMS if technique == "bb1d" else 1.0)
            row.append(render(args, folder, technique, "mote_upbp", args.passes, seed,
                              [*only, depth, "alpha=1", f"radius={radius:.9g}"]))
        rows.append(np.array(row) / truth - 1.0)
    return np.stack(rows)


def order(bias):
    """p of c r^p, by least squares weighted by the biases' squares: so the logarithm's noise is even."""
    x, y, w = np.log(RADII), np.log(np.abs(bias)), bias ** 2
    x = x - np.average(x, weights=w)
    return np.sum(w * x * y) / np.sum(w * x * x)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=str(ROOT / "build/release/bin/mote"))
    parser.add_argument("--seeds", type=int, default=12)
    parser.add_argument("--passes", type=int, default=60)
    parser.add_argument("--techniques", default=",".join(TECHNIQUES))
    parser.add_argument("--quick", action="store_true", help="one technique, two seeds, no assertion")
    args = parser.parse_args()
    if args.quick:
        args.seeds, args.passes, args.techniques = 2, 2, "pb2d"
    print("technique  bias at r = " + ", ".join(f"{r} m" for r in RADII) + "   order  standard error", flush=True)
    failed = False
    with tempfile.TemporaryDirectory() as name:
        for technique in args.techniques.split(","):
            rows = biases(args, Path(name), technique)
            n = len(rows)
            p = order(rows.mean(0))
            left_out = np.array([order(np.delete(rows, i, axis=0).mean(0)) for i in range(n)])
            error = np.sqrt((n - 1) / n * np.sum((left_out - left_out.mean()) ** 2))
            print(f"{technique:9}  " + "  ".join(f"{100 * b:7.3f} %" for b in rows.mean(0)) + f"   {p:.2f}  {error:.2f}", flush=True)
            margin = 3.0 * error + 0.15
            failed |= not abs(p - 2.0) < margin or not margin < 0.85
    if failed and not args.quick:
        sys.exit("a bias is not of second order, or too noisy")


if __name__ == "__main__":
    main()
