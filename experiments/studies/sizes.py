#!/usr/bin/python3
"""Time and memory against the size of a scene: triangles, instances, lights, voxels.

Renders four passes of 640 x 400 pixels of a rippled terrain (unique triangles, read from one PLY file), of such terrains placed many
times (instances), of point lights over it, and of a shell of fog that fills a sparse grid. Prints and writes for each size the
seconds of loading and of a pass, and the peak of memory, and of each row of sizes the exponents: the slope of the logarithm over
the last factor of ten or more. `read` is the time of reading the file alone, bytes for bytes. Exit code 1: a pass takes longer than it
would if it grew with the logarithm of the size (twice that, for noise), or an exponent of loading or of memory exceeds 1.1.

    experiments/studies/sizes.py [--quick] [--output FOLDER] [--bin FOLDER]
"""
import argparse
import csv
import json
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
import plotting
from occluders import write_ply
from origin import Origin

VIEW = """<scene version="3.0.0"><integrator type="{integrator}"/><sensor type="perspective"><float name="fov" value="50"/>
<transform name="to_world"><lookat origin="0, 0.9, 1.9" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="640"/><integer name="height" value="400"/></film></sensor>{things}</scene>"""
SKY = """<emitter type="constant"><rgb name="radiance" value="0.3, 0.4, 0.6"/></emitter><emitter type="directional">
<vector name="direction" value="0.5, -1, -0.3"/><rgb name="irradiance" value="3, 2.8, 2.5"/></emitter>"""
CLAY = '<bsdf type="diffuse"><rgb name="reflectance" value="0.4, 0.35, 0.3"/></bsdf>'
FOG = """<shape type="cube"><bsdf type="null"/><medium type="heterogeneous" name="interior"><float name="scale" value="100"/>
<volume name="sigma_t" type="vdbvolume"><string name="filename" value="{}"/></volume>
<volume name="albedo" type="constvolume"><float name="value" value="0.9"/></volume></medium></shape>"""


