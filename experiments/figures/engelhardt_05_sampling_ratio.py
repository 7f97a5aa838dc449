#!/usr/bin/python3
"""How evenly directional maps sample the sphere: Engelhardt 2013, Figs. 5.1 to 5.4 and 7.7.

The program mote_directional_maps prints density and spacing of the texels of every map; this draws them, writes the
extremes as CSV, and checks the paper's claims (claims.py says how, also those that do not hold as stated). Exit code 0:
all is as documented; 1: it is not; 2: wrong usage, or the program is missing. A full run takes 15 s, --quick 3 s.

    tools/build_release.sh mote_directional_maps
    experiments/figures/engelhardt_05_sampling_ratio.py [--quick] [--output FOLDER] [--bin FOLDER]
"""
import argparse
import csv
import io
import subprocess
import sys
from pathlib import Path

import matplotlib
import numpy as np
import plotting
from claims import Claims
from origin import ROOT, Origin
from panels import TITLE, Canvas, letter, letters, title
from renders import finish

NAME = Path(__file__).stem
MAPS = {"cube": "cube", "paraboloid": "two paraboloids", "sphere": "sphere", "latitude_longitude": "latitude-longitude",
        "octahedral": "octahedral, planar", "octahedral_perspective": "octahedral, perspective"}
# All maps use about as many texels as a square of n * n: their shorter edge, over n.
EDGES = {"cube": 6 ** -0.5, "paraboloid": (np.pi / 2) ** -0.5, "sphere": (np.pi / 4) ** -0.5,
         "latitude_longitude": 2 ** -0.5}
MAP_COLOURS = (plotting.BLUE, plotting.ORANGE, plotting.GREEN, plotting.ORANGE_RED, plotting.PURPLE, plotting.BROWN)
AXES = "through the axes x and z"
CORNER = 3 ** 1.5  # density at a vertex over density in the middle of a face, for cube and octahedron alike


class Program:
    def __init__(self, folder):
        self._path = folder / "mote_directional_maps"
        if not self._path.is_file():
            raise FileNotFoundError(f"no {self._path}: build it first (tools/build_release.sh mote_directional_maps)")

    def texels(self, kind, size, directions=None, up=None):
        """A structured array with the columns of the program, one row for each texel, or for each direction."""
        command = [self._path, "--kind", kind, "--size", str(size)] + (["--up", str(up)] if up else [])
        text = None
        if directions is not None:
            command.append("--lookup")
            text = "\n".join("%.9g %.9g %.9g" % tuple(d) for d in directions)
        output = subprocess.run(command, input=text, stdout=subprocess.PIPE, text=True, check=True).stdout
        return np.genfromtxt(io.StringIO(output), delimiter=",", names=True)


class Extremes:
    """Over all texels of a map that are used. Spacing: in the worse direction, of texels that are used in full."""

    def __init__(self, texels):
        used = texels[texels["used_share"] > 0]
        ratio, angle = used["sampling_ratio"], used["solid_angle"]
        self.under, self.over = 1 / ratio.min(), ratio.max()
        self.contrast = self.under * self.over
        self.beyond = angle[(ratio < 0.5) | (ratio > 2)].sum() / angle.sum()
        self.deviation = np.sqrt(np.average(np.log2(ratio) ** 2, weights=angle))
        full = texels["used_share"] > 1 - 1e-9
        self.widest, self.narrowest = texels["widest_spacing"][full].max(), texels["narrowest_spacing"][full].min()
        self.used_share = texels["used_share"].mean()


