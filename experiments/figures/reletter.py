#!/usr/bin/python3
"""Plots pictures of the gallery anew whose runs are long: their panels, pixel by pixel as the full run left them (in commit FROM of this
repository), with words of a size that can be read, plots from their tables, and signed differences, of red and green once, in blue and red with a colour bar.
Nothing is rendered, and no number changes.

Once a figure's script has run again, its own picture takes the place, and its entry goes.

    experiments/figures/reletter.py [NAME...]
"""
import csv
import io
import re
import subprocess
import sys

import blender_runs
import engelhardt_09_01_samples as samples
import engelhardt_09_11_lines as lines
import engelhardt_10_07_strategies as strategies
import engelhardt_10_13_complex as complex_scenes
import engelhardt_11_03_hierarchy as hierarchy
import matplotlib.pyplot as plt
import numpy as np
import sun_05_equal_time as equal_time
from origin import ROOT, csv_text, table_of, tables_of, write_png_text
from panels import BAR, Canvas, letters, show_difference, title

FROM = "067d946fc0f6"
GAP = 10  # pixels between panels


class Sheet:
    """What a figure holds: panels of its PNG by rows, from left to right, and rows of its table."""

    def __init__(self, name, *rows):
        """rows: (top, lefts, width, height) in pixels."""
        self.table = ROOT / f"docs/gallery/{name}.csv"
        shown = subprocess.run(["git", "show", f"{FROM}:docs/gallery/{name}.png"], cwd=ROOT, capture_output=True, check=True).stdout
        image = np.round(plt.imread(io.BytesIO(shown))[..., :3] * 255).astype(np.uint8)
        self.panels = [image[y:y + height, x:x + width] for y, lefts, width, height in rows for x in lefts]

    def rows(self):
        return tables_of(self.table)[0]

    def row(self, **values):
        """The row of the table with these cells."""
        return next(r for r in self.rows() if all(r[k] == v for k, v in values.items()))


    def measured(self, claim):
        """What the claim that begins so measured."""
        return next(row[1] for row in csv.reader(table_of(self.table).splitlines()) if row[0].startswith(claim))


class Difference:
    """A panel of a signed difference: its values as fractions of full colour, read back from its colours of 8 bits."""

    def __init__(self, panel, times):
        self.times, self.shape = times, panel.shape
        if np.all(panel[..., 2] <= panel[..., :2].min(axis=2) + 1):  # red less green, as differences were shown once, over a dim grey scene
            self.values = (panel[..., 0] / 255) ** 2.2 - (panel[..., 1] / 255) ** 2.2
        else:
            panel = np.pad(panel[2:-2, 2:-2], [(2, 2), (2, 2), (0, 0)], mode="edge")  # without the frame of its axes
            known = np.round(plt.get_cmap("RdBu_r")(np.linspace(0, 1, 256))[:, :3] * 255)
            apart = np.abs(panel.reshape(-1, 1, 3) - known).sum(axis=2)
            if apart.min(axis=1).max() > 6:
                raise ValueError("colours that are none of RdBu_r")
            self.values = (apart.argmin(axis=1) / 127.5 - 1).reshape(panel.shape[:2])

    def show(self, axes, text):
        show_difference(axes, np.repeat(self.values[..., None], 3, axis=2) / self.times, 1, self.times, text)


