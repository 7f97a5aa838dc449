#!/usr/bin/env python3
"""Tests of the computations of experiments/peers; its errors are mote's, which tests/core/metrics tests.

Closed forms of transforms, meshes, boxes and times; white plastic in a furnace against the quadratures of Mitsuba's own
values; broken pixels of references. Exit code 1 and a line for
whatever fails.
"""
import struct
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "experiments" / part) for part in ("peers/cycles", "peers/real_sizes", "figures")]
from doubling import next_passes  # noqa: E402
from flat_scene import matrix_of, read_flat_scene, vdb_volumes  # noqa: E402
from meshes import cube, mesh_of, read_ply, sphere  # noqa: E402
from rough_interface import RoughInterface, boundary  # noqa: E402
from tight_boundaries import tighten  # noqa: E402
from times import broken_pixels, noise_alone, time_to  # noqa: E402

# Roughness, and what the BSDF of Mitsuba 3.9.1 reflects with Beckmann's and with the GGX distribution, by quadrature.
WHITE_PLASTIC = ((0.1, 0.968, 0.910), (0.4, 0.809, 0.608), (1.0, 0.509, 0.329))

failures = []


def check(holds, what):
    if not holds:
        failures.append(what)


def near(a, b, what, tolerance=1e-9):
    check(np.allclose(a, b, rtol=0, atol=tolerance), f"{what}: {a} instead of {b}")


def transforms():
    element = lambda text: matrix_of(ElementTree.fromstring(f"<transform>{text}</transform>"))
    moved = element('<scale x="2"/><rotate z="1" angle="90"/><translate x="5"/>') @ [1, 0, 0, 1]
    near(moved, [5, 2, 0, 1], "scale, rotate, translate in this order")
    camera = element('<lookat origin="1, 2, 3" target="1, 2, 9" up="0, 1, 0"/>')
    near(camera[:3], [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3]], "a camera along z has x to the left", 1e-12)


def scenes():
    found = vdb_volumes(ROOT / "scenes" / "smoke_room.xml", ["smoke=other.vdb"])
    check(len(found) == 1 and found[0][0].endswith("other.vdb"), f"the grid of the smoke room: {found}")
    near(np.array(found[0][2])[:3, 3], [2, 0.06, 2.5], "where it stands")
    scene = flat("""<medium type="homogeneous" id="m"><rgb name="sigma_t" value="1, 2, 3"/></medium>
        <shape type="cube"><bsdf type="null"/><ref name="interior" id="m"/></shape>""")
    shape = scene.all("shape")[0]
    near(shape.child("medium", "interior").rgb("sigma_t"), [1, 2, 3], "a medium that is referred to")
    check(shape.child("medium", "exterior") is None and shape.child("bsdf").type == "null", "what a shape holds")


def flat(inside):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.xml"
        path.write_text(f"<scene>{inside}</scene>")
        return read_flat_scene(path)


def meshes():
    center = np.array([1.0, 2.0, 3.0])
    for name, mesh, area in (("cube", cube(), 24), ("ball", sphere(np.zeros(3), 2.0), 16 * np.pi), ("moved ball", sphere(center, 2.0), 16 * np.pi)):
        corners = mesh.positions[mesh.triangles] - (center if name == "moved ball" else 0.0)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        check((np.einsum("ij,ij->i", normals, corners.mean(axis=1)) > 0).all(), f"a face of the {name} looks inwards")
        near(0.5 * np.linalg.norm(normals, axis=1).sum(), area, f"the area of the {name}", 1e-9 * area)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "one.ply"
        head = ("ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
                + "".join(f"property float {n}\n" for n in "xyz")
                + "element face 1\nproperty list uchar uint vertex_indices\nend_header\n")
        path.write_bytes(head.encode() + struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<B3I", 3, 0, 1, 2))
        mesh = read_ply(path)
        near(mesh.positions[2], [0, 1, 0], "a corner of a PLY file")
        check(mesh.normals is None and mesh.triangles.tolist() == [[0, 1, 2]], "faces of a PLY file")
    wall = flat('<shape type="rectangle"><transform name="to_world"><scale x="12" y="6" z="1"/><translate y="6" z="-4"/>'
                "</transform></shape>").all("shape")[0]
    mesh = mesh_of(wall, None)
    near(mesh.positions[:, 2], -4, "where a rectangle stands")
    near(mesh.positions.max(axis=0)[:2], [12, 12], "how large it is")
    mirrored = mesh.transformed(np.diag([-1.0, 1.0, 1.0, 1.0]))
    near(np.cross(*np.diff(mirrored.positions[mirrored.triangles[0]], axis=0))[2] > 0, True, "a mirrored one looks back")


def boundaries():
    """A cube of half 3 around a grid of half 1 is shrunk; one of half 0.5 stays."""
    for half, shrunk in ((3, True), (0.5, False)):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "g.vol").write_bytes(b"VOL\3" + struct.pack("<5i6f", 1, 2, 2, 2, 1, 0, 0, 0, 2, 2, 2))
            (folder / "scene.xml").write_text(
                '<scene><medium type="heterogeneous" id="m"><volume name="sigma_t" type="gridvolume">'
                '<string name="filename" value="g.vol"/><transform name="to_world"><translate x="-1" y="-1" z="-1"/>'
                f'</transform></volume></medium><shape type="cube"><transform name="to_world"><scale value="{half}"/>'
                '</transform><ref name="interior" id="m"/></shape></scene>')
            check(bool(tighten(folder)) == shrunk, f"a boundary of half {half}")
            shape = read_flat_scene(folder / "scene.xml").all("shape")[0]
            near(shape.transforms["to_world"][0, 0], 1 if shrunk else half, "its half side", 1e-3)


