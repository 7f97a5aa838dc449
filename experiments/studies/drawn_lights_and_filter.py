#!/usr/bin/python3
"""Drawn virtual point lights (stochastic lightcuts) and the filter of layers: what is left of the noise of drawing.

Usage: drawn_lights_and_filter.py [--mote build/release/bin/mote] [--size N] [--reference N] [--quick]
A million VPLs shared out among four passes, atrium in haze and smoke room. Eye paths, points along them and VPLs are the
same for all, so errors are those of drawing alone: relative, with 1 / (r^2 + 1e-4 mean^2) as weights, each against a picture of
`--reference` lights a tile and pass that went through the same filter, or through none. Processor seconds are of the whole
command. "apart": interleaving, the pixels that share drawn lights lie so far from each other. --quick: small, two minutes.
"""
import argparse
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
from exr import read_exr

# Light paths of a million VPLs, bound [1/m^2], generated files.
SCENES = {"smoke_room": (410000, 20, {"smoke": "smoke.vdb"}), "atrium": (1000000, 2, {"meshes": ""})}
LAYERS = ["indirect_bounded", "multiple_scattering_bounded"]
CASES = [(lights, apart, "true") for lights in (1, 2, 4, 8, 16, 64) for apart in (1, 4)] + [(16, 1, "false"), (64, 1, "false")]


def scene_with(scene, paths, bound, lights, apart, filtered):
    integrator = f"""<integrator type="mote_vpl"><integer name="paths" value="{paths}"/><float name="bound" value="{bound}"/>
        <integer name="scattering_points" value="2"/><integer name="interleaving" value="{apart}"/>
        <boolean name="filter" value="{filtered}"/>
        <selection type="stochastic_lightcuts"><integer name="samples" value="{lights}"/></selection></integrator>"""
    text = (ROOT / f"scenes/{scene}.xml").read_text().replace('<integrator type="mote_layers"/>', "")
    return re.sub(r'<integrator type="mote_vpl">.*?</integrator>', integrator, text, flags=re.S)


def render(args, scene, lights, apart, filtered, folder):
    paths, bound, files = SCENES[scene]
    paths //= args.passes * (20 if args.quick else 1)
    file, exr = folder / f"{scene}.xml", folder / "p.exr"
    file.write_text(scene_with(scene, paths, bound, lights, apart, filtered))
    defines = [x for k, v in files.items() for x in ("-D", f"{k}={ROOT / 'scenes/generated' / v}")]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([args.mote, "render", file, "-t", "2", "--quiet", "-D", f"resx={args.size}", "-D", f"resy={args.size}",
                    "--passes", str(args.passes), *defines, "-o", exr], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    picture = read_exr(exr)
    return sum(picture[l] for l in LAYERS).mean(axis=2), sum(after[:2]) - sum(before[:2])


def error(picture, reference):
    weights = 1 / (reference ** 2 + 1e-4 * reference.mean() ** 2)
    return np.sqrt((weights * (picture - reference) ** 2).mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=ROOT / "build/release/bin/mote")
    parser.add_argument("--size", type=int, default=128, help="pixels along an edge")
    parser.add_argument("--passes", type=int, default=4)
    parser.add_argument("--reference", type=int, default=384, help="lights a tile and pass")
    parser.add_argument("--quick", action="store_true")
    args = parser.parse_args()
    if args.quick:
        args.size, args.reference = 48, 128
    with tempfile.TemporaryDirectory() as name:
        for scene in SCENES:
            references = {f: render(args, scene, args.reference, 4, f, Path(name))[0] for f in ("true", "false")}
            for lights, apart, filtered in CASES:
                picture, seconds = render(args, scene, lights, apart, filtered, Path(name))
                print(f"{scene}, {lights} lights a tile and pass, {apart} apart, {'' if filtered == 'true' else 'not '}filtered: "
                      f"{error(picture, references[filtered]):.2%}, bias {picture.mean() / references['false'].mean() - 1:+.2%}; "
                      f"{seconds:.1f} s", flush=True)


if __name__ == "__main__":
    main()