def put(axes, panel, text):
    if isinstance(panel, Difference):
        panel.show(axes, text)
        return
    axes.imshow(panel, interpolation="nearest", aspect="auto")
    axes.set(xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_visible(False)
    if text:
        title(axes, text)


def laid_out(sheet, columns, texts, beside=None, more=(0, 0)):
    """The panels with their texts, so many a row. `beside`: draws plots into the canvas, which is `more` pixels wider and higher."""
    texts = [re.sub(r"(\d)%", r"\1 %", text) for text in texts]
    lines = [list(zip(sheet.panels, texts, strict=True))[k:k + columns] for k in range(0, len(texts), columns)]
    width = max(sum(p.shape[1] + GAP for p, _ in line) - GAP for line in lines) + more[0]
    words = round(max(11, 0.91 * width / 100) * 100 / 72 * 1.35)  # of a line of text [pixels]
    above = [max(text.count("\n") * words + words + 6 if text else 0 for _, text in line) for line in lines]
    heights = [max(p.shape[0] + BAR * isinstance(p, Difference) for p, _ in line) for line in lines]
    canvas, y = Canvas(width, sum(above) + sum(heights) + 4 * (len(lines) - 1) + more[1]), 0
    for line, words_above, high in zip(lines, above, heights):
        x, y = 0, y + words_above
        for panel, text in line:
            put(canvas.panel(x, y, panel.shape[1], panel.shape[0]), panel, text)
            x += panel.shape[1] + GAP
        y += high + 4
    if beside:
        beside(canvas, y)
    picture = sheet.table.with_suffix(".png")
    canvas.save(picture)
    write_png_text(picture, csv_text(sheet.table))


def hermes(name, tops=(18,)):
    return Sheet(name, *((y, (12, 518), 494, 308) for y in tops))


def hermes_07_interleaved():
    sheet = hermes("hermes_07_interleaved")
    noise = [sheet.row(transfer=t, directions=512)["noise"] for t in ("one_bounce", "interleaved")]
    laid_out(sheet, 2, [f"{name}, 512 directions:\nindirect light, noise {n:.1%}" for name, n in zip(("one bounce at a time", "interleaved"), noise)])


def hermes_08_glossy():
    laid_out(hermes("hermes_08_glossy", (26, 360)), 2, ["several glossy bounces", "a final glossy bounce", "path tracing", "what glossy surfaces reflect on others, x 3"])


def hermes_09_path_tracing():
    sheet = hermes("hermes_09_path_tracing")
    text = "{}, {processor_seconds:.0f} s: relative RMSE {error:.1%}"
    laid_out(sheet, 2, [text.format("ray-bundles", **sheet.row(method="bundles")), text.format("path tracing", **sheet.row(method="path"))])


def hermes_11_direct_apart():
    sheet = hermes("hermes_11_direct_apart")
    error = {k: sheet.row(direct_light=k)["error"] for k in ("bundles", "lights")}
    laid_out(sheet, 2, [f"direct light by bundles: relative RMSE {error['bundles']:.1%}", f"direct light apart: relative RMSE {error['lights']:.1%}"])


def sun_05_cornell():
    sheet = Sheet("sun_05_cornell", *((y, (1, 430, 859), 420, 420) for y in (26, 476, 926)))
    laid_out(sheet, 3, [text for r in sheet.rows() for text in (f"{r['scene']}: reference", f"from both ends: relative RMSE {r['error_both_ends']:.0%}",
                                                            f"from the eye: relative RMSE {r['error_eye']:.0%}")])


def sun_05_denoised():
    sheet = Sheet("sun_05_denoised", *((y, (1, 307, 613, 919, 1225), 300, 300) for y in (26, 358, 690)))
    texts = []
    for scene in dict.fromkeys(r["scene"] for r in sheet.rows()):
        texts += [f"{n} a pixel, {shown}: {sheet.row(scene=scene, samples_a_pixel=n, picture=kind)['error']:.1%}"
                  for n in (1, 16) for kind, shown in (("raw", "raw"), ("bmfr", "BMFR"))] + [f"{scene}: reference"]
    laid_out(sheet, 5, texts)


def sun_05_equal_time():
    sheet = Sheet("sun_05_equal_time", *((y, (1, 430, 859), 420, 420) for y in (26, 476)))
    texts = []
    for scene in ("mirror wall", "water caustic"):
        both, eye = (equal_time_passes(sheet.table, scene, k) for k in ("both_ends", "eye"))
        texts += [f"{scene}: reference", f"from both ends, {both} samples, equal time", f"from the eye, {eye} samples, equal time"]
    gains = {r["scene"]: r["times_faster"] for r in sheet.rows()}
    laid_out(sheet, 3, texts, lambda canvas, y: equal_time.bars(canvas.panel(90, y + 10, 1180, 230), gains), (0, 300))


def equal_time_passes(table, scene, method):
    """Passes of the picture at equal time, which the origin of the table states."""
    name = f"equal_{'mote_bdpt' if method == 'both_ends' else 'volpath'}_{scene.replace(' ', '_')},"
    return next(re.search(r'"passes": (\d+)', text)[1] for text in csv_text(table).values() if text.startswith(name))


def tokuyoshi_04_mis():
    sheet = Sheet("tokuyoshi_04_mis", *((y, (10, 500, 990, 1480), 480, 300) for y in (26, 362)))
    methods = [sheet.row(method=m) for m in ("vpls", "bundles", "combined")]
    whole, pieces = sheet.panels[:4], sheet.panels[4:]
    sheet.panels = [*whole[:3], *pieces[:3], whole[3], pieces[3]]
    names = ("(a) virtual point lights", "(b) bundles", "(c) combined")
    laid_out(sheet, 3, [f"{name}: relative RMSE {m['error']:.1%}" for name, m in zip(names, methods)] +
          [f"corners {m['error_corner']:.1%}, wall {m['error_bright_spot']:.1%}" for m in methods] +
          ["path, for comparison", "red: corners, blue: lit by the spot"])


def tokuyoshi_06_environment():
    sheet = Sheet("tokuyoshi_06_environment", (26, (10, 380, 750, 1120), 360, 240), (292, (10, 380, 750), 360, 240))
    error = lambda n, ways: sheet.row(directions=n, directions_serve=ways)["error"]
    laid_out(sheet, 4, [f"{n} directions, {ways}:\nrelative RMSE {error(n, ways):.1%}" for n, ways in ((16, "both ways"), (16, "one way"), (32, "one way"))] +
          ["path"] + [f"time = {t}, 32 directions, both ways" for t in (0, 60, 120)])


def tokuyoshi_07_two_bounce():
    sheet = Sheet("tokuyoshi_07_two_bounce", *((y, (10, 340, 670, 1000, 1330), 320, 200) for y in (26, 252)))
    names = ("VPLs", "bundles", "combined", "two bounces,\nbounded", "two bounces,\nweighted")
    laid_out(sheet, 5, [f"time {r['time']:.0f}, {name}: {r['error']:.1%}" for r, name in zip(sheet.rows(), 2 * names)])


def tokuyoshi_08_glossy():
    sheet = Sheet("tokuyoshi_08_glossy", *((y, (10, 420, 830, 1240), 400, 400) for y in (26, 452)), (878, (10, 420, 830), 400, 268))
    rows = sheet.rows()
    box = [f"{r['method'].replace('with bundles and', 'bundles,')}:\n{r['error']:.0%}, mean {r['bias']:+.1%}" for r in rows if not r["method"].startswith("sky")]
    sky = [f"{r['method']}: {r['error']:.0%}" for r in rows if r["method"].startswith("sky")]
    laid_out(sheet, 4, [*box, "path", *sky, "path"])


def tokuyoshi_09_path_tracing():
    sheet = Sheet("tokuyoshi_09_path_tracing", (26, (10, 340, 670, 1000), 320, 200))
    rows = [r for r in sheet.rows() if not r["method"].startswith("share")]
    laid_out(sheet, 4, [f"{r['method'].replace('combined, ', 'combined,' + chr(10))}: {r['error']:.1%}, {r['cpu_seconds']:.1f} s" for r in rows] + ["path, for comparison"])


def tokuyoshi_11_reuse():
    laid_out(Sheet("tokuyoshi_11_reuse", (26, (10, 404, 798, 1192), 384, 240)), 4,
          ["one bounce, 55 directions", "four bounces, 55 directions", "four, many passes of 55", "path, for comparison"])


def engelhardt_07_octahedral():
    sheet = Sheet("engelhardt_07_octahedral", *((y, (30, 262, 495, 727), 222, 222) for y in (29, 267)))
    blurs = [f"{blur} sr" for blur in ("0.00085", "0.03", "0.34", "2")]
    laid_out(sheet, 4, [f"{what}, {blur}" for what in ("summed areas", "round lobes") for blur in blurs], more=(50, 0))


def engelhardt_08_13_raycast():
    sheet = Sheet("engelhardt_08_13_raycast", (26, (10, 532, 1054), 512, 320), (382, (532, 1054), 512, 320))
    sheet.panels = [*sheet.panels[:3], np.full_like(sheet.panels[0], 255), *(Difference(p, 3) for p in sheet.panels[3:])]
    laid_out(sheet, 3, ["path", *(f"{r['ray_casting']}: relative RMSE {r['error']:.1%}" for r in sheet.rows()), "", "difference", "difference"])


def smoke_room(name, texts, differences):
    """The room in which a frame is enlarged, and differences below."""
    sheet = Sheet(name, (26, (0,), 640, 400), (26, (648, 861, 1074), 205, 400), (460, (0, 644), 636, 398))
    sheet.panels[4:] = [Difference(p, times) if times else p for p, times in zip(sheet.panels[4:], differences)]
    above, below = sheet.panels[:4], sheet.panels[4:]
    sheet.panels = above

    def second(canvas, y):
        for k, (panel, text) in enumerate(zip(below, texts[4:])):
            put(canvas.panel(646 * k, y + 30, 636, 398), panel, text)
    laid_out(sheet, 4, texts[:4], second, (0, 436 + BAR))


def engelhardt_10_05_locally_homogeneous():
    smoke_room("engelhardt_10_05_locally_homogeneous", ["all light, by mote_layers, filtered; the frame is enlarged", "exact", "mean extinction",
               "16 times\nthe difference", "difference, means over 4 x 4 pixels", "the picture if the difference were 16 times as large"], (16, None))


def engelhardt_10_10_room():
    smoke_room("engelhardt_10_10_room", ["all light, by mote_layers, filtered; the frame is enlarged", "bounded", "one step", "exact",
               "bounded less exact, means over 2 x 2 pixels", "one step less exact, means over 2 x 2 pixels"], (3, 3))


def hidden_surfaces():
    sheet = Sheet("hidden_surfaces", *((y, (15, 312, 609, 906, 1203), 282, high) for y, high in ((40, 282), (383, 177), (657, 211))))
    sheet.panels[4::5] = [Difference(p, 1) for p in sheet.panels[4::5]]
    texts = []
    for scene in dict.fromkeys(r["scene"] for r in sheet.rows()):
        found = [f"{n} layer{'s' * (n > 1)}, {sheet.row(scene=scene, variant=f'{n} layers')['share']:.0%}" for n in (1, 4)]
        texts += [scene, "exact compensation", *found, "4 layers less exact"]
    laid_out(sheet, 5, texts)


def blender_cycles():
    sheet = Sheet("blender_cycles", *((y, (10, 436, 862), 416, 234) for y in (28, 296, 564, 832)))
    sheet.panels[2::3] = [Difference(p, 20) for p in sheet.panels[2::3]]
    laid_out(sheet, 3, [text for scene in blender_runs.SCENES.values() for text in (f"Cycles: {scene}", "mote", "difference, means of 8 x 8 pixels")])


def engelhardt_08_06_multibounce():
    sheet = Sheet("engelhardt_08_06_multibounce", *((y, (10, 452, 894, 1336), 432, 432) for y in (26, 494)))
    laid_out(sheet, 4, ["path", *(r["light"].replace("1 bounces", "1 bounce") for r in sheet.rows())])


def engelhardt_08_10_upsampling():
    sheet = Sheet("engelhardt_08_10_upsampling", (26, (10, 500, 990), 480, 300), (362, (10, 500, 990), 320, 320), (718, (10, 500, 990), 480, 300))
    rows = [r for r in sheet.rows() if "again" not in r["receivers"]]
    laid_out(sheet, 3, [f"{r['surfaces']}, {r['receivers']}: {r['error']:.1%}" for r in rows[:6]] +
          [f"{r['texels_a_side']:.0f} x {r['texels_a_side']:.0f} texels: relative RMSE {r['error']:.1%}" for r in rows[6:]])


def engelhardt_09_01_samples():
    sheet = Sheet("engelhardt_09_01_samples", (30, (15, 639), 547, 307), (362, (15,), 547, 307))
    rows = sheet.rows()
    lengths, *spectra = ([r[k] for r in rows] for k in ("wave_length_pixels", "power_along", "power_across"))
    laid_out(sheet, 2, ["epipolar sampling, the paper's settings", f"marched rays, the paper's settings: {sheet.measured('few pixels are')}",
                      f"marched rays, refined where light varies: {sheet.measured('so it is when')}"],
          lambda canvas, y: samples.plot(canvas.panel(657, y - 305, 440, 265), np.array(lengths), spectra), (0, 20))


def engelhardt_09_11_lines():
    sheet = Sheet("engelhardt_09_11_lines", (24, (12, 360, 708), 317, 237), (283, (12, 360), 317, 237))
    errors = {(r["lines"], int(r["samples"])): r["error"] for r in sheet.rows()}
    rays = [f"{n} lines, {sheet.row(lines=n, samples=32)['marched_rays']:.0f} marched rays" for n in (256, 512, 1024)]
    laid_out(sheet, 3, [*rays, "every pixel, 518400 marched rays", "every pixel, 20 steps of equal length"],
          lambda canvas, y: lines.plot(canvas.panel(737, y - 232, 234, 205), errors), (12, 25))


def engelhardt_10_07_strategies():
    sheet = Sheet("engelhardt_10_07_strategies", (26, (1, 430, 859), 421, 263), (327, (430, 859), 421, 263))
    rows = sheet.rows()
    sheet.panels.insert(3, np.full((263, 421, 3), 255, np.uint8))
    errors = {r["strategy"]: (r["rmse"], r["standard_error"]) for r in rows}
    passes = [f"{r['strategy']}: {r['passes']:.0f} passes" for r in rows]
    laid_out(sheet, 3, ["multiple scattering, by mote_layers, filtered", *passes[:2], "", *passes[2:]],
          lambda canvas, y: strategies.bars(canvas.panel(76, y - 263, 346, 208), errors, 6))


def engelhardt_10_13_complex():
    sheet = Sheet("engelhardt_10_13_complex", *((y, (0, 518), 510, 319) for y in (26, 379)))
    rows, texts = sheet.rows(), []
    for row, times in zip(rows, (4, 2)):
        texts += [f"{row['scene']}, {row['thousand_triangles']:.0f} thousand triangles, by mote_layers, filtered",
                  f"what compensation of {row['vpls']:.0f} VPLs brings back, x{times}, 4 x 4 pixels"]

    def bars(canvas, _):
        for i, row in enumerate(rows):
            complex_scenes.bars(canvas.panel(1100, 30 + 350 * i, 180, 260), row["rest_ns"], row["compensation_ns"])
    laid_out(sheet, 2, texts, bars, (260, 0))


def engelhardt_11_03_hierarchy():
    sheet = Sheet("engelhardt_11_03_hierarchy", (26, (1, 322, 643, 964), 315, 236))
    laid_out(sheet, 4, [r["scene"] for r in sheet.rows()], lambda canvas, y: hierarchy.plots(
        canvas.panel(80, y + 10, 540, 376), canvas.panel(710, y + 10, 570, 376), hierarchy.read(sheet.table)), (0, 440))


def engelhardt_11_05_ground_truth():
    sheet = Sheet("engelhardt_11_05_ground_truth", (26, (1, 430, 859), 421, 316), (376, (1, 430, 859), 421, 316), (726, (1, 430, 859), 421, 263),
                  (1023, (1, 143, 285, 430, 572, 714, 859, 1001, 1143), 137, 205))
    texts, pieces = [], []
    for r in sheet.rows():
        texts += [f"{r['scene']}: all light, by mote_layers", f"exact, x4, 2 x 2 pixels; equal error: {r['seconds_exact_to_equal_error']:.0f} s",
                  f"three steps, x4: {r['recovered']:.0%}, {r['seconds_screen_space']:.2f} s"]
        pieces += [f"{r['scene']}:\nbounded", "exact", "three steps"]
    large, small = sheet.panels[:9], sheet.panels[9:]
    sheet.panels = large
    laid_out(sheet, 3, texts, lambda canvas, y: [put(canvas.panel(142 * k + GAP * (k // 3) // 3, y + 46, 137, 205), p, text)
                                             for k, (p, text) in enumerate(zip(small, pieces))], (0, 255))


def smoke_animation():
    laid_out(Sheet("smoke_animation", (0, (0,), 1280, 720)), 1, [""])


def engelhardt_10_12_anisotropic():
    sheet = Sheet("engelhardt_10_12_anisotropic", *((y, (1, 430, 859), 421, 421) for y in (26, 481)))
    words = ("backward", "isotropic", "forward")
    laid_out(sheet, 3, [f"{word}, g = {r['g']:g}: all light, by mote_layers" for word, r in zip(words, sheet.rows())] +
          3 * ["what two steps bring back, x4, 3 x 3 pixels"])


FIGURES = [blender_cycles, engelhardt_07_octahedral, engelhardt_08_13_raycast, engelhardt_10_05_locally_homogeneous, engelhardt_10_10_room,
           hidden_surfaces, engelhardt_08_06_multibounce, engelhardt_08_10_upsampling, engelhardt_09_01_samples,
           engelhardt_09_11_lines, engelhardt_10_07_strategies, engelhardt_10_12_anisotropic, engelhardt_10_13_complex, engelhardt_11_03_hierarchy,
           engelhardt_11_05_ground_truth, hermes_07_interleaved, hermes_08_glossy, hermes_09_path_tracing, hermes_11_direct_apart, smoke_animation,
           sun_05_cornell, sun_05_denoised, sun_05_equal_time, tokuyoshi_04_mis, tokuyoshi_06_environment, tokuyoshi_07_two_bounce,
           tokuyoshi_08_glossy, tokuyoshi_09_path_tracing, tokuyoshi_11_reuse]

if __name__ == "__main__":
    for figure in FIGURES:
        if not sys.argv[1:] or figure.__name__ in sys.argv[1:]:
            figure()
