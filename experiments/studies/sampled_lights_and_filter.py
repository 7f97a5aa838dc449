#!/usr/bin/python3
"""Selected virtual point lights and the filter of layers: what is left of the noise of selecting, and what it costs.

Usage: sampled_lights_and_filter.py [--mote build/release/bin/mote] [--size N] [--passes N] [--scene NAME] [--reference N]
         [--keep FILE] [--quick] [METHOD...]
A million VPLs shared out among the passes, atrium in haze and smoke room. Eye paths, points along them and VPLs are the
same for all, so errors are those of selecting alone: the relative RMSE (measure.py), each against a picture of
`--reference` sampled lights a tile and pass that went through the same filter, or through none; its own noise is not subtracted.
`--keep` keeps references for the next time.
METHOD: stochastic:LIGHTS, tree:LIGHTS, ris:CANDIDATES:SAMPLES, lightcuts:ERROR:MOST:ANGLE, multidimensional:ERROR:MOST:ANGLE,
each with @N behind it for an interleaving of N (the pixels that share sampled lights lie so far from each other), ! for no filter,
and more <selection> parameters as +name=value. Seconds are of the processor: of the whole command, and, of a picture of
512 x 512, those that are more than a single sampled light takes (without eye paths, light paths and filter). --quick: small, two minutes.
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
import measure
from exr import read_exr

# Light paths of a million VPLs, bound [1/m^2], generated files.
SCENES = {"smoke_room": (410000, 20, {"smoke": "smoke.vdb"}), "atrium": (1000000, 2, {"meshes": ""})}
LAYERS = ["indirect_bounded", "multiple_scattering_bounded"]
METHODS = [f"stochastic:{n}@4" for n in (16, 48)] + [
    f"ris:{m}:{n}@4" for m, n in ((64, 8), (128, 8), (128, 16), (256, 16), (256, 32))] + [
    "ris:128:16", "ris:128:16@4!", "multidimensional:0.08:1000:0.2"]
TYPES = {"stochastic": ("stochastic_lightcuts", "samples"), "tree": ("light_tree", "samples"),
         "ris": ("resampling", "candidates", "samples"), "lightcuts": ("lightcuts", "error", "max_cut", "shared_angle"),
         "multidimensional": ("multidimensional_lightcuts", "error", "max_cut", "shared_angle")}
KINDS = {"samples": "integer", "candidates": "integer", "max_cut": "integer"}


def selection(method):
    """The <selection> of a method, its interleaving, and whether it is filtered."""
    text, apart, bare = re.fullmatch(r"([^@!]*)(?:@(\d+))?(!?)", method).groups()
    words, *more = text.split("+")
    words = words.split(":")
    name, *parameters = TYPES[words[0]]
    values = list(zip(parameters, words[1:])) + [m.split("=") for m in more]
    inner = "".join(f'<{KINDS.get(k, "float")} name="{k}" value="{v}"/>' for k, v in values)
    return f'<selection type="{name}">{inner}</selection>', int(apart or 1), "false" if bare else "true"


def scene_with(scene, paths, bound, method):
    inner, apart, filtered = selection(method)
    integrator = f"""<integrator type="mote_vpl"><integer name="paths" value="{paths}"/><float name="bound" value="{bound}"/>
        <integer name="scattering_points" value="2"/><integer name="interleaving" value="{apart}"/>
        <boolean name="filter" value="{filtered}"/>{inner}</integrator>"""
    text = (ROOT / f"scenes/{scene}.xml").read_text().replace('<integrator type="mote_layers"/>', "")
    return re.sub(r'<integrator type="mote_vpl">.*?</integrator>', integrator, text, flags=re.S)


def render(args, scene, method, folder):
    paths, bound, files = SCENES[scene]
    paths //= args.passes * (20 if args.quick else 1)
    file, exr = folder / f"{scene}.xml", folder / "p.exr"
    file.write_text(scene_with(scene, paths, bound, method))
    defines = [x for k, v in files.items() for x in ("-D", f"{k}={ROOT / 'scenes/generated' / v}")]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([args.mote, "render", file, "-t", "2", "--quiet", "-D", f"resx={args.size}", "-D", f"resy={args.size}",
                    "--passes", str(args.passes), *defines, "-o", exr], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    picture = read_exr(exr)
    return sum(picture[l] for l in LAYERS).mean(axis=2), sum(after[:2]) - sum(before[:2])


def references(args, scene, folder):
    """Filtered, and not; stored ones where there are any."""
    kept = dict(np.load(args.keep)) if args.keep and args.keep.exists() else {}
    key = f"{scene} {args.size} {args.passes} {args.quick} {args.reference}"
    missing = [end for end in ("", "!") if key + end not in kept]
    for end in missing:
        kept[key + end] = render(args, scene, f"stochastic:{args.reference}@4{end}", folder)[0]
    if args.keep and missing:
        np.savez(args.keep, **kept)
    return {"true": kept[key], "false": kept[key + "!"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mote", default=ROOT / "build/release/bin/mote")
    parser.add_argument("--size", type=int, default=128, help="pixels along an edge")
    parser.add_argument("--passes", type=int, default=4)
    parser.add_argument("--scene", choices=SCENES, action="append")
    parser.add_argument("--reference", type=int, default=384, help="lights a tile and pass")
    parser.add_argument("--keep", type=Path, help="file of references")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("methods", nargs="*", default=METHODS)
    args = parser.parse_args()
    measure.use(Path(args.mote).parent)
    if args.quick:
        args.size, args.reference = 48, 128
    with tempfile.TemporaryDirectory() as name:
        for scene in args.scene or SCENES:
            reference = references(args, scene, Path(name))
            least = render(args, scene, "stochastic:1@4", Path(name))[1]
            for method in args.methods:
                picture, seconds = render(args, scene, method, Path(name))
                filtered = selection(method)[2]
                print(f"{scene}, {method}: {measure.error(picture, [reference[filtered]]):.2%}, "
                      f"bias {picture.mean() / reference['false'].mean() - 1:+.2%}; {seconds:.1f} s, "
                      f"{(seconds - least) * (512 / args.size) ** 2:.0f} s of a picture", flush=True)


if __name__ == "__main__":
    main()
