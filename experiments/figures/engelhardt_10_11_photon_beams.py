#!/usr/bin/python3
"""Approximate bias compensation against the beam radiance estimate at equal time: Engelhardt 2013, Fig. 10.11.

What the smoke of the room scatters more than once, along the ray through the middle of every pixel: by 1536 light paths
with two steps of approximate compensation, and by the photon map with 117 photons in an estimate as in the paper and as
many photons as the same processor time allows, in one pass and in eight. All are judged by `volpath`; the clean
picture, by `mote_layers`, is for the eye alone. Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or
mote is missing. A full run takes 5 minutes of one core, --quick 40 s.

    experiments/figures/engelhardt_10_11_photon_beams.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
import panels
import plotting
from claims import Claims
from measure import LABEL, series_error
from panels import BAR, TITLE, Canvas, clean, enlarged, letter, show, show_difference
from renders import approximate, luminance, main, mean_and_error, write_csv

SCENE, SEEDS = "smoke_room", range(1, 4)
PASSES, BLOCKS = 8, (1, 8)
VPLS, BEAMS, SHARED_OUT = "compensated VPLs", "photon beams", f"photon beams, {PASSES} passes"
# Claims that do not hold as the paper states them, and why.
ONE_WALK = ("photons of a pass share one estimate of the transmittance along each ray. By tracking it was most of their noise; unbiased ray "
            "marching has a tenth of the variance. The paper gives the VPLs a GPU and the photons a processor")
COMPARISONS = [(BEAMS, 1, ONE_WALK), (BEAMS, 8, ONE_WALK), (SHARED_OUT, 1, ONE_WALK), (SHARED_OUT, 8, ONE_WALK)]


def render(mote, quick):
    """Two independent references, and by method the pictures of three seeds; and the seconds that one takes."""
    # Rays through the middle of a pixel: a pass of the photon map takes one a pixel, VPLs many, and with so few pixels
    # what lies within one of them would decide.
    size = {"resx": 32, "resy": 24} if quick else {"resx": 128, "resy": 80}
    size |= {"film.rfilter": "gaussian", "film.rfilter.stddev": 0.02}
    references = [mote.render(SCENE, "reference", size | {"integrator": "volpath"}, passes=300 if quick else 250, seed=s)
                  for s in (101, 102)]
    lights = size | {"paths": 1000 if quick else 1536, "integrator.eye_samples": 64} | approximate(2)
    beams = size | {"integrator": "mote_photon_map", "integrator.neighbours": 117}
    start_lights = mote.render(SCENE, "start_lights", lights | {"paths": 0}, passes=1).cpu
    start_beams = mote.render(SCENE, "start_beams", beams | {"integrator.photon_paths": 100}, passes=1).cpu
    pictures = {VPLS: [mote.render(SCENE, "lights", lights, passes=1, seed=s) for s in SEEDS]}
    seconds = np.mean([p.cpu for p in pictures[VPLS]]) - start_lights
    for name, passes in ((BEAMS, 1), (SHARED_OUT, PASSES)):
        paths = equal_time(lambda paths: mote.render(SCENE, f"pilot_{passes}_{paths}", beams | {"integrator.photon_paths": paths},
                                                     passes=passes).cpu - start_beams, seconds, 100000 // passes)
        settings = beams | {"integrator.photon_paths": paths}
        pictures[name] = [mote.render(SCENE, f"beams_{passes}", settings, passes=passes, seed=s) for s in SEEDS]
    times = {name: np.mean([p.cpu for p in ps]) - (start_lights if name == VPLS else start_beams)
             for name, ps in pictures.items()}
    return references, pictures, times


def equal_time(time_of, seconds, paths):
    """Paths of a pass that take `seconds`, within 3 %: the time grows less than in proportion, so each trial corrects the last."""
    for _ in range(8):
        found = time_of(paths)
        if abs(found / seconds - 1) < 0.03:
            break
        paths = max(1000, int(round(paths * min(8, seconds / found), -3)))
    return paths


def rmse(pictures, references, block):
    """Relative RMSE of one picture over blocks of pixels, and its standard error over seeds. It is no less than the noise between pictures
    of different seeds: references with a noise of 34 % cannot distinguish errors of 3 % from none."""
    shown, exact = ([panels.blocks(x.multiple(), block) for x in which] for which in (pictures, references))
    found = series_error(shown, exact)
    return max(found["error"], found["noise"]), found["error_standard_error"]


def measure(references, pictures):
    """By method: bias, and relative RMSE over blocks of BLOCKS pixels, each with its standard error."""
    mean = np.mean([luminance(r.multiple()).mean() for r in references])
    bias = {name: mean_and_error([luminance(p.multiple()).mean() / mean - 1 for p in ps]) for name, ps in pictures.items()}
    return {name: np.transpose([bias[name], *(rmse(ps, references, b) for b in BLOCKS)]) for name, ps in pictures.items()}


def check(table):
    claims = Claims()
    for other, block, differs in COMPARISONS:
        i = 1 + BLOCKS.index(block)
        text = ", ".join(f"{name} {100 * table[name][0][i]:.1f} +- {100 * table[name][1][i]:.1f} %" for name in (VPLS, other))
        claims.check(f"at equal time {VPLS} are closer to the reference, by a quarter and more, over {block} x {block} pixels",
                     text, table[VPLS][0][i] < 0.75 * table[other][0][i], differs)
    return claims.exit_code()


def bars(axes, table, times):
    """The errors, over pixels and over blocks."""
    for i, block in enumerate(BLOCKS):
        values = [100 * np.array([row[part][1 + i] for row in table.values()]) for part in (0, 1)]
        axes.bar(np.arange(len(table)) + 0.4 * i - 0.2, values[0], yerr=values[1], width=0.38, color=[plotting.BLUE, plotting.ORANGE][i],
                 label="pixels" if block == 1 else f"blocks of {block} x {block} pixels")
    axes.set_xticks(range(len(table)), [name.replace(", ", ",\n") for name in table])
    axes.set(xlabel=f"method, {min(times.values()):.1f} to {max(times.values()):.1f} s of one core", ylabel=f"{LABEL} [%]")
    axes.legend()
    letter(axes)


def draw(references, pictures, times, table, clean, path):
    """Pictures with the noise that they have; differences to volpath over blocks, since it has noise too."""
    reference = 0.5 * sum(r.multiple() for r in references)
    exposure = 0.8 / np.quantile(luminance(clean), 0.985)
    canvas = Canvas(1280, 3 * TITLE + 400 + 2 * 263 + 16 + BAR)
    show(canvas.panel(0, TITLE, 640, 400), clean, exposure, "multiple scattering, by mote_layers, filtered")
    bars(canvas.panel(720, TITLE, 552, 334), table, times)
    y = 2 * TITLE + 408
    for column, (name, ps) in enumerate(pictures.items()):
        show(canvas.panel(429 * column + 1, y, 421, 263), ps[0].multiple(), exposure, f"{name}, {times[name]:.1f} s")
        shown = enlarged(ps[0].multiple() - reference, 4, 263, 421)
        show_difference(canvas.panel(429 * column + 1, y + TITLE + 271, 421, 263), shown, exposure, 3,
                        "less volpath, means over 4 x 4 pixels")
    canvas.save(path)


def figure(mote, quick, output):
    references, pictures, times = render(mote, quick)
    table = measure(references, pictures)
    rows = [[name, float(times[name]), *map(float, np.ravel(np.column_stack(values)))] for name, values in table.items()]
    write_csv(output.with_suffix(".csv"), ["method", "cpu_seconds", "bias", "bias_error"] +
              [f"{what}_{b}" for b in BLOCKS for what in ("relative_rmse", "standard_error")], rows)
    for name, ps in pictures.items():
        what = "vpls" if name == VPLS else "photons_in_media"
        count = np.mean([p.statistics.get(what) or p.value(what) for p in ps])
        mean, error = table[name]
        print(f"                {name}: {count:.0f} {what}, {times[name]:.1f} s, bias {100 * mean[0]:+.1f} +- "
              f"{100 * error[0]:.1f} %")
    size = {"resx": 160, "resy": 100} if quick else {"resx": 640, "resy": 400}
    picture = clean(mote, SCENE, size, passes=32)
    draw(references, pictures, times, table, picture.multiple(), output.with_suffix(".png"))
    return check(table)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
