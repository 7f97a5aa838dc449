#!/usr/bin/python3
"""Time of a ray-bundle against its resolution and its layers: Hermes et al. 2010, Table 1.

The paper's times are a GTX 285's for k-buffer and exchange, with an atlas of 2048 x 2048 texels; these are one core's for
the bundle alone, in both of its forms, so that ratios are compared. Layers: sheets one behind the other, as many as the
paper's multi-samples, and the atrium, whose rays have up to 60 hits. Exit code 0: all is as documented; 1: it is not; 2:
wrong usage, or the program is missing. A full run takes two minutes, --quick 20 s.

    tools/build_release.sh mote_study_ray_bundles
    experiments/figures/hermes_table_1.py [--quick] [--output FOLDER] [--bin FOLDER]
"""
import sys
import tempfile
from pathlib import Path

import plotting
from bundle_times import main, write_table
from claims import Claims
from origin import ROOT, tables_of

PAPER = {("direct", 512, 8): 22, ("direct", 1024, 8): 26, ("direct", 2048, 8): 36, ("direct", 1024, 16): 121,
         ("global", 512, 8): 36, ("global", 1024, 8): 39, ("global", 2048, 8): 51, ("global", 1024, 16): 208}
SHEET = """<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="{a}"/><translate z="{z}"/></transform></shape>"""


def sheets(count, folder):
    """A scene of sheets, each turned a little, so that they are triangles of no one plane."""
    shapes = "".join(SHEET.format(a=0.5 * i, z=0.3 * i / count) for i in range(count))
    path = Path(folder) / f"sheets_{count}.xml"
    path.write_text(f'<scene version="3.0.0">{shapes}<emitter type="point"/><sensor type="perspective"/></scene>',
                    encoding="utf-8")
    return path


def figure(times, quick, output):
    sides = (256, 512, 1024) if quick else (512, 1024, 2048)
    directions = 4 if quick else 12
    rows = [dict(scene="atrium", **r) for r in times.rows(ROOT / "scenes" / "atrium.xml", ["rays", "scan"], sides, directions)]
    with tempfile.TemporaryDirectory() as folder:
        for count in (4, 8, 16, 32):
            rows += [dict(scene=f"{count} sheets", **r)
                     for r in times.rows(sheets(count, folder), ["rays", "scan"], sides[:1], 2 * directions)]
    write_table(output.with_name(output.name + ".csv"), rows)
    plot_table(output.with_name(output.name + ".csv"), output.with_name(output.name + ".png"))
    return check(rows, sides)


def check(rows, sides):
    of = {(r["scene"], r["form"], int(r["side"])): r for r in rows}
    ms = lambda scene, form, side: of[scene, form, side]["ms_per_direction"]
    claims = Claims()
    paper = PAPER["global", 2048, 8] / PAPER["global", 512, 8]
    for form in ("rays", "scan"):
        low, high = (of["atrium", form, side] for side in (sides[0], sides[2]))
        growth, more = high["ms_per_direction"] / low["ms_per_direction"], high["rays"] / low["rays"]
        claims.check(f"{form}: time grows with the resolution, and less than the number of rays",
                     f"{growth:.1f} times for {more:.1f} times the rays (paper: {paper:.1f} for 16, most of it the atlas)",
                     1.0 < growth < more)
        claims.check(f"{form}: time grows by {PAPER['direct', 1024, 16] / PAPER['direct', 1024, 8]:.1f} "
                     "(direct) to 5.3 (global) times from 8 layers to 16",
                     f"{ms('16 sheets', form, sides[0]) / ms('8 sheets', form, sides[0]):.2f} times",
                     ms("16 sheets", form, sides[0]) > 4.0 * ms("8 sheets", form, sides[0]),
                     "a k-buffer of twice the samples costs every pixel, and rounds of it; here a ray has as many hits as "
                     "there are, and each costs about the same")
        layers = [of[f"{n} sheets", form, sides[0]]["ns_per_hit"] for n in (8, 16, 32)]
        claims.check(f"{form}: a hit costs the same however many layers there are, within a factor of two",
                     ", ".join(f"{x:.0f}" for x in layers) + " ns with 8, 16, 32 layers", max(layers) < 2 * min(layers))
    deepest = max(r["deepest"] for r in rows if r["scene"] == "atrium")
    claims.check("the number of hits along a ray is limited by the hardware (32 to 254)", f"none is left out: up to "
                 f"{deepest:.0f} in the atrium", False, "hits are counted exactly, within a budget of memory")
    return claims.exit_code()


def plot_table(table, path):
    """Time by the number of rays in the atrium, and by the number of layers in the sheets."""
    rows, = tables_of(table)
    made, (left, right) = plotting.figure(columns=2, height=420)
    panels = (left, [r for r in rows if r["scene"] == "atrium"], lambda r: r["rays"], "rays", "Atrium, 263,000 triangles")
    sheets = [r for r in rows if "sheets" in r["scene"]]
    for axes, chosen, x, name, text in (panels, (right, sheets, lambda r: int(r["scene"].split()[0]), "layers that a ray meets",
                                                 f"Sheets, {sheets[0]['side']:.0f} rays across")):
        ends = []
        for form, label, colour in (("rays", "rays of\nEmbree", plotting.BLUE), ("scan", "scan of the\ntriangles", plotting.ORANGE)):
            line = [(x(r), r["ms_per_direction"]) for r in chosen if r["form"] == form]
            axes.plot(*zip(*line), "o-", color=colour)
            ends.append((label, *line[-1], colour))
        plotting.log_axes(axes, name, "time of a direction, one core [ms]", percent=False)
        axes.set_title(text, loc="left", fontsize=12)
        plotting.label_ends(axes, ends, gap=34)
    left.xaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{v / 1e6:g} million"))
    right.set_xticks([4, 8, 16, 32], ["4", "8", "16", "32"])
    plotting.save(made, path)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