def check(e, circle, tilts):
    """e: Extremes by map; circle: of the cube, along the circle of Fig. 5.3; tilts: contrast of the perspective map by
    the elevation of its cameras."""
    claims = Claims()
    two = "neither over- nor undersampling exceeds a factor of 2"
    over_under = lambda x: f"{x.under:.3f}x under, {x.over:.3f}x over"
    claims.check(f"cube map: {two}", f"{over_under(e['cube'])}, {100 * e['cube'].beyond:.1f} % of the sphere beyond",
                 max(e["cube"].under, e["cube"].over) <= 2,
                 "the eight corners are oversampled 3^1.5 * pi/6 = 2.72 times; no great circle through the middles of "
                 "faces and edges, as in Fig. 5.3, meets one")
    claims.check(f"cube map, along a great circle through four face centres: {two}", over_under(circle),
                 max(circle.under, circle.over) <= 2)
    paraboloid = e["paraboloid"]
    claims.check(f"two paraboloids: {two}", f"{over_under(paraboloid)}, texels within the discs counted; with the "
                 f"unused corners {paraboloid.under / paraboloid.used_share:.2f}x under",
                 max(paraboloid.under, paraboloid.over) <= 2 + 1e-9)
    lat = e["latitude_longitude"]
    claims.check("latitude-longitude: undersampled by about 1.6 at the equator", f"{lat.under:.3f}",
                 1.55 < lat.under < 1.65)
    claims.check("latitude-longitude: exceeds a factor of 2, without bound at the poles", f"{lat.over:.1f}x over",
                 lat.over > 10)
    claims.check("sphere map: exceeds a factor of 2", f"{over_under(e['sphere'])}",
                 max(e["sphere"].under, e["sphere"].over) > 2,
                 "its texels all have the same solid angle (Lambert's equal-area projection)")
    claims.check("sphere map: exceeds a factor of 2 in the spacing of its texels",
                 f"{e['sphere'].widest:.1f}x too wide at the back, {1 / e['sphere'].narrowest:.1f}x too narrow across",
                 e["sphere"].widest > 2)
    octahedral = e["octahedral"]
    claims.check("octahedral: comparable to the cube (largest over smallest density within 10 %)",
                 f"{octahedral.contrast:.2f} and {e['cube'].contrast:.2f}, limit of both {CORNER:.2f}",
                 abs(octahedral.contrast / e["cube"].contrast - 1) < 0.1)
    perspective = e["octahedral_perspective"]
    claims.check("octahedral: planar better balanced than perspective (cameras at 45 degrees)",
                 f"{octahedral.contrast:.2f} and {perspective.contrast:.2f}; deviation {octahedral.deviation:.3f} and "
                 f"{perspective.deviation:.3f} octaves",
                 octahedral.contrast < perspective.contrast and octahedral.deviation < perspective.deviation)
    best = min(tilts, key=lambda t: t[1])
    claims.check("octahedral: no elevation of the cameras is better balanced than planar",
                 f"the best of {len(tilts)} has {best[0]:.1f} degrees, straight at the octahedron's faces: that is the "
                 f"planar map itself, {best[1]:.2f} and {octahedral.contrast:.2f}",
                 octahedral.contrast <= best[1] + 1e-6)
    return claims.exit_code()


def hemisphere(program, kind, edge, pixels):
    """The texels that an orthographic view of the unit sphere sees, and where the sphere is in the picture."""
    toward = np.array([0.45, 0.3, 0.84])
    toward /= np.linalg.norm(toward)
    right = np.cross([0, 1, 0], toward)
    right /= np.linalg.norm(right)
    x, y = np.meshgrid(np.linspace(-1, 1, pixels), np.linspace(1, -1, pixels))
    on = x ** 2 + y ** 2 < 1
    x, y = x[on], y[on]
    d = np.outer(x, right) + np.outer(y, np.cross(toward, right)) + np.outer(np.sqrt(1 - x ** 2 - y ** 2), toward)
    return program.texels(kind, edge, d), on


