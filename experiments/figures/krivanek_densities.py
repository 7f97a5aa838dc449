#!/usr/bin/python3
"""Noise of points, of points beside beams and of crossing beams by the density of the medium: Krivanek et al. 2014.

Each of pp3d, pb2d and bb1d renders alone by mote_upbp: light scattered once by a ball of fog, and all light in a ball of glass
full of fog, like the still life of the paper. Noise is the standard deviation of one pass over the mean, both rms over pixels,
without bias for the mean's own noise; its standard error is a jackknife over seeds. A film of 10 x 10 pixels has 100 light paths
a pass: with as many, and with alpha = 1, all techniques have kernels of one radius in every pass
(integrators/upbp/merge_schedule.h). Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is missing. A full
run takes five minutes of one core, --quick half a minute.

    experiments/figures/krivanek_densities.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

import numpy as np
import plotting
from claims import Claims
from origin import tables_of
from renders import main, write_csv

SCENES = Path(__file__).resolve().parent / "scenes"
# Kernel radius [m], a tenth of each ball's, and the longest path.
ROWS = {"ball of fog": (SCENES / "fog_ball.xml", 0.1, 2), "glass ball of fog": (SCENES / "still_life.xml", 0.03, -1)}
TECHNIQUES = {name: plotting.colour(name) for name in ("pp3d", "pb2d", "bb1d")}
NAMES = {"pp3d": "points, pp3d", "pb2d": "points beside\nbeams, pb2d", "bb1d": "crossing\nbeams, bb1d"}
PASSES = {"pp3d": 2000, "pb2d": 1000, "bb1d": 250}  # of a seed: points are fast and rarely find light
DEPTHS = (0.01, 0.1, 1.0, 10.0)  # optical depth of the kernel's radius
FILM = {"resx": 10, "resy": 10}


def only(technique):
    return {f"integrator.{t}": t == technique for t in ("bpt", "surf", *TECHNIQUES)}


def noise(pictures, passes):
    variance = np.mean([p["Variance"] for p in pictures])
    square = np.mean(np.mean([p[""] for p in pictures], axis=0) ** 2) - variance / len(pictures)
    return np.sqrt(passes * variance / square)


def jackknife(pictures, passes):
    """Noise and its standard error."""
    without = [noise(pictures[:i] + pictures[i + 1:], passes) for i in range(len(pictures))]
    return noise(pictures, passes), np.std(without) * (len(pictures) - 1) ** 0.5


def measure(mote, name, depth, quick):
    """By technique: noise, its standard error, and photons in the medium a pass."""
    scene, radius, max_depth = ROWS[name]
    common = FILM | {"integrator": "mote_upbp", "integrator.alpha": 1, "sigma_t": depth / radius, "integrator.max_depth": max_depth}
    tag = f"{name.replace(' ', '_')}_{depth:g}"
    size = mote.render(scene, f"{tag}_size", common | only("surf") | {"integrator.radius": 1}, 1).value("kernel_radius_surface")
    found = {}
    for t in TECHNIQUES:
        passes = PASSES[t] // (10 if quick else 1)
        pictures = [mote.render(scene, f"{tag}_{t}", common | only(t) | {"integrator.radius": radius / size}, passes, seed=s)
                    for s in range(1, 5 if quick else 9)]
        photons = np.mean([p.value("light_vertices_in_media") for p in pictures]) / passes
        found[t] = (*jackknife(pictures, passes), photons)
    return found


def less(found, *techniques):
    """True if each technique has less noise than the next, by more than three standard errors."""
    pairs = zip(techniques, techniques[1:])
    return all(found[b][0] - found[a][0] > 3 * np.hypot(found[a][1], found[b][1]) for a, b in pairs)


def check(tables):
    claims = Claims()
    for name, table in tables.items():
        thin, dense = DEPTHS[0], DEPTHS[-1]

        def text(depth):
            return ", ".join(f"{t} {100 * table[depth][t][0]:.0f} +- {100 * table[depth][t][1]:.0f} %" for t in TECHNIQUES)

        claims.check(f"{name}, thin: crossing beams have least noise, points most", text(thin), less(table[thin], "bb1d", "pb2d", "pp3d"))
        claims.check(f"{name}, dense: points have least noise, crossing beams most", text(dense), less(table[dense], "pp3d", "pb2d", "bb1d"))
        photons = [[row[2] for row in table[d].values()] for d in DEPTHS]
        spread = max(max(row) / min(row) - 1 for row in photons)
        claims.check(f"{name}: all techniques have as many photons a pass", f"{100 * spread:.1f} % apart at most", spread < 0.1)
    return claims.exit_code()


def plot_table(table, path):
    """A panel for each scene: the noise of each technique by the optical depth of the kernel's radius."""
    rows = tables_of(table)[0]
    made, panels = plotting.figure(columns=len(ROWS), height=400, sharey=True)
    for name, axes in zip(ROWS, panels):
        ends = []
        for t, own in TECHNIQUES.items():
            x, y, error = np.array([[r["depth"], r["noise"], r["standard_error"]] for r in rows if (r["scene"], r["technique"]) == (name, t)]).T
            axes.errorbar(x, y, error, fmt="o-", ms=5, lw=1.5, color=own)
            ends.append((NAMES[t], x[-1], y[-1], own))
        axes.set_title(name)
        plotting.log_axes(axes, "optical depth of the kernel's radius", "noise of one pass")
        axes.xaxis.set_major_locator(plotting.FixedLocator(DEPTHS))
        plotting.label_ends(axes, ends, gap=32)
    plotting.save(made, path)


def run(mote, quick, output):
    tables = {name: {d: measure(mote, name, d, quick) for d in DEPTHS} for name in ROWS}
    write_csv(output.with_suffix(".csv"), ["scene", "depth", "technique", "noise", "standard_error", "photons"],
              [[name, d, t, *map(float, values)] for name, table in tables.items() for d, found in table.items() for t, values in found.items()])
    plot_table(output.with_suffix(".csv"), output.with_suffix(".png"))
    return check(tables)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