def furnace():
    """White rough plastic under light from everywhere, seen from cosine 0.9."""
    for alpha, beckmann, ggx in WHITE_PLASTIC:
        for kind, expected in (("beckmann", beckmann), ("ggx", ggx)):
            interface = RoughInterface(1.49, alpha, kind)
            reflected, _, through = boundary(0.9, 1.49, alpha, kind)
            here = reflected + through * interface.mean_transmittance / 1.49**2 / (1 - interface.inside)
            near(here, expected, f"white plastic, {kind} {alpha}", 0.004)  # the grid of facets: 256 slopes
    near(boundary(1.0, 1.5, 0.0, "ggx")[0], 0.04, "Fresnel at normal incidence")


def errors():
    """One broken pixel of a reference is left out."""
    a, b = np.full((10, 16, 3), 0.5), np.full((10, 16, 3), 0.6)
    b[3, 4] = 1e9
    broken = broken_pixels(a, b)
    check(broken.sum() == 1 and broken[3, 4], f"a broken pixel: {np.argwhere(broken)}")


def times():
    runs = [{"wall_s": t, "error": 0.2 / t**0.5, "passes": t} for t in (1, 2, 4, 8, 16, 32)]
    near(time_to(0.05, runs, "wall_s")[0], 16, "the time to 5 %", 1e-6)
    check(time_to(0.05, runs, "wall_s")[1] == "measured", "5 % is measured")
    value, how = time_to(0.01, runs, "wall_s")
    near(value, 400, "the time to 1 %", 1e-6)
    check(how == "by slope", "1 % is not measured")
    slow = [{"wall_s": t, "error": 0.2 / t**0.25} for t in (1, 2, 4)]
    near(time_to(0.05, slow, "wall_s", False)[0], 256, "the time to 5 % by the slope of the last two", 1e-6)
    near(time_to(0.05, slow, "wall_s")[0], 32, "the time to 5 % by 1/sqrt(t)", 1e-6)
    flat = [{"wall_s": t, "error": 0.02} for t in (1, 2)]
    check(time_to(0.01, flat, "wall_s", False) == (None, "bias"), "an error that stays never comes to 1 %")
    check(time_to(0.3, runs, "wall_s") == (1, "below"), "30 % is below the first")
    near(noise_alone([{"error": 0.05}], (0.03, 0.001))[0]["error"], 0.04, "noise without what is systematic")
    check(next_passes(runs[:1], 64) == 4 and next_passes(runs[:2], 64) == 4, "passes that double")
    check(next_passes(runs, 64) is None, "the budget ends")
    check(next_passes(runs[:1], 2) == 1, "two pictures at least")
    check([next_passes(runs[:n], [3, 5]) for n in range(3)] == [3, 5, None], "passes by a list")


for part in (transforms, scenes, meshes, boundaries, furnace, errors, times):
    part()
print("\n".join(failures) or "experiments/peers computes what it should")
sys.exit(1 if failures else 0)
