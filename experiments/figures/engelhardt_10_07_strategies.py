#!/usr/bin/python3
"""Strategies of bias compensation at equal time: Engelhardt 2013, Figs. 10.6 and 10.7.

Light that the smoke scatters more than once, by the four strategies of Sec. 10.2.3, each with as many passes as fit the
same processor time. Where every vertex of an eye path meets all VPLs, a pass takes one eye path a pixel; the 1-to-1
strategies share the VPLs out among 64. The error is the relative RMSE (measure.py) against two pictures of `volpath`;
the clean picture, by `mote_layers`, is for the eye alone. Exit code 0: all is
as documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes 4 minutes of one core, --quick 45 s.

    experiments/figures/engelhardt_10_07_strategies.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys

import numpy as np
import measure
import plotting
from claims import Claims
from panels import TITLE, Canvas, clean, letter, show
from renders import RECOVERED, approximate, compensation, luminance, main, mean_and_error, write_csv

SHARED = {"integrator.eye_samples": 64}
STRATEGIES = {"1-to-N": compensation("exact", strategy="1-to-n"),
              "N-to-1": compensation("exact", strategy="n-to-1"),
              "1-to-1": compensation("exact", strategy="1-to-1") | SHARED,
              "1-to-1 loc. hom.": approximate(3, strategy="1-to-1-homogeneous") | SHARED}


class EqualTime:
    """Renders of a strategy with as many passes as fit the time; getting started does not count."""

    def __init__(self, mote, common, seconds):
        self.mote, self.common, self.seconds = mote, common, seconds
        self.start = {name: self.render(name, "_start", 1, 1, {"paths": 0}).cpu for name in STRATEGIES}
        pilot = 4
        self.passes = {}
        for name in STRATEGIES:
            cpu = self.render(name, "_pilot", pilot, 1).cpu - self.start[name]
            self.passes[name] = min(max(1, round(self.seconds * pilot / max(cpu, 0.01))), 40 * pilot)

    def render(self, name, suffix, passes, seed, settings={}):
        return self.mote.render("smoke_room", name.replace(" ", "_").replace(".", "") + suffix,
                                self.common | STRATEGIES[name] | settings, passes=passes, seed=seed)


def render(mote, quick):
    """Two independent references, by strategy the pictures of three seeds, and what made them."""
    size = {"resx": 24, "resy": 15} if quick else {"resx": 96, "resy": 60}
    references = [mote.render("smoke_room", "reference", size | {"integrator": "volpath"}, seed=s, passes=500) for s in (98, 99)]
    equal = EqualTime(mote, size | {"paths": 100 if quick else 200}, 1.5 if quick else 6)
    pictures = {name: [equal.render(name, "", equal.passes[name], seed) for seed in range(2, 5)] for name in STRATEGIES}
    return references, pictures, equal


def error_of(picture, references):
    return measure.error(picture.multiple(), [r.multiple() for r in references])


def spread_of_a_pass(pictures):
    """Noise of one pass in what compensation brings back, from how seeds differ."""
    values = [p[RECOVERED] for p in pictures]
    return measure.series_error(values, [np.mean(values, axis=0)])["noise"] * pictures[0].passes ** 0.5


def check(rmse, pictures):
    claims = Claims()
    mean = {name: mean_and_error(errors) for name, errors in rmse.items()}
    text = lambda *names: ", ".join(f"{n} {100 * mean[n][0]:.1f} +- {100 * mean[n][1]:.1f} %" for n in names)
    for name in ("1-to-1", "1-to-1 loc. hom."):
        claims.check(f"{name} clearly beats 1-to-N and N-to-1 at equal time (by a factor of 1.3 and more)",
                     text(name, "1-to-N", "N-to-1"),
                     all(mean[o][0] - 2 * mean[o][1] > 1.3 * (mean[name][0] + 2 * mean[name][1]) or
                         mean[o][0] > 1.6 * mean[name][0] for o in ("1-to-N", "N-to-1")))
    claims.check("N-to-1 has less noise than 1-to-N at equal time (by a tenth and more)", text("N-to-1", "1-to-N"),
                 mean["N-to-1"][0] < 0.9 * mean["1-to-N"][0],
                 "with one eye path a pass, where it ends makes most of the noise of both, and N-to-1 takes longer a pass: "
                 "here one vertex joined to all VPLs costs a twentieth of the pass, vertices for each a fifth")
    spread = {name: spread_of_a_pass(pictures[name]) for name in ("N-to-1", "1-to-N")}
    claims.check("N-to-1 has less noise than 1-to-N, pass by pass, in what compensation brings back",
                 ", ".join(f"{name} {100 * x:.0f} %" for name, x in spread.items()), spread["N-to-1"] < spread["1-to-N"])
    return claims.exit_code()


def draw(clean, pictures, rmse, equal, path):
    """Pictures with the noise that they have, beside the clean one and the errors."""
    canvas = Canvas(1280, 2 * (TITLE + 263) + 13)
    exposure = 0.8 / np.quantile(luminance(clean), 0.985)
    show(canvas.panel(1, TITLE, 421, 263), clean, exposure, "multiple scattering, by mote_layers, filtered")
    for i, (name, ps) in enumerate(pictures.items()):
        place = canvas.panel(430 + 429 * (i % 2), TITLE + (TITLE + 275) * (i // 2), 421, 263)
        show(place, ps[0].multiple(), exposure, f"{name}: {ps[0].passes} passes")
    bars(canvas.panel(76, 2 * TITLE + 275, 346, 263 - 42), {name: mean_and_error(errors) for name, errors in rmse.items()}, equal.seconds)
    canvas.save(path)


def bars(axes, errors, seconds):
    """Relative RMSE and its standard error, by strategy."""
    for x, (mean, error) in enumerate(errors.values()):
        axes.bar(x, 100 * mean, yerr=100 * error, color=[plotting.GREY, plotting.GREY, plotting.BLUE, plotting.GREEN][x], width=0.6)
    axes.set_xticks(range(len(errors)), [name.replace("1-to-1 ", "") for name in errors])
    axes.set(xlabel=f"method, {seconds} s of processor time", ylabel=f"{measure.LABEL} [%]")
    letter(axes)


def figure(mote, quick, output):
    references, pictures, equal = render(mote, quick)
    rmse = {name: [error_of(p, references) for p in ps] for name, ps in pictures.items()}
    rows = [[name, *map(float, mean_and_error(rmse[name])), ps[0].passes, float(np.mean([p.cpu for p in ps]) - equal.start[name])]
            for name, ps in pictures.items()]
    write_csv(output.with_suffix(".csv"), ["strategy", "relative_rmse", "standard_error", "passes", "cpu_seconds"], rows)
    for row in rows:
        print(f"                {row[0]}: {row[3]} passes, {row[4]:.1f} s")
    picture = clean(mote, "smoke_room", {"resx": 160, "resy": 100} if quick else {"resx": 640, "resy": 400}, passes=32)
    draw(picture.multiple(), pictures, rmse, equal, output.with_suffix(".png"))
    return check(rmse, pictures)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