def layout(texels):
    """The sampling ratio of the map as it is stored, faces side by side; not a number where nothing is used."""
    width, height = int(texels["column"].max()) + 1, int(texels["row"].max()) + 1
    faces = np.where(texels["used_share"] > 0, texels["sampling_ratio"], np.nan).reshape(-1, height, width)
    faces = [np.pad(f, 1 + width // 32, constant_values=np.nan) for f in faces]
    rows = 2 if len(faces) > 3 else 1
    return np.vstack([np.hstack(faces[i::rows]) for i in range(rows)])


def great_circles():
    """Angles, and by name the directions of two half circles from +z to -z."""
    angle = np.radians(np.linspace(0.25, 179.75, 719))
    return np.degrees(angle), {
        AXES: np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1),
        "through (1, 1, 1) and z": np.stack([np.sin(angle) * 0.5 ** 0.5] * 2 + [np.cos(angle)], axis=1)}


def draw(program, sizes, texels, pixels, path):
    """A hemisphere and the stored map of each, and three half circles through them."""
    canvas = Canvas(1280, 880)
    norm = matplotlib.colors.LogNorm(0.25, 4)
    for column, (kind, label) in enumerate(MAPS.items()):
        seen, on = hemisphere(program, kind, sizes[kind], pixels)
        for row, image in enumerate([np.full(on.shape, np.nan), layout(texels[kind])]):
            if row == 0:
                image[on] = seen["sampling_ratio"]
            axes = canvas.panel(8 + 195 * column, TITLE + 24 + 200 * row, 185, 185)
            shown = axes.imshow(image, norm=norm, cmap="RdYlBu_r")
            axes.axis("off")
            if row == 0:
                title(axes, label.replace(", ", ",\n"))
    bar = canvas.figure.colorbar(shown, cax=canvas.panel(1186, TITLE + 44, 14, 346), ticks=[0.25, 0.5, 1, 2, 4])
    bar.ax.set_yticklabels(["1/4", "1/2", "1", "2", "4"], fontsize=letters(canvas.figure))
    bar.set_label("density of texels / an even one", fontsize=letters(canvas.figure))
    bar.minorticks_off()

    angle, circles = great_circles()
    panels = [("sampling_ratio", name) for name in circles] + [("widest_spacing", AXES)]
    for column, (quantity, circle) in enumerate(panels):
        axes = canvas.panel(62 + 416 * column, 530, 340, 285)
        for (kind, label), colour in zip(MAPS.items(), MAP_COLOURS):
            axes.plot(angle, program.texels(kind, sizes[kind], circles[circle])[quantity], label=label, linewidth=1.5, color=colour)
        axes.axhspan(0.5, 2, color="0.92", zorder=0)
        axes.set(yscale="log", ylim=(0.22, 9), xlim=(0, 180), xlabel=f"angle from +z, {circle} [°]", xticks=[0, 45, 90, 135, 180],
                 yticks=[0.25, 0.5, 1, 2, 4, 8], ylabel="density of texels" if quantity == "sampling_ratio" else "spacing of texels, worst")
        axes.set_yticklabels(["1/4", "1/2", "1", "2", "4", "8"])
        axes.minorticks_off()
        letter(axes)
    handles, labels = axes.get_legend_handles_labels()
    canvas.figure.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 1 - 470 / 880), ncols=6, fontsize=letters(canvas.figure),
                         frameon=False, columnspacing=1.2)
    canvas.save(path)


def write_csv(path, sizes, texels, extremes):
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["map", "size", "texels", "used_share", "undersampling", "oversampling", "contrast",
                        "beyond_factor_2", "deviation_octaves", "widest_spacing", "narrowest_spacing"])
        for kind, e in extremes.items():
            numbers = [e.used_share, e.under, e.over, e.contrast, e.beyond, e.deviation, e.widest, e.narrowest]
            table.writerow([kind, sizes[kind], len(texels[kind])] + [f"{x:.6g}" for x in numbers])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a sixteenth of the texels")
    parser.add_argument("--output", type=Path, default=ROOT / "out" / "figures")
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin", help="folder of the program")
    options = parser.parse_args()
    try:
        program = Program(options.bin)
    except FileNotFoundError as error:
        print(error, file=sys.stderr)
        return 2
    edge = 64 if options.quick else 256
    sizes = {kind: round(edge * EDGES.get(kind, 1.0)) for kind in MAPS}
    texels = {kind: program.texels(kind, size) for kind, size in sizes.items()}
    extremes = {kind: Extremes(t) for kind, t in texels.items()}
    tilts = []
    for up in (0.5, 0.7, 0.9, 1.0, 1.1, 1.4, 2.0):
        tilted = Extremes(program.texels("octahedral_perspective", edge, up=up))
        tilts.append((np.degrees(np.arctan(up / 2 ** 0.5)), tilted.contrast))
    options.output.mkdir(parents=True, exist_ok=True)
    output = options.output / (NAME + ("_quick" if options.quick else ""))
    write_csv(output.with_suffix(".csv"), sizes, texels, extremes)
    draw(program, sizes, texels, 100 if options.quick else 240, output.with_suffix(".png"))
    circle = Extremes(program.texels("cube", sizes["cube"], great_circles()[1][AXES]))
    code = check(extremes, circle, tilts)
    finish(Origin(__file__, options.quick), output)
    return code


if __name__ == "__main__":
    sys.exit(main())
