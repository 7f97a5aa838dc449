#!/usr/bin/python3
"""Where epipolar sampling marches rays, and why that suffices: Engelhardt 2013, Fig. 9.1.

A spot light behind a sculpture full of holes, in fog, with the paper's settings: 1024 lines, 32 samples on each, more at
discontinuities of depth alone. The frequency analysis compares light along epipolar lines with light across them. Exit
code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes about 3 minutes on two
cores, --quick 20 s.

    experiments/figures/engelhardt_09_01_samples.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

import numpy as np
import plotting
from claims import Claims
from occluders import sculpture
from panels import TITLE, Canvas, letter, show
from renders import luminance, main, write_csv

SCENE = Path(__file__).resolve().parent / "scenes" / "shafts.xml"
EYE, TARGET, LIGHT, FOV = np.array([0, 1.5, 6]), np.array([0.1, 1.7, 0]), np.array([1.1, 2.5, -2.6]), 60
PAPER = 120000 / (1920 * 1080)


def light_on_film(width, height):
    """Where the scene's light falls on the film [pixels]."""
    z = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
    x = np.cross(z, [0, 1, 0]) / np.linalg.norm(np.cross(z, [0, 1, 0]))
    d = LIGHT - EYE
    scale = 0.5 * width / np.tan(np.radians(FOV / 2)) / (d @ z)
    return np.array([0.5 * width + scale * (d @ x), 0.5 * height - scale * (d @ np.cross(x, z))])


def spectrum(rows):
    """Mean power of the relative variation along rows, by wave number; the line through the ends is taken off."""
    n = rows.shape[1]
    ramp = rows[:, :1] + (rows[:, -1:] - rows[:, :1]) * np.linspace(0, 1, n)
    waves = np.fft.rfft((rows - ramp) / rows.mean(axis=1, keepdims=True), axis=1)
    return np.mean(np.abs(waves) ** 2, axis=0)[1:] / n ** 2


def analyse(light, center, length):
    """Spectra along lines and across them, over stretches of `length` pixels beside and below the sculpture."""
    height, width = light.shape
    near, angles = 0.17 * width, np.radians(np.arange(0, 360, 2.0))
    look = lambda p: light[np.clip(p[..., 1], 0, height - 1).astype(int), np.clip(p[..., 0], 0, width - 1).astype(int)]
    inside = lambda p: (p >= 0).all(axis=(1, 2)) & (p < [width, height]).all(axis=(1, 2))
    steps = np.arange(length)
    u = np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None, :]
    v = np.stack([-np.sin(angles), np.cos(angles)], axis=1)[:, None, :]
    along = center + u * (near + steps)[None, :, None]
    across = center + u * (near + 0.5 * length) + v * (steps - 0.5 * length)[None, :, None]
    both = inside(along) & inside(across)
    rows = [look(p[both]) for p in (along, across)]
    lit = (rows[0].mean(axis=1) > 0.1 * light.mean()) & (rows[1].mean(axis=1) > 0.1 * light.mean())
    return [spectrum(r[lit]) for r in rows]


def draw(paper, ours, full, spectra, length, path):
    wide, high = 635, 357
    canvas = Canvas(1280, 2 * (TITLE + high) + 50)
    panel = lambda column, row: canvas.panel(645 * column, TITLE + row * (high + TITLE + 10), wide, high)
    show(panel(0, 0), paper[""], 0.5 / np.percentile(luminance(full[""]), 90), "epipolar sampling, the paper's settings")
    for axes, picture, text in ((panel(1, 0), paper, "marched rays, the paper's settings"),
                                (panel(0, 1), ours, "marched rays, refined where light varies")):
        rays = picture["MarchedRays"][..., 0]
        coarse = rays.reshape(rays.shape[0] // 2, 2, rays.shape[1] // 2, 2).max(axis=(1, 3))
        show(axes, np.repeat(np.minimum(coarse, 1)[..., None], 3, axis=2), 1, f"{text}: {100 * rays.sum() / rays.size:.1f} %")
    plot(canvas.panel(740, 2 * TITLE + high + 10, 535, high - 15), length / np.arange(1, len(spectra[0]) + 1), spectra)
    canvas.save(path.with_suffix(".png"))


def plot(axes, lengths, spectra):
    """Power by wave length, along lines and across them."""
    for power, name, colour in zip(spectra, ("along epipolar lines", "across"), (plotting.BLUE, plotting.ORANGE)):
        axes.loglog(lengths, power, label=name, color=colour)
    axes.invert_xaxis()
    axes.set(xlabel="wave length [pixels]", ylabel="relative luminance: mean power")
    axes.legend()
    letter(axes)


def figure(mote, quick, output):
    width, height = (960, 540) if quick else (1920, 1080)
    mesh = mote.folder / "sculpture.ply"
    triangles = sculpture(mesh, 100 if quick else 200)
    common = {"resx": width, "resy": height, "mesh": mesh.resolve(), "integrator.steps": 24 if quick else 64,
              "integrator.in_scattering": "steps"}  # as the paper marches
    lines = {"integrator": "mote_epipolar", "integrator.lines": 512 if quick else 1024,
             "integrator.show_samples": True}
    paper = mote.render(SCENE, "paper", common | lines | {"integrator.samples": 32, "integrator.tolerance": 0}, passes=1)
    ours = mote.render(SCENE, "refined", common | lines | {"integrator.samples": 8}, passes=1)
    full = mote.render(SCENE, "full", common | {"integrator": "mote_single_scattering"}, passes=1)

    length = width // 8
    spectra = analyse(luminance(full["single_scattering"]), light_on_film(width, height), length)
    short = slice(3, None)  # wave lengths below a quarter of the stretch
    ratio = spectra[1][short].sum() / spectra[0][short].sum()
    share = {name: p.value("marched_rays") / (width * height) for name, p in (("paper", paper), ("refined", ours))}
    claims = Claims()
    print(f"                {triangles} triangles, {width} x {height}")
    claims.check("in-scattering varies slowly along epipolar lines and fast across (power below a quarter of the stretch)",
                 f"{ratio:.0f} times the power across", ratio > (2 if quick else 5))
    limit = 0.15 if quick else 0.1  # edges take a share that shrinks with the resolution
    claims.check(f"few pixels are ray marched (paper: under {100 * PAPER:.1f} %; here at most {100 * limit:.0f} %)",
                 f"{100 * share['paper']:.1f} %", share["paper"] <= limit)
    claims.check("so it is when lines are refined where light varies, from 8 samples on",
                 f"{100 * share['refined']:.1f} %", share["refined"] <= limit)
    speed = full.cpu / paper.cpu
    claims.check("marching is most of the work: the whole picture takes several times less than at full rate "
                 "(processor time)", f"{speed:.1f} times", speed > (2 if quick else 4))
    write_csv(output.with_suffix(".csv"), ["wave_length_pixels", "power_along", "power_across"],
              [(length / (i + 1), float(a), float(b)) for i, (a, b) in enumerate(zip(*spectra))])
    draw(paper, ours, full, spectra, length, output)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
