#!/usr/bin/python3
"""Granular visibility queries: Engelhardt 2013, Tables 6.1 to 6.4.

Table 6.3: what region sets count too much, on random ellipses that are in conflict about as often as the paper's objects.
Table 6.2: item buffers do not suffer from many bins. Table 6.1: what culling saves, here of the virtual point lights that a
part of a surface cannot see, in 4 x 4 rooms whose openings grow until there are no walls, and in scenes of scenes/. Below:
meshes as fine as they are visible. Times are processor seconds. A full run takes 10 minutes, --quick 20 s.

    tools/build_release.sh mote_queries mote mote_geometry mote_smoke
    experiments/figures/engelhardt_06_queries.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import csv
import io
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
from claims import Claims
from panels import Canvas, title
from renders import main

PAPER = {100: (10, 1.6), 200: (50, 1.7), 300: (116, 2.7), 400: (166, 6.3), 500: (249, 7.4)}  # conflicts, pixels
OPENINGS = (0.25, 0.5, 0.75, 1.0)
SCENES = ("cornell_box", "city", "atrium", "statue")
ROOMS, EDGE, HEIGHT, THICK = 4, 4.0, 3.0, 0.1


def run(mote, *options):
    output = subprocess.run([mote.program.with_name("mote_queries"), *map(str, options)], stdout=subprocess.PIPE,
                            text=True, check=True).stdout
    return list(csv.DictReader(io.StringIO(output)))


def box(x, y, z, dx, dy, dz):
    return (f'<shape type="cube"><transform name="to_world"><scale x="{dx / 2}" y="{dy / 2}" z="{dz / 2}"/>'
            f'<translate x="{x}" y="{y}" z="{z}"/></transform><ref id="white"/></shape>\n')


def rooms(opening):
    """Rooms with a lamp each; in the middle of every wall between two an opening, this share of the wall wide and high."""
    size, xml = ROOMS * EDGE, ""
    for y in (-THICK / 2, HEIGHT + THICK / 2):
        xml += box(size / 2, y, size / 2, size, THICK, size)
    for k in range(ROOMS + 1):
        for i in range(ROOMS):
            at, middle, inside = k * EDGE, (i + 0.5) * EDGE, 0 < k < ROOMS
            side, above = EDGE * (1 - opening) / 2, HEIGHT * (1 - opening)
            parts = [(middle, HEIGHT / 2, EDGE, HEIGHT)] if not inside else [
                (middle - (EDGE - side) / 2, HEIGHT / 2, side, HEIGHT), (middle + (EDGE - side) / 2, HEIGHT / 2, side, HEIGHT),
                (middle, HEIGHT - above / 2, EDGE - 2 * side, above)]
            for along, y, width, height in parts:
                if min(width, height) > 0:
                    xml += box(along, y, at, width, height, THICK) + box(at, y, along, THICK, height, width)
    for i in range(ROOMS):
        for j in range(ROOMS):
            xml += (f'<shape type="rectangle"><transform name="to_world"><scale value="0.3"/><rotate x="1" angle="90"/>'
                    f'<translate x="{(i + 0.5) * EDGE}" y="{HEIGHT - 0.05}" z="{(j + 0.5) * EDGE}"/></transform>'
                    '<emitter type="area"><rgb name="radiance" value="8"/></emitter></shape>\n')
    return f"""<scene version="3.0.0">
