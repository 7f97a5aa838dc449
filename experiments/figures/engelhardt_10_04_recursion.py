#!/usr/bin/python3
"""A scan line with virtual point lights, by steps of bias compensation: Engelhardt 2013, Figs. 10.1 and 10.4.

A line through the smoke room: light unbounded, bounded, with one to three steps of compensation, and with all of them
(the paper's reference). All variants share their VPLs, several independent sets of them. The picture of the room, by
`mote_layers`, shows where the line is. Exit code 0: all is as documented; 1: it is not; 2: wrong usage, or mote is
missing. A full run takes 2.5 minutes of one core, --quick half a minute.

    experiments/figures/engelhardt_10_04_recursion.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER] [--bound 5]
"""
import sys

import numpy as np
import plotting
from claims import Claims
from panels import TITLE, Canvas, clean, letter, show, title
from renders import BOUNDED, RECOVERED, approximate, compensation, luminance, main, mean_and_error, write_csv

ROWS = 4  # a line is the mean of so many rows of pixels


def variants():
    kept = {"transmittance": "exact", "local_visibility": True, "strategy": "1-to-1-homogeneous"}
    steps = {f"{n} step{'s' if n > 1 else ''}": approximate(n, **kept) for n in (1, 2, 3)}
    return {**steps, "reference": compensation("exact", strategy="1-to-1-homogeneous")}


def line(image):
    return luminance(image).mean(axis=0)


def render(mote, quick):
    """By variant, an array of seed * column: all light, and what a medium scatters last."""
    seeds = range(3 if quick else 8)
    common = {"resx": 64 if quick else 160, "resy": ROWS, "paths": 150 if quick else 600, "integrator.eye_samples": 64}
    pictures = {name: [mote.render("smoke_room", name.replace(" ", "_"), common | settings, passes=1, seed=s)
                       for s in seeds] for name, settings in variants().items()}
    beauty = {name: np.array([line(p[""]) for p in ps]) for name, ps in pictures.items()}
    multiple = {name: np.array([line(p.multiple()) for p in ps]) for name, ps in pictures.items()}
    lost = lambda p: p[RECOVERED] + p["compensation_surface"]
    beauty["bounded"] = np.array([line(p[""] - lost(p)) for p in pictures["reference"]])
    multiple["bounded"] = np.array([line(p[BOUNDED]) for p in pictures["reference"]])
    return beauty, multiple


def render_few(mote, quick):
    """Multiple scattering of a few VPLs, all of which meet every one of many points of an eye ray: 'unbounded',
    'bounded', 'compensated', and how many VPLs there are on average."""
    common = {"resx": 64 if quick else 120, "resy": ROWS, "paths": 60 if quick else 200,
              "integrator.eye_samples": 20 if quick else 40}
    huge = {**approximate(0, strategy="1-to-n"), "integrator.bound": 1e12}  # without bound, but every eye path meets all VPLs; not replaced by --bound
    exact = compensation("exact", strategy="1-to-n")
    seeds = range(4)
    unbounded, others = ([mote.render("smoke_room", name, common | settings, passes=1, seed=s) for s in seeds]
                         for name, settings in (("few_unbounded", huge), ("few_exact", exact)))
    return {"unbounded": np.array([line(p[BOUNDED]) for p in unbounded]),
            "bounded": np.array([line(p[BOUNDED]) for p in others]),
            "compensated": np.array([line(p.multiple()) for p in others])}, np.mean([p.vpls for p in others])


def peak(few, name):
    """For each set of VPLs, the highest column in units of the compensated light of the same VPLs."""
    return (few[name] / few["compensated"]).max(axis=1)


def percent(values):
    mean, error = mean_and_error(values)
    return mean, error, f"{100 * mean:.1f} +- {100 * error:.1f} %"


