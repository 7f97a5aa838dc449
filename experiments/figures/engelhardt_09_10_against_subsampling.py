#!/usr/bin/python3
"""Epipolar sampling against plain sub-sampling: Engelhardt 2013, Fig. 9.10.

Five scenes: a sculpture full of holes, the crown of a tree and a window with bars before a spot light, three spot lights,
and smoke from a VDB file. In each, one pass with all samples at the same places and march steps as in the picture that
marches every pixel, so that the difference is the error of interpolation alone. Sub-sampling interpolates the same
quantity with the same test of depth. Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is missing.
A full run takes about 2 minutes on two cores, --quick 50 s.

    experiments/figures/engelhardt_09_10_against_subsampling.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

import numpy as np
from claims import Claims
from occluders import crown, sculpture
from measure import LABEL, series_error
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

SCENES = Path(__file__).resolve().parent / "scenes"
LAYER = "single_scattering"
FULL, LINES = {"integrator": "mote_single_scattering"}, {"integrator": "mote_epipolar"}


def scenes(mote, quick):
    """By name: the file, its settings, size, and how it is sampled."""
    meshes = {"sculpture": mote.folder / "sculpture.ply", "crown": mote.folder / "crown.ply"}
    sculpture(meshes["sculpture"], 60 if quick else 200)
    crown(meshes["crown"], 5000 if quick else 30000)
    mesh = lambda name: {"mesh": meshes[name].resolve()}
    few = {"integrator.samples": 8, "integrator.steps": 32 if quick else 64}
    n = 3 if quick else 1
    return {"sculpture": (SCENES / "shafts.xml", mesh("sculpture"), (1920 // n, 1080 // n), few),
            "crown of leaves": (SCENES / "shafts.xml", mesh("crown"), (960 // n, 540 // n), few),
            "window with bars": ("fog_grille", {}, (960 // n, 600 // n), few),
            "three lights": (SCENES / "three_lights.xml", mesh("sculpture"), (960 // n, 540 // n), few),
            "smoke, VDB": ("smoke_room", {"lamp": "0, 0, 0"}, (80, 60) if quick else (640, 480),  # the lamp is sampled, not marched
                           {**few, "integrator.steps": 16, "integrator.voxels": 2})}


def relative_mse(picture, full):
    """Square of the relative RMSE, against the picture at full rate."""
    return series_error([picture[LAYER]], [full[LAYER]])["squared_error"]


def gradient(picture):
    """Mean length of the relative gradient: crispness."""
    light = luminance(picture[LAYER])
    dy, dx = np.gradient(light)
    return np.mean(np.hypot(dx, dy)) / light.mean()


def render(mote, name, scene, settings, size, sampling):
    settings = {"resx": size[0], "resy": size[1], **settings}
    march = {k: v for k, v in sampling.items() if k in ("integrator.steps", "integrator.voxels")}
    tag = name.replace(" ", "_").replace(",", "")
    full = mote.render(scene, tag + "_full", {**settings, **FULL, **march}, passes=1)
    # As many lines for a pixel of the border as the paper has: 1024 for 6000.
    lines = {"integrator.lines": round(1024 * sum(size) / 3000)}
    epipolar = mote.render(scene, tag + "_lines", {**settings, **LINES, **lines, **sampling}, passes=1)
    rays = epipolar.value("marched_rays")

    def grid(times):
        # Some pixels that nothing continues are marched beside the grid's: a little closer than the number requests.
        spacing = (full.value("lit_pixels") / (times * 1.02 * rays)) ** 0.5
        return mote.render(scene, f"{tag}_grid_{times}", {**settings, **FULL, **march, "integrator.sampling": "sub_sampled",
                                                          "integrator.spacing": spacing}, passes=1)
    return {"full": full, "lines": epipolar, "grid": grid(1), "grid x 4": grid(4)}


def draw(all_pictures, path):
    """A line for each scene: a piece where shafts are fine, magnified, by every way of sampling."""
    columns = {"full": "every pixel", "lines": "epipolar lines", "grid": "grid, as many", "grid x 4": "grid, 4 times"}
    wide, high = 313, 175
    canvas = Canvas(1280, len(all_pictures) * (2 * TITLE + high + 4))
    for row, (name, pictures) in enumerate(all_pictures.items()):
        full = pictures["full"]
        height, width = full[LAYER].shape[:2]
        x, y, w = int(0.32 * width), int(0.52 * height), int(0.3 * width)
        piece = (slice(y, y + int(0.56 * w)), slice(x, x + w))
        exposure = 0.6 / max(np.percentile(luminance(full[LAYER])[piece], 95), 1e-9)
        for column, (kind, text) in enumerate(columns.items()):
            rays = pictures[kind].value("marched_rays") / full.value("lit_pixels")
            below = name if kind == "full" else f"{LABEL} {relative_mse(pictures[kind], full) ** 0.5:.1%}"
            show(canvas.panel(322 * column, row * (2 * TITLE + high + 4) + 2 * TITLE, wide, high), pictures[kind][LAYER][piece], exposure,
                 f"{text}: {100 * rays:.1f} % of the rays\n{below}")
    canvas.save(path.with_suffix(".png"))


def figure(mote, quick, output):
    claims, rows, all_pictures = Claims(), [], {}
    smoke = "smoke varies along the lines as much as across them; there is no direction to make use of"
    dark = "errors are relative to a pixel's light: in the dark, four times as many samples help more than their places"
    for name, (scene, settings, size, sampling) in scenes(mote, quick).items():
        pictures = all_pictures[name] = render(mote, name, scene, settings, size, sampling)
        error = {k: relative_mse(p, pictures["full"]) for k, p in pictures.items()}
        rays = {k: p.value("marched_rays") for k, p in pictures.items()}
        seconds = {k: p.cpu for k, p in pictures.items()}
        share, speed = rays["lines"] / rays["full"], seconds["full"] / seconds["lines"]
        print(f"{name}, {size[0]} x {size[1]}: {100 * share:.1f} % of the rays, {speed:.1f} times as fast as every pixel, "
              f"{LABEL} {error['lines'] ** 0.5:.4f}")
        crisp = {k: gradient(p) / gradient(pictures["full"]) for k, p in pictures.items()}
        rows += [(name, k, int(rays[k]), rays[k] / rays["full"], float(error[k]), float(crisp[k]), seconds[k])
                 for k in pictures]
        heterogeneous = name.startswith("smoke")
        if name == "sculpture" and not quick:
            claims.check("at most 10 % of the pixels are marched at 1920 x 1080", f"{100 * share:.1f} %", share <= 0.1)
        if quick and name != "sculpture":
            continue  # too few pixels for the shafts of the others
        claims.check(f"{name}: less error than a grid of as many rays",
                     f"{error['lines']:.2e} against {error['grid']:.2e}, {rays['grid'] / rays['lines']:.2f} times the rays",
                     error["lines"] < error["grid"] and rays["grid"] >= rays["lines"], smoke if heterogeneous else None)
        claims.check(f"{name}: less error than a grid of four times as many rays",
                     f"{error['lines']:.2e} against {error['grid x 4']:.2e}, "
                     f"{rays['grid x 4'] / rays['lines']:.2f} times the rays",
                     error["lines"] < error["grid x 4"] and rays["grid x 4"] >= 4 * rays["lines"],
                     smoke if heterogeneous else dark if name == "three lights" else None)
        if name == "sculpture":
            claims.check("and it looks crisper (mean gradient, as a share of that at full rate)",
                         f"{crisp['lines']:.3f}, grids {crisp['grid']:.3f} and {crisp['grid x 4']:.3f}",
                         crisp["lines"] > crisp["grid"])
    write_csv(output.with_suffix(".csv"),
              ["scene", "sampling", "marched_rays", "share", "relative_mse", "relative_gradient", "processor_seconds"], rows)
    draw(all_pictures, output)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
