#!/usr/bin/python3
"""How many epipolar lines, and how many samples on each: Engelhardt 2013, Fig. 9.11.

The sculpture in fog with 256, 512 and 1024 lines, and 4 to 32 samples on a line besides those at edges, against the picture
that marches every pixel with the same steps; and both with few steps against one with many. Exit code 0: all is as
documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes about 3 minutes on two cores, --quick 30 s.

    experiments/figures/engelhardt_09_11_lines.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

import numpy as np
import measure
import plotting
from claims import Claims
from occluders import sculpture
from panels import TITLE, Canvas, letter, show
from renders import luminance, main, write_csv

SCENE = Path(__file__).resolve().parent / "scenes" / "shafts.xml"
LAYER = "single_scattering"
LINES, SAMPLES = (256, 512, 1024), (4, 8, 16, 32)


def error(picture, reference):
    return measure.error(picture[LAYER], [reference[LAYER]])


def render(mote, quick):
    width, height = (480, 270) if quick else (960, 540)
    mesh = mote.folder / "sculpture.ply"
    sculpture(mesh, 60 if quick else 200)
    common = {"resx": width, "resy": height, "mesh": mesh.resolve(), "integrator.in_scattering": "steps"}
    scale = width / 1920  # the paper's lines are those of 1920 x 1080
    steps, many = (32, 128) if quick else (64, 384)

    def marched(name, n, **settings):
        return mote.render(SCENE, name, {**common, "integrator": "mote_single_scattering", "integrator.steps": n,
                                         **settings}, passes=1)

    def epipolar(lines, samples, n=steps, **settings):
        name = "_".join(map(str, ("lines", lines, samples, n, *settings.values())))
        return mote.render(SCENE, name, {**common, "integrator": "mote_epipolar", "integrator.steps": n,
                                         "integrator.lines": round(lines * scale), "integrator.samples": samples,
                                         "integrator.tolerance": 0,
                                         **settings}, passes=1)
    table = {(n, k): epipolar(n, k) for n in LINES for k in (SAMPLES if not quick else SAMPLES[1::2])}
    # The paper marches in steps of equal length, 150 of them, which were too few.
    uniform = {"integrator.in_scattering": "uniform_steps"}
    few = 20
    return {"table": table, "full": marched("full", steps), "true": marched("true", many), "few": few,
            "few_full": marched("few_full", few, **uniform),
            "few_lines": epipolar(2 * LINES[-1], 16, few, **uniform)}


def draw(pictures, path):
    full, table = pictures["full"], pictures["table"]
    height, width = full[LAYER].shape[:2]
    x, y, w = int(0.15 * width), int(0.55 * height), int(0.22 * width)
    piece = (slice(y, y + int(0.75 * w)), slice(x, x + w))
    exposure = 0.7 / np.percentile(luminance(full[LAYER])[piece], 95)
    samples = max(k for _, k in table)
    wide, high = 420, 315
    canvas = Canvas(1280, 2 * (TITLE + high) + 60)
    panel = lambda column, row: canvas.panel(430 * column, TITLE + row * (high + TITLE + 10), wide, high)
    for column, lines in enumerate(LINES):
        picture = table[lines, samples]
        show(panel(column, 0), picture[LAYER][piece], exposure, f"{lines} lines, {picture.value('marched_rays'):.0f} marched rays")
    show(panel(0, 1), full[LAYER][piece], exposure, f"every pixel, {full.value('marched_rays'):.0f} marched rays")
    show(panel(1, 1), pictures["few_full"][LAYER][piece], exposure, f"every pixel, {pictures['few']} steps of equal length")
    plot(canvas.panel(960, 2 * TITLE + high + 10, 312, high), {key: error(p, full) for key, p in table.items()})
    canvas.save(path.with_suffix(".png"))


def plot(axes, errors):
    """Error by the number of lines and of samples on each."""
    for k, colour in zip(sorted({k for _, k in errors}), (plotting.BLUE, plotting.ORANGE, plotting.GREEN, plotting.BLACK)):
        axes.loglog(LINES, [100 * errors[n, k] for n in LINES], "o-", color=colour, label=f"{k} samples")
    axes.set_xticks(LINES, [str(n) for n in LINES])
    axes.yaxis.set_major_locator(plotting.LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{v:g} %"))
    axes.minorticks_off()
    axes.set(xlabel="epipolar lines of samples", ylabel=f"{measure.LABEL} to every pixel")
    axes.legend()
    letter(axes)


def figure(mote, quick, output):
    pictures = render(mote, quick)
    table, full, true = pictures["table"], pictures["full"], pictures["true"]
    errors = {key: error(p, full) for key, p in table.items()}
    samples = sorted({k for _, k in table})
    crisp = lambda p: np.mean(np.hypot(*np.gradient(luminance(p[LAYER])))) / crispest
    crispest = np.mean(np.hypot(*np.gradient(luminance(full[LAYER]))))
    claims = Claims()
    claims.check("fewer lines make the picture blurrier (mean gradient, as a share of that of every pixel)",
                 ", ".join(f"{n}: {crisp(table[n, samples[-1]]):.3f}" for n in LINES),
                 all(crisp(table[a, samples[-1]]) < crisp(table[b, samples[-1]]) for a, b in zip(LINES, LINES[1:])))
    claims.check("more lines make the error smaller, with any number of samples",
                 "; ".join(f"{k} samples: " + ", ".join(f"{errors[n, k]:.4f}" for n in LINES) for k in samples),
                 all(errors[a, k] > errors[b, k] for k in samples for a, b in zip(LINES, LINES[1:])))
    spread = max(max(errors[n, k] for k in samples) / min(errors[n, k] for k in samples) for n in LINES)
    claims.check("few samples along a line are enough (error of 4 to 32 within 20 %)",
                 f"within {100 * (spread - 1):.0f} %", spread < 1.2)
    smooth = error(pictures["few_lines"], true), error(pictures["few_full"], true)
    claims.check("with too few steps, interpolation along lines is smoother than marching every pixel (error against "
                 "many steps)", f"{smooth[0]:.4f} against {smooth[1]:.4f}, {pictures['few']} steps", smooth[0] < smooth[1])
    write_csv(output.with_suffix(".csv"), ["lines", "samples", "marched_rays", "error"],
              [(n, k, int(table[n, k].value("marched_rays")), errors[n, k]) for n, k in table])
    draw(pictures, output)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