def check(beauty, multiple, few):
    claims = Claims()
    high, low = peak(few, "unbounded"), peak(few, "bounded")
    claims.check("unbounded VPLs cause high intensity peaks (the highest of four sets more than twice as bright as it should be), bounded ones do not",
                 "highest column of each set, over the compensated light of the same VPLs: " +
                 ", ".join(f"{x:.2f}" for x in high) + f"; bounded at most {low.max():.2f}",
                 high.max() > 2 and low.max() < 1.1)
    mean = {name: lines.mean(axis=1) for name, lines in multiple.items()}
    loss, error, text = percent(1 - mean["bounded"] / mean["reference"])
    claims.check("clamping darkens significantly (over 10 % of what scatters more than once)", text,
                 loss - 3 * error > 0.1)
    lost = mean["reference"] - mean["bounded"]
    share, error, text = percent((mean["1 step"] - mean["bounded"]) / lost)
    claims.check("one step recovers most of it", text, share - 3 * error > 0.5)
    steps = ["bounded", "1 step", "2 steps", "3 steps"]
    gains = [mean[b] - mean[a] for a, b in zip(steps, steps[1:])]
    ratios = [percent(b / a) for a, b in zip(gains, gains[1:])]
    claims.check("the contribution drops exponentially: each step adds less than half of the one before",
                 ", ".join(r[2] for r in ratios), all(r[0] + 2 * r[1] < 0.5 for r in ratios))
    whole = {name: lines.mean(axis=1) for name, lines in beauty.items()}
    gap, error, text = percent(whole["2 steps"] / whole["reference"] - 1)
    claims.check("two steps match the reference (the whole light within 2 %)", text, abs(gap) + 3 * error < 0.02)
    return claims.exit_code()


def draw(beauty, multiple, few, vpls, clean, path):
    canvas = Canvas(1280, 2 * TITLE + 400 + 368 + 64)
    left, right, below = 66, 715, 2 * TITLE + 440
    room = canvas.panel(left, TITLE, 545, 341)
    show(room, clean, 0.8 / np.quantile(luminance(clean), 0.985), "all light, by mote_layers, filtered, and the line")
    height, width = clean.shape[:2]
    high = ROWS * width / beauty["reference"].shape[1]  # of the line, in pixels of the clean picture
    room.axhspan((height - high) / 2, (height + high) / 2, facecolor="none", edgecolor="white", linewidth=1)
    panels = [canvas.panel(right, TITLE, 545, 341), canvas.panel(left, below, 545, 340), canvas.panel(right, below, 545, 340)]
    columns = lambda lines: (np.arange(lines.shape[1]) + 0.5) / lines.shape[1]
    worst = np.argmax(peak(few, "unbounded"))
    for name, color in (("unbounded", plotting.ORANGE_RED), ("compensated", "black"), ("bounded", plotting.BLUE)):
        panels[0].plot(columns(few[name]), few[name][worst], color=color, linewidth=1.5, label=name)
    title(panels[0], f"one set of about {vpls:.0f} VPLs: multiple scattering")
    panels[0].set_yscale("log")
    for axes, lines, text in ((panels[1], beauty, "brightness"), (panels[2], multiple, "multiple scattering alone")):
        axes.plot(columns(lines["reference"]), lines["reference"].mean(axis=0), color="black", linewidth=3.5, label="reference")
        for name, color in (("bounded", plotting.BLUE), ("1 step", plotting.ORANGE), ("2 steps", plotting.GREEN)):
            axes.plot(columns(lines[name]), lines[name].mean(axis=0), color=color, linewidth=1.5, label=name)
        title(axes, f"mean of {len(lines['reference'])} sets: {text}")
        axes.set_ylim(bottom=0)
    for axes in panels:
        axes.legend()
        axes.set(xlim=(0, 1), xlabel="pixels along the line / all of them", ylabel="luminance [W/(m² sr)]")
        letter(axes)
    canvas.save(path)


def figure(mote, quick, output):
    beauty, multiple = render(mote, quick)
    few, vpls = render_few(mote, quick)
    picture = clean(mote, "smoke_room", {"resx": 160, "resy": 100} if quick else {"resx": 640, "resy": 400}, passes=32)
    rows = [[layer, name, *map(float, mean_and_error(lines.mean(axis=1)))]
            for layer, by_name in (("beauty", beauty), ("multiple_scattering", multiple),
                                  ("few_vpls", few))
            for name, lines in by_name.items()]
    write_csv(output.with_suffix(".csv"), ["layer", "variant", "mean", "standard_error"], rows)
    draw(beauty, multiple, few, vpls, picture[""], output.with_suffix(".png"))
    return check(beauty, multiple, few)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
