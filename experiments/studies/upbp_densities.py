#!/usr/bin/python3
"""Which kernel has least noise at which density: points, points beside beams, or crossing beams, each alone in mote_upbp.

Usage: upbp_densities.py [--mote build/release/bin/mote] [--passes 200] [--seeds 4] [--quick]
A ball of fog of radius 1 m under parallel light from beside the camera; light that scatters once. All techniques have the same
100 light paths a pass and the same radius of 0.1 m, which does not shrink. Printed is the standard deviation of one pass over
the mean, with its standard error over seeds. Křivánek et al. 2014 (Sec. 4) state: the more a medium's mean free path exceeds
the kernel, the better are beams; points win where it is far below. The script fails unless crossing beams are best and points
worst in the thinnest fog, and points best in the densest, each by more than three standard errors.
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

TECHNIQUES = ("pp3d", "pb2d", "bb1d")
SIGMA_T = (0.1, 1.0, 10.0, 100.0)  # [1/m]
RADIUS, BOUNDS = 0.1, np.sqrt(3.0)  # [m]
SCENE = """<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="30"/>
<transform name="to_world"><lookat origin="0, 0, -4" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="10"/><integer name="height" value="10"/></film></sensor>
<emitter type="directional"><vector name="direction" x="0.5" y="0.2" z="1"/><rgb name="irradiance" value="1"/></emitter>
<shape type="sphere"><bsdf type="null"/><medium type="homogeneous" name="interior"><float name="sigma_t" value="{sigma_t}"/>
<float name="albedo" value="0.9"/></medium></shape></scene>"""


def deviation(args, folder, sigma_t, technique, seed):
    """Of one pass, over the mean, both as roots of mean squares over pixels."""
    xml, exr = folder / "fog.xml", folder / "p.exr"
    xml.write_text(SCENE.format(sigma_t=sigma_t))
    only = [f"{t}={'true' if t == technique else 'false'}" for t in ("bpt", "surf", *TECHNIQUES)]
    settings = [*only, "alpha=1", f"radius={RADIUS / BOUNDS:.9g}", "max_depth=2"]
    subprocess.run([args.mote, "render", xml, "--integrator", "mote_upbp", "--quiet", "--passes", str(args.passes), "--seed", str(seed),
                    *(word for s in settings for word in ("-D", f"integrator.{s}")), "-o", exr], check=True)
    layers = read_exr(exr)
    return np.sqrt(args.passes * layers["Variance"].mean() / (layers[""] ** 2).mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=str(ROOT / "build/release/bin/mote"))
    parser.add_argument("--passes", type=int, default=200)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--quick", action="store_true", help="few passes, no assertion")
    args = parser.parse_args()
    if args.quick:
        args.passes, args.seeds = 8, 2
    print("sigma_t [1/m]  " + "".join(f"{t:>18}" for t in TECHNIQUES), flush=True)
    table = {}
    with tempfile.TemporaryDirectory() as name:
        for sigma_t in SIGMA_T:
            for t in TECHNIQUES:
                values = [deviation(args, Path(name), sigma_t, t, s) for s in range(1, args.seeds + 1)]
                table[sigma_t, t] = np.mean(values), np.std(values, ddof=1) / np.sqrt(args.seeds)
            print(f"{sigma_t:13g}  " + "".join(f"{m:10.3f} ± {e:.3f}" for m, e in (table[sigma_t, t] for t in TECHNIQUES)), flush=True)

    def below(sigma_t, a, b):
        (x, dx), (y, dy) = table[sigma_t, a], table[sigma_t, b]
        return y - x > 3.0 * np.hypot(dx, dy)

    thin, dense = SIGMA_T[0], SIGMA_T[-1]
    stated = [below(thin, "bb1d", "pb2d"), below(thin, "pb2d", "pp3d"), below(dense, "pp3d", "bb1d"), below(dense, "pp3d", "pb2d")]
    if not all(stated) and not args.quick:
        sys.exit(f"the ranking is not as stated: {stated}")


if __name__ == "__main__":
    main()