<default name="paths" value="256"/><integrator type="mote_vpl"><integer name="paths" value="$paths"/></integrator>
<sensor type="perspective"><float name="fov" value="75"/><transform name="to_world">
<lookat origin="0.4, 1.6, 0.4" target="3, 1.3, 3.2" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="320"/><integer name="height" value="200"/></film></sensor>
<bsdf type="twosided" id="white"><bsdf type="diffuse"><rgb name="reflectance" value="0.7"/></bsdf></bsdf>
{xml}</scene>
"""


class Culling:
    """The same render with light lists and without: time, noise, and rays, and what all of it comes to."""

    def __init__(self, mote, scene, name, quick):
        settings = {"film.width": 160 if quick else 320, "film.height": 100 if quick else 200, "integrator.paths": 256}
        pair = [mote.render(scene, f"{name}_{lists}", settings | {"integrator.light_lists": lists}, passes=8 if quick or name in SCENES[1:] else 24,
                            threads=2) for lists in (0, 8)]
        self.name = name
        self.time, self.noise, self.rays = (
            [f(p) for p in pair] for f in (lambda p: p.cpu, lambda p: p.statistics["noise"],
                                           lambda p: p.statistics["rays"]["occlusion"]))
        self.saved = 1 - self.rays[1] / self.rays[0]
        # How much longer it takes to the same noise without lists.
        self.gain = self.time[0] * self.noise[0] ** 2 / (self.time[1] * self.noise[1] ** 2)

    def row(self):
        return [self.name, *self.rays, *self.time, *self.noise, self.gain]


def check(table, tiles, cullings, details):
    claims = Claims()
    extra = {int(r["count"]): float(r["extra"]) for r in table}
    claims.check("item buffers count exactly", "no item off", all(float(r["wrong"]) == 0 for r in table + tiles))
    claims.check("region sets never count too few pixels", "none below", all(float(r["below"]) == 0 for r in table))
    claims.check("region sets count 1.6 to 2.7 pixels too many at 100 to 300 objects, at most",
                 ", ".join(f"{extra[n]:.2f}" for n in (100, 200, 300)), max(extra[n] for n in (100, 200, 300)) <= 2.7)
    counts = sorted(extra)
    claims.check("the error grows with the number of conflicts", f"{extra[100]:.2f} to {extra[500]:.2f} pixels",
                 all(extra[a] < extra[b] for a, b in zip(counts, counts[1:])))
    times = {int(r["t"]): float(r["histogram_ms"]) for r in tiles}
    claims.check("finer tiles do not slow item buffers down",
                 ", ".join(f"{2 ** t}^2: {ms:.1f} ms" for t, ms in times.items()), times[5] < 1.1 * times[0],
                 "on the processor more bins are more memory: 4096 objects in 32 x 32 tiles take 16 MB, which is beyond the "
                 "cache; there are no threads that wait for one bin")
    gains = {c.name: c.gain for c in cullings}
    claims.check("culling pays: time to the same noise, in rooms with narrow openings",
                 f"{gains['rooms_0.25']:.2f} times", gains["rooms_0.25"] > 1.2)
    claims.check("culling pays in one more scene", f"Cornell box {gains['cornell_box']:.2f} times", gains["cornell_box"] > 1.1)
    walls = {c.name: c for c in cullings if c.name.startswith("rooms")}
    saved = [walls[f"rooms_{o}"].saved for o in OPENINGS]
    claims.check("more is culled behind walls than without any", ", ".join(f"{100 * s:.0f} %" for s in saved),
                 min(saved[:-1]) > saved[-1])
    behind = [gains[f"rooms_{o}"] for o in OPENINGS]
    claims.check("culling pays more behind walls than without any", ", ".join(f"{g:.2f}" for g in behind),
                 min(behind[:-1]) > behind[-1])
    seconds = {r["by"]: float(r["seconds"]) for r in details}
    claims.check("meshes as fine as they are visible cost less than by size on the screen, queries and all",
                 ", ".join(f"{k}: {1e3 * s:.0f} ms" for k, s in seconds.items()),
                 seconds["visible pixels"] < seconds["size on the screen"])
    return claims.exit_code()


def draw(table, cullings, details, path):
    canvas = Canvas(1280, 420)
    axes = canvas.panel(60, 40, 330, 320)
    counts = [int(r["count"]) for r in table]
    axes.plot([float(r["conflicts"]) for r in table], [float(r["extra"]) for r in table], "o-", label="here, ellipses")
    axes.plot(*zip(*PAPER.values()), "s--", color="grey", label="Table 6.3")
    for r in table:
        axes.annotate(r["count"], (float(r["conflicts"]), float(r["extra"])), textcoords="offset points", xytext=(6, -10), fontsize=8)
    axes.set(xlabel="items in conflict, four channels", ylabel="pixels counted too many, mean")
    axes.legend(fontsize=9)
    title(axes, f"Region sets, {counts[0]} to {counts[-1]} items")
    axes = canvas.panel(520, 40, 380, 320)
    axes.barh([c.name.replace("_", " ") for c in cullings][::-1], [c.gain for c in cullings][::-1], color="tab:green")
    axes.axvline(1, color="black", linewidth=1)
    axes.set(xlabel="time to the same noise, without lists / with")
    title(axes, "VPLs culled by what they see")
    axes = canvas.panel(1000, 40, 250, 320)
    axes.bar(["finest", "by size", "by visible\npixels"], [1e3 * float(r["seconds"]) for r in details], color="tab:blue")
    axes.bar(["finest", "by size", "by visible\npixels"], [1e3 * float(r["query_seconds"]) for r in details], color="tab:orange",
             label="queries")
    axes.set(ylabel="processor ms")
    axes.legend(fontsize=9)
    title(axes, "400 balls: meshes and picture")
    canvas.save(path)


def figure(mote, quick, output):
    table = run(mote, "ellipses", "--pictures", 4 if quick else 20)
    large = ["ellipses", "--counts", 4096, "--width", 1920, "--height", 1080, "--spread", 1, "--least-radius", 12,
             "--largest-radius", 30, "--aspect", 2, "--pictures", 1, "--threads", 1, "--repeat", 5 if quick else 25]
    tiles = [dict(run(mote, *large, "--tiles", t)[0], t=t) for t in range(6)]
    cullings = []
    for opening in OPENINGS:
        path = mote.folder / f"rooms_{opening}.xml"
        path.write_text(rooms(opening))
        cullings.append(Culling(mote, path, f"rooms_{opening}", quick))
    cullings += [Culling(mote, scene, scene, quick) for scene in SCENES[:1 if quick else None]]
    details = run(mote, "detail", "--threads", 1)
    with open(output.with_suffix(".csv"), "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        names = [k for k in table[0] if k not in ("wrong", "below")]
        out.writerow(names + ["paper_conflicts", "paper_extra"])
        out.writerows([r[k] for k in names] + list(PAPER[int(r["count"])]) for r in table)
        out.writerow(["t", "histogram_ms", "bare_pass_ms"])
        out.writerows([r["t"], r["histogram_ms"], r["bare_ms"]] for r in tiles)
        out.writerow(["scene", "rays", "rays_lists", "cpu_s", "cpu_s_lists", "noise", "noise_lists", "gain"])
        out.writerows([f"{x:.4g}" if isinstance(x, float) else x for x in c.row()] for c in cullings)
        out.writerow(list(details[0]))
        out.writerows(r.values() for r in details)
    draw(table, cullings, details, output.with_suffix(".png"))
    return check(table, tiles, cullings, details)


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
