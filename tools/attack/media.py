"""Media of random scenes, and the regions that hold them."""
import os
import struct
from pathlib import Path

from axes import log_uniform
from xml_parts import NULL, real, rgb, shape

SMOKE = ("vdb/openusd/smoke_000002.vdb", "vdb/openusd/smoke_000003.vdb", "vdb/gaffer/GafferVDBTest/data/smoke.vdb")


DATA = Path(os.environ.get("MOTE_TEST_DATA") or Path(__file__).resolve().parents[3] / "shared/data").resolve()


def write_grid(path, values, side):
    """A .vol file of side^3 float voxels."""
    header = b"VOL\x03" + struct.pack("<5i6f", 1, side, side, side, 1, 0, 0, 0, 1, 1, 1)
    path.write_bytes(header + struct.pack(f"<{side ** 3}f", *values))


def grid_values(rng, kind, side):
    if kind == "spike":
        values = [0.1] * side ** 3
        values[rng.randrange(side ** 3)] = log_uniform(rng, 0, 6)
        return values
    return [max(0.0, rng.uniform(-0.5, 2.0)) for _ in range(side ** 3)]


class MediaWriter:
    """Media of a scene as text; grids are written to `folder`."""

    def __init__(self, rng, axes, place, folder, types):
        self.rng, self.axes, self.place, self.folder, self.types = rng, axes, place, Path(folder), types
        self.count = 0

    def phase(self):
        """Mostly Henyey-Greenstein of the axis g; else any registered phase function as its manual page has it."""
        others = self.types.examples("phase")
        if self.rng.random() < 0.2 and others:
            return self.rng.choice(others)
        return f'<phase type="hg">{real("g", self.axes.g)}</phase>' if self.axes.g else ""

    def coefficients(self, tau):
        """Extinction per channel for this optical depth across four canonical lengths."""
        return [tau * c / (4.0 * self.place.unit) for c in (1.0, 0.9, 1.2)]

    def medium(self, kind, name, size, centre):
        """`size` and `centre` of the box that grids fill."""
        axes, inside = self.axes, rgb("albedo", self.axes.albedo) + self.phase()
        if axes.glow:
            inside += rgb("Le", [axes.power * c for c in (0.3, 0.2, 0.1)])
        named = f' name="{name}"' if name else ""
        if kind == "homogeneous":
            return f'<medium type="homogeneous"{named}>{rgb("sigma_t", self.coefficients(axes.tau))}{inside}</medium>'
        return (f'<medium type="heterogeneous"{named}>{self.volume(kind, size, centre)}{inside}'
                f'{real("scale", axes.tau / (4.0 * self.place.unit))}</medium>')

    def volume(self, kind, size, centre):
        if kind == "constant_grid":
            return '<volume type="constvolume" name="sigma_t"><rgb name="value" value="1, 0.5, 2"/></volume>'
        if kind == "vdb":
            smoke = DATA / self.rng.choice(SMOKE)
            return (f'<volume type="vdbvolume" name="sigma_t"><string name="filename" value="{smoke}"/>'
                    f"{self.place.transform(translate=centre)}</volume>")
        self.count += 1
        path, side = self.folder / f"grid_{self.count}.vol", self.rng.choice((1, 2, 4, 8))
        write_grid(path, grid_values(self.rng, kind, side), side)
        corner = [c - s for c, s in zip(centre, size)]
        transform = self.place.transform([2 * s for s in size], "", corner)
        return (f'<volume type="gridvolume" name="sigma_t"><string name="filename" value="{path.name}"/>'
                f"{transform}</volume>")

    def region(self, size, centre=(0, 0, 0), kind="cube", medium=None):
        """A shape without a surface of its own, filled with a medium."""
        held = self.medium(medium or self.axes.medium, "interior", size, centre)
        return shape(kind, self.place.transform(size, "", centre) + NULL + held)

    def all(self):
        """Every region of the arrangement; what the sensor names is not among them."""
        tiny = log_uniform(self.rng, -6, -1)
        arrangements = {
            "box": lambda: [self.region((1.2, 1.0, 1.1), (0.2, -0.3, 0.1))],
            "sphere": lambda: [self.region((1.3, 1.3, 1.3), (0, 0, 0), "sphere")],
            "room": lambda: [self.region((2, 2, 2))],
            "nested": lambda: [self.region((1.5, 1.5, 1.5)), self.region((0.7, 0.7, 0.7), (0.1, 0, 0), "sphere", "homogeneous")],
            "overlapping": lambda: [self.region((1, 1, 1), (-0.4, 0, 0)), self.region((1, 1, 1), (0.5, 0.2, 0), medium="homogeneous")],
            "coincident": lambda: [self.region((1, 1, 1)), self.region((1, 1, 1), medium="homogeneous")],
            "flat": lambda: [self.region((1.8, tiny, 1.8), (0, -1, 0))],
        }
        return arrangements.get(self.axes.media, list)()