def terrain(path, triangles):
    """Ripples of all lengths down to four cells, over [-1, 1]^2; returns the number of triangles."""
    n = math.isqrt(triangles // 2) + 1
    random = np.random.default_rng(1)
    x, z = np.meshgrid(*2 * [np.linspace(-1, 1, n, dtype=np.float32)])
    y, frequency, height = np.zeros_like(x), 1.0, 0.08
    while frequency < n / 4:
        for angle, phase in random.uniform(0, 2 * np.pi, (2, 2)):
            y += np.float32(height) * np.sin(np.float32(np.pi * frequency) * (np.float32(np.cos(angle)) * x + np.float32(np.sin(angle)) * z)
                                             + np.float32(phase))
        frequency, height = 1.9 * frequency, 0.55 * height
    corner = np.arange(n * n, dtype="<i4").reshape(n, n)
    a, b, c, d = (corner[i:n - 1 + i, j:n - 1 + j].ravel() for i in (0, 1) for j in (0, 1))
    faces = np.stack([a, c, b, b, c, d], -1).reshape(-1, 3)
    write_ply(path, np.stack([x, y, z], -1).reshape(-1, 3), faces)
    return len(faces)


def ply(path):
    return f'<shape type="ply"><string name="filename" value="{path}"/>{CLAY}</shape>'


def triangles(args, size, folder):
    path = folder / "terrain.ply"
    return terrain(path, size), path, "path", ply(path) + SKY


def instances(args, size, folder):
    path = folder / "part.ply"
    terrain(path, 100_000)
    random, scale = np.random.default_rng(2), 1.5 / size ** 0.5
    places = "".join(f'<shape type="instance"><ref id="part"/><transform name="to_world"><scale value="{scale:.6g}"/><translate x="{x:.5f}" '
                     f'y="{y:.5f}" z="{z:.5f}"/></transform></shape>\n' for x, y, z in random.uniform((-1.5, 0, -1.5), (1.5, 0.2, 1.5), (size, 3)))
    return size, None, "path", f'<shape type="shapegroup" id="part">{ply(path)}</shape>{places}{SKY}'


def lights(args, size, folder):
    path = folder / "ground.ply"
    terrain(path, 100_000)
    places = np.random.default_rng(3).uniform((-1, 0.2, -1), (1, 0.4, 1), (size, 3))
    return size, None, "path", ply(path) + "".join(
        f'<emitter type="point"><point name="position" x="{x:.5f}" y="{y:.5f}" z="{z:.5f}"/><rgb name="intensity" value="{10 / size:.6g}"/></emitter>\n'
        for x, y, z in places)


def voxels(args, size, folder):
    path = folder / "shell.vdb"
    made = subprocess.run([args.bin / "mote_study_shell", path, str(size // 2 - 8)], check=True, capture_output=True, text=True)
    return int(made.stdout.split()[-1]), path, "volpath", FOG.format(path) + SKY


# By name: what makes the scene, its sizes; the first word names a line of the plot.
ROWS = {"triangles": (triangles, (10_000, 100_000, 1_000_000, 10_000_000, 20_000_000)),
        "instances of 100,000 triangles": (instances, (100, 1000, 10_000, 100_000)),
        "lights": (lights, (100, 1000, 10_000, 100_000)),
        "voxels of a sparse grid, active": (voxels, (250, 500, 1000, 2000))}


def seconds_to_read(path):
    begin = time.perf_counter()
    if path:
        path.read_bytes()
    return time.perf_counter() - begin


def measure(args, origin, make, size, folder):
    count, file, integrator, things = make(args, size, folder)
    (folder / "scene.xml").write_text(VIEW.format(integrator=integrator, things=things))
    subprocess.run([args.bin / "mote", "render", folder / "scene.xml", "--passes", "4", "--quiet", "-o", folder / "a.exr",
                    "--stats", folder / "a.json"], check=True)
    stats = json.loads((folder / "a.json").read_text())
    origin.programs.add(stats["git_hash"])
    return {"size": count, "read_seconds": seconds_to_read(file), "load_seconds": stats["seconds"]["load"],
            "pass_seconds": (stats["seconds"]["render"] - stats["seconds"].get("previews", 0.0)) / 4, "memory_bytes": stats["peak_memory_bytes"]}


def exponent(rows, key):
    b = rows[-1]
    a = max((r for r in rows if r["size"] <= 0.11 * b["size"]), key=lambda r: r["size"], default=rows[0])
    return math.log(b[key] / a[key]) / math.log(b["size"] / a["size"])


def plot(of_kinds, path):
    made, axes = plotting.figure(columns=2, height=420)
    for ax, key, measured in zip(axes, ("load_seconds", "pass_seconds"), ("seconds of loading", "seconds of a pass")):
        ends = []
        for colour, (kind, rows) in zip((plotting.BLUE, plotting.ORANGE_RED, plotting.GREEN, plotting.BLACK), of_kinds.items()):
            x, y = [r["size"] for r in rows], [r[key] for r in rows]
            ax.plot(x, y, "o-", color=colour)
            ends.append((kind.split()[0], x[-1], y[-1], colour))
        plotting.log_axes(ax, "triangles, instances, lights, voxels", measured, percent=False)
        ax.xaxis.set_major_locator(plotting.LogLocator(subs=(1,), numticks=8))
        ax.xaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"$10^{{{round(math.log10(v))}}}$"))
        plotting.label_ends(ax, ends)
    plotting.save(made, path)


def write(folder, origin, of_kinds):
    folder.mkdir(parents=True, exist_ok=True)
    table, picture = folder / "sizes.csv", folder / "sizes.png"
    with open(table, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["what", "size", "read_seconds", "load_seconds", "pass_seconds", "memory_gb"])
        for kind, rows in of_kinds.items():
            for r in rows:
                writer.writerow([kind, r["size"], *(f"{r[k]:.3f}" for k in ("read_seconds", "load_seconds", "pass_seconds")), f"{r['memory_bytes'] * 1e-9:.2f}"])
        writer.writerow(["exponent_of", "load", "pass", "memory"])
        for kind, rows in of_kinds.items():
            writer.writerow([f"{kind}, exponents", *(f"{exponent(rows, k):.2f}" for k in ("load_seconds", "pass_seconds", "memory_bytes"))])
    plot(of_kinds, picture)
    origin.stamp(picture, table)


def grows_too_fast(rows):
    first, last = rows[0], rows[-1]
    allowed = 2 * first["pass_seconds"] * math.log(last["size"]) / math.log(first["size"])
    return last["pass_seconds"] > allowed or max(exponent(rows, "load_seconds"), exponent(rows, "memory_bytes")) > 1.1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="the two smallest sizes of each")
    parser.add_argument("--output", type=Path, help="folder of the table and of the plot")
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin", help="folder of mote")
    args = parser.parse_args()
    origin, of_kinds = Origin(__file__, args.quick), {}
    for kind, (make, sizes) in ROWS.items():
        rows = of_kinds[kind] = []
        for size in sizes[:2] if args.quick else sizes:
            with tempfile.TemporaryDirectory() as folder:
                rows.append(measure(args, origin, make, size, Path(folder)))
            r = rows[-1]
            print(f"{kind:32} {r['size']:>11,}  read {r['read_seconds']:6.2f} s  load {r['load_seconds']:6.2f} s  pass {r['pass_seconds']:5.2f} s  "
                  f"{r['memory_bytes'] * 1e-9:5.2f} GB", flush=True)
        print(f"{kind:32} exponents: load {exponent(rows, 'load_seconds'):.2f}, pass {exponent(rows, 'pass_seconds'):.2f}, "
              f"memory {exponent(rows, 'memory_bytes'):.2f}", flush=True)
    if args.output:
        write(args.output, origin, of_kinds)
    return int(any(grows_too_fast(rows) for rows in of_kinds.values()))


if __name__ == "__main__":
    sys.exit(main())
