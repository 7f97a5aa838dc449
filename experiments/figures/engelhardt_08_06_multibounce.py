#!/usr/bin/python3
"""Several bounces of light at the points: virtual point lights, radiosity, a photon map: Engelhardt 2013, Figs. 8.6 to 8.8.

The Cornell box. Virtual point lights and photons of one small set are seen directly (mote_vpl without a bound,
mote_photon_map) and gathered from points that they light; radiosity has one to three bounces, against `path` of
as many. Indirect light alone is measured. A full run takes some 4 minutes of one core, --quick half of one.

    experiments/figures/engelhardt_08_06_multibounce.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
from bundle_figures import with_options
from claims import Claims
from micro_figures import CORNELL, IndirectView, micro, zoom
from panels import TITLE, Canvas, show
from renders import luminance, main, write_csv

DEPTH = 6


def figure(mote, quick, output):
    claims = Claims()
    size = {"resx": 48, "resy": 48} if quick else {"resx": 144, "resy": 144}
    points, buffer, paths, photons = (4096, 12, 32, 4000) if quick else (32768, 16, 64, 10000)
    fine = dict(points=points, micro_buffer=buffer)
    reference_passes = 200
    view = IndirectView(mote, CORNELL, size, reference_passes, "all", depth=DEPTH)
    pairs = {"virtual point lights": (view.render("vpls", {"integrator": "mote_vpl"} | with_options(paths=paths, bound=-1), 1),
                                      view.render("gathered_vpls", micro(light="vpls", paths=paths, bound=0, **fine), 1)),
             "photons": (view.render("photons", {"integrator": "mote_photon_map"} | with_options(photon_paths=photons), 1),
                         view.render("gathered_photons", micro(light="photons", paths=photons, **fine), 1))}
    rows, panels = [], [("path", view.truth)]
    for name, (seen, gathered) in pairs.items():
        claims.check(f"final gathering removes the splotches of {name}: the worst hundredth of the pixels is off by less than two thirds as much",
                     f"{view.worst(seen):.0%} seen directly, {view.worst(gathered):.0%} gathered", view.worst(gathered) < 2 / 3 * view.worst(seen))
        claims.check(f"and the mean of all is that of path within {MEAN:.0%}", f"{view.ratio(gathered) - 1:+.1%}", abs(view.ratio(gathered) - 1) < MEAN)
        for kind, picture in (("seen", seen), ("gathered", gathered)):
            rows.append([f"{name}, {kind}", view.error(picture), view.worst(picture), view.ratio(picture) - 1, picture.cpu])
            panels.append((f"{name}, {kind}", view.light(picture)))
    before = None
    for bounces in (1, 2, 3):
        of = IndirectView(mote, CORNELL, size, reference_passes, f"bounces_{bounces}", depth=2 + bounces)
        picture = of.render("radiosity", micro(light="radiosity", **fine), 1)
        claims.check(f"radiosity of {bounces} bounces is path of as many, its mean within {MEAN:.0%}", f"{of.ratio(picture) - 1:+.1%}, error {of.error(picture):.1%}",
                     abs(of.ratio(picture) - 1) < MEAN)
        mean = of.light(picture).mean()
        if before is not None:
            claims.check(f"bounce {bounces} adds light, as much as path says within a fifth", f"{mean / before[0] - 1:.1%}, path {of.truth.mean() / before[1] - 1:.1%}",
                         abs((mean / before[0] - 1) / (of.truth.mean() / before[1] - 1) - 1) < 0.2)
        before = mean, of.truth.mean()
        rows.append([f"radiosity, {bounces} bounces", of.error(picture), of.worst(picture), of.ratio(picture) - 1, picture.cpu])
        panels.append((f"radiosity, {bounces} bounces", of.light(picture)))
    write_csv(output.with_suffix(".csv"), ["light", "error", "error_of_the_worst_hundredth", "bias_of_the_mean", "cpu_seconds"], rows)
    draw(panels, luminance(view.truth), output)
    return claims.exit_code()


MEAN = 0.08


def draw(panels, light, output):
    height, width = (k * zoom(light.shape[1]) for k in light.shape)
    canvas = Canvas(4 * (width + 10) + 10, 2 * (height + TITLE + 10) + 10)
    for k, (text, image) in enumerate(panels):
        show(canvas.panel(10 + k % 4 * (width + 10), TITLE + k // 4 * (height + TITLE + 10), width, height), image, 0.6 / np.percentile(light, 90), text)
    canvas.save(output.with_suffix(".png"))


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
