#!/usr/bin/python3
"""Large scenes, and where the time goes for each virtual point light: Engelhardt 2013, Figs. 10.13 and 10.14.

The atrium (as many triangles as Crytek Sponza, homogeneous haze) and the city (823 thousand triangles in the paper,
clouds, an environment map), with two steps of approximate compensation. Passes without VPLs, with bounded ones, and
with compensation show what each part takes. The clean pictures, by `mote_layers`, are for the eye alone. Exit code 0:
all is as documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes 2.5 minutes of one core, --quick
40 s.

    experiments/figures/engelhardt_10_13_complex.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
import plotting
from claims import Claims
from panels import TITLE, Canvas, clean, enlarged, letter, show
from renders import ROOT, RECOVERED, approximate, luminance, main, write_csv

TRIANGLES = {"atrium": 262, "city": 823}  # thousands, of the paper's scenes
SCALES = {"atrium": 4, "city": 2}  # of what compensation brings back, as it is shown
# Why the city differs: the paper looks up shadow and transmittance of these vertices in maps, on which it spends 60 %.
WALKS = "every vertex casts rays of its own here, which walk through the clouds"
PAPER_SHARE = (0.35, 0.38)  # of the time: multiple scattering with two steps of compensation


def render(mote, quick):
    """By scene, pictures without VPLs, with bounded ones, and compensated."""
    size = {"resx": 24, "resy": 15} if quick else {"resx": 128, "resy": 80}
    result = {}
    for scene, paths in (("atrium", 2000), ("city", 6000)):
        common = size | {"integrator.eye_samples": 32 if quick else 16}
        variants = {"nothing": {"paths": 0}, "bounded": {"paths": paths}, "compensated": {"paths": paths} | approximate(2)}
        result[scene] = {name: mote.render(scene, f"{scene}_{name}", common | settings, passes=1, threads=1)
                         for name, settings in variants.items()}
    return result


def triangles(scene):
    """As mote_geometry counted them, in thousands."""
    last = (ROOT / "scenes" / "generated" / f"{scene}.txt").read_text().split("\n")[-2]
    return int(last.split()[1]) / 1000


def costs(pictures):
    """Nanoseconds of a processor for a VPL and a pixel: without compensation, and of compensation; and its share of both. All
    is processor time, since the machine may have other work; what is done without VPLs too does not count."""
    p = pictures["compensated"]
    seconds = p.cpu - pictures["nothing"].cpu
    share = p.value("compensation_thread_seconds") / seconds
    nanoseconds = 1e9 * seconds / (p.vpls * luminance(p[""]).size)
    return nanoseconds * (1 - share), nanoseconds * share, share


def check(result, quick):
    """The claims; rows of the table."""
    claims, rows = Claims(), []
    for scene, pictures in result.items():
        count, paper = triangles(scene), TRIANGLES[scene]
        claims.check(f"{scene}: as many triangles as the paper's scene (within 5 %)", f"{count:.0f} and {paper} thousand",
                     abs(count / paper - 1) < 0.05)
        rest, compensation, share = costs(pictures)
        compensated, bounded = pictures["compensated"], pictures["bounded"]
        light = luminance(compensated[RECOVERED] + compensated["compensation_surface"]).mean()
        part = light / luminance(compensated[""]).mean()
        ratio = compensated.cpu / bounded.cpu
        rows.append([scene, count, compensated.vpls, rest, compensation, share, part, ratio])
        claims.check(f"{scene}: compensation is finite and brings light back", f"{100 * part:.1f} % of all light",
                     part > 0 and all(np.isfinite(layer).all() for layer in compensated.layers.values()))
        if quick:  # with so few pixels, tracing the light takes most of the time
            continue
        claims.check(f"{scene}: two steps of compensation with what they compensate do not dominate (35 to 38 % of the "
                     f"time)", f"compensation alone {100 * share:.0f} %, {compensation:.0f} of "
                     f"{compensation + rest:.0f} ns for a VPL and a pixel", share < PAPER_SHARE[1],
                     WALKS if scene == "city" else None)
    return claims.exit_code(), rows


def draw(result, cleans, rows, path):
    canvas = Canvas(1280, 2 * (TITLE + 319 + 8) + 20)
    for line, ((scene, pictures), row) in enumerate(zip(result.items(), rows)):
        picture, y = cleans[scene], TITLE + line * (TITLE + 319 + 8)
        exposure = 0.8 / np.quantile(luminance(picture), 0.9)
        show(canvas.panel(0, y, 510, 319), picture, exposure, f"{scene}, {row[1]:.0f} thousand triangles, by mote_layers, filtered")
        recovered = pictures["compensated"][RECOVERED] + pictures["compensated"]["compensation_surface"]
        show(canvas.panel(518, y, 510, 319), enlarged(recovered, 4, *picture.shape[:2]), SCALES[scene] * exposure,
             f"what compensation of {row[2]:.0f} VPLs brings back, x{SCALES[scene]}, 4 x 4 pixels")
        bars(canvas.panel(1100, y, 176, 280), *row[3:5])
    canvas.save(path)


def bars(axes, rest, compensation):
    axes.bar(["the rest", "comp."], [rest, compensation], color=[plotting.GREY, plotting.GREEN], width=0.6)
    axes.set(xlabel="method", ylabel="time of a VPL and a pixel [ns]")
    letter(axes)


def figure(mote, quick, output):
    result = render(mote, quick)
    size = {"resx": 100, "resy": 62} if quick else {"resx": 510, "resy": 319}
    cleans = {scene: clean(mote, scene, size, 16 if quick else 48, f"clean_{scene}")[""] for scene in result}
    code, rows = check(result, quick)
    write_csv(output.with_suffix(".csv"), ["scene", "thousand_triangles", "vpls", "rest_ns", "compensation_ns", "share_of_time",
                                           "share_of_light", "cpu_over_bounded"], rows)
    draw(result, cleans, rows, output.with_suffix(".png"))
    return code


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
