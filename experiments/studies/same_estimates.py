#!/usr/bin/python3
"""Do two builds of mote estimate the same light, with the same variance? Means and variances of small renders, tested.

Each scene is rendered by each method, with the same seeds by either program: where they use the same random numbers their
noise cancels. Tests of the image without emission, at 0.01 for all of them together (Bonferroni): the mean of every block of
4 x 4 pixels and of every layer that both write, by the t of their differences, and the variance of pixels between seeds, whose
mean log ratio has a standard error by the jackknife over seeds. A method that refuses a scene, or sees nothing there, is left
out. Most of the time goes into loading the scenes, the city above all.

    same_estimates.py OLD NEW -o FOLDER [--scenes REGEX] [--methods REGEX] [--seeds N] [--threads N]

OLD and NEW are programs; the table goes to FOLDER/same_estimates.csv, images are kept there, and --redraw takes them as they
are. Ends with 1 where a test fails.
"""
import argparse
import math
import re
import subprocess
import sys
from pathlib import Path
from statistics import NormalDist

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from exr import read_exr  # noqa: E402
from origin import ROOT  # noqa: E402

SCENES = ["cornell_box", "smoke_room", "fog_grille", "cloud", "atrium", "city"]
METHODS = {  # name: (integrator, its settings, passes of a render)
    "path": ("path", {}, 64),
    "volpath": ("volpath", {}, 64),
    "bdpt": ("mote_bdpt", {}, 16),
    "upbp": ("mote_upbp", {}, 8),
    "vpl": ("mote_vpl", {"paths": 64}, 16),
    "vpl exact": ("mote_vpl", {"paths": 64, "compensation": "exact"}, 8),
    "vpl resampling": ("mote_vpl", {"paths": 256, "selection": "resampling"}, 16),
    "vpl lightcuts": ("mote_vpl", {"paths": 256, "selection": "stochastic_lightcuts"}, 16),
    "vpl interleaving": ("mote_vpl", {"paths": 256, "interleaving": 2}, 8),
    "ray lights": ("mote_ray_lights", {"paths": 64}, 8),
    "vpl ray bundles": ("mote_vpl_ray_bundles", {"paths": 16, "directions": 2}, 8),
    "vsl": ("mote_vsl", {"paths": 64}, 8),
    "photons": ("mote_photon_map", {"photon_paths": 10000}, 8),
    "micro-rendering": ("mote_micro_rendering", {"points": 4096, "micro_buffer": 8}, 4),
}
WIDTH, HEIGHT, BLOCK, LEVEL = 24, 16, 4, 0.01


def rendered(program, path, scene, method, seed, options):
    """Layers of a render; nothing where the program refuses the scene."""
    if not (options.redraw and path.is_file()):
        kind, settings, passes = METHODS[method]
        sizes = {"film.width": WIDTH, "film.height": HEIGHT}
        command = [program, "render", ROOT / "scenes" / f"{scene}.xml", "-o", path, "--quiet", "--integrator", kind,
                   "--passes", str(passes), "--seed", str(seed), "--threads", str(options.threads)]
        for name, value in (sizes | {f"integrator.{k}": v for k, v in settings.items()}).items():
            command += ["-D", f"{name}={value}"]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode == 1:
            return None
        run.check_returncode()
    layers = read_exr(path)
    layers.pop("Variance", None)
    # The edges of lights that are seen would hide the noise of all other light.
    layers[""] = layers[""] - layers.get("emission", 0.0)
    return layers


def renders(program, folder, scene, method, options):
    """By layer, an array of seeds * height * width * 3; nothing where the scene is refused."""
    folder.mkdir(parents=True, exist_ok=True)
    images = []
    for seed in range(1, options.seeds + 1):
        image = rendered(program, folder / f"{scene}_{method.replace(' ', '_')}_{seed}.exr", scene, method, seed, options)
        if image is None:
            return None
        images.append(image)
    return {layer: np.stack([i[layer] for i in images]) for layer in images[0]}


def deviates(a, b):
    """Normal deviates of the t of the differences b - a, along their first axis (Wallace 1959). Rounding is no difference."""
    n = len(a) - 1
    rounding = 1e-5 * (np.abs(a.mean(axis=0)) + np.abs(b.mean(axis=0)))
    error = np.sqrt((b - a).var(axis=0, ddof=1) / len(a)) + rounding + 1e-30
    t = (b - a).mean(axis=0) / error
    return np.sign(t) * (8 * n + 1) / (8 * n + 3) * np.sqrt(n * np.log1p(t * t / n))


def variance_ratio(a, b):
    """Mean over pixels of the log of the ratio of variances between seeds, of b to a, and its standard error. A floor keeps
    pixels that few seeds light from ruling the mean."""
    floor = np.square(0.05 * (a.mean() + b.mean()) / 2)
    log_variance = lambda x: np.log(x.var(axis=0, ddof=1) + floor).mean()
    ratio = lambda x, y: log_variance(y) - log_variance(x)
    without = np.array([ratio(np.delete(a, i, axis=0), np.delete(b, i, axis=0)) for i in range(len(a))])
    return ratio(a, b), math.sqrt((len(a) - 1) * without.var())


def luminance(images):
    return images @ np.array([0.2126, 0.7152, 0.0722])


def compared(old, new):
    """A row of the table: deviates of all tests, and what is printed."""
    a, b = luminance(old[""]), luminance(new[""])
    blocks = lambda x: x.reshape(len(x), HEIGHT // BLOCK, BLOCK, WIDTH // BLOCK, BLOCK).mean(axis=(2, 4)).reshape(len(x), -1)
    layers = sorted(set(old) & set(new))
    of_layers = [deviates(luminance(old[name]).mean(axis=(1, 2)), luminance(new[name]).mean(axis=(1, 2))) for name in layers]
    worst = max(zip(np.abs(of_layers), layers))
    difference = (b - a).mean(axis=(1, 2))
    ratio, error = variance_ratio(a, b)
    return {"difference": difference.mean() / a.mean(), "error": difference.std(ddof=1) / math.sqrt(len(a)) / a.mean(),
            "blocks": np.abs(deviates(blocks(a), blocks(b))).max(), "layers": worst[0], "layer": worst[1] or "all",
            "tests": blocks(a).shape[1] + len(layers) + 1,
            "variance": math.exp(ratio), "variance error": error, "deviate": abs(ratio) / (error + 1e-4)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", help="a program")
    parser.add_argument("new", help="another")
    parser.add_argument("-o", "--output", type=Path, required=True, help="folder of the images and the table")
    parser.add_argument("--scenes", default="", help="regular expression")
    parser.add_argument("--methods", default="", help="regular expression")
    parser.add_argument("--seeds", type=int, default=8, help="of either program")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--redraw", action="store_true", help="take the images that there are")
    options = parser.parse_args()
    if options.seeds < 3:
        parser.error("--seeds: the variance of variances needs three")
    rows = {}
    for scene in (s for s in SCENES if re.search(options.scenes, s)):
        for method in (m for m in METHODS if re.search(options.methods, m)):
            old = renders(options.old, options.output / "old", scene, method, options)
            new = old and renders(options.new, options.output / "new", scene, method, options)
            if old and new and old[""].mean() > 0.0:
                rows[scene, method] = compared(old, new)
                print(f"{scene}, {method}", file=sys.stderr, flush=True)
    limit = -NormalDist().inv_cdf(LEVEL / 2 / sum(r["tests"] for r in rows.values()))
    header = ["scene", "method", "mean difference", "standard error", "blocks", "layers", "layer", "variance ratio", "its error", "its deviate"]
    lines, failed = [",".join(header)], 0
    for (scene, method), r in rows.items():
        differs = max(r["blocks"], r["layers"], r["deviate"]) > limit
        failed += differs
        lines.append(f"{scene},{method},{r['difference']:+.3%},{r['error']:.3%},{r['blocks']:.2f},{r['layers']:.2f},{r['layer']},"
                     f"{r['variance']:.4f},{r['variance error']:.4f},{r['deviate']:.2f}")
        print(lines[-1].replace(",", "  ") + ("  DIFFERS" if differs else ""))
    (options.output / "same_estimates.csv").write_text("\n".join(lines) + "\n")
    print(f"{len(rows)} rows, {sum(r['tests'] for r in rows.values())} tests, deviates up to {limit:.2f}: {failed} rows differ")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
