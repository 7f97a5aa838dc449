"""Lights of random scenes."""
import struct

from xml_parts import number, real, rgb, shape

DELTA = ("point", "spot", "directional", "projector", "many")  # no path that a surface or phase function samples meets them


def write_sky(path, rng):
    """A small picture of a sky (PFM) with one bright pixel."""
    width, height = 8, 4
    values = [rng.uniform(0.1, 1.0) for _ in range(3 * width * height)]
    bright = 3 * rng.randrange(width * height)
    values[bright:bright + 3] = [50.0, 40.0, 30.0]
    path.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() + struct.pack(f"<{len(values)}f", *values))


class LightWriter:
    """Lights of a scene as text; pictures are written to `folder`."""

    def __init__(self, rng, axes, place, folder):
        self.rng, self.axes, self.place, self.folder = rng, axes, place, folder
        self.height = 2.0 if axes.oddity == "light_in_wall" else 1.7

    def colour(self, scale=1.0):
        """At most the 1e30 that lights may have."""
        return [min(1e30, self.axes.power * scale * c) for c in (1.0, 0.8, 0.6)]

    def position(self):
        rng = self.rng
        if self.axes.oddity == "light_at_camera":
            return (0.0, 0.2, 1.6)
        return (rng.uniform(-1.2, 1.2), rng.uniform(-0.5, 1.5), rng.uniform(-1.2, 1.2))

    def point(self):
        intensity = self.colour(10.0 * self.place.unit ** 2)
        return (f'<emitter type="point"><point name="position" value="{", ".join(map(number, self.place.point(self.position())))}"/>'
                f'{rgb("intensity", intensity)}</emitter>')

    def one(self, kind):
        place, aim = self.place, self.place.look(self.position(), (0.1, -1.5, 0.05))
        down = '<rotate x="1" angle="90"/>'
        if kind == "area":
            return shape("rectangle", place.transform((0.5, 0.5, 1), down, (0, self.height, 0)) + self.area(10.0))
        if kind == "sphere_light":
            closed = shape("cube", place.transform((0.4, 0.4, 0.4), "", (0.5, 1, 0))) if self.axes.oddity == "closed_light" else ""
            return shape("sphere", place.transform((0.25, 0.25, 0.25), "", (0.5, 1, 0)) + self.area(20.0)) + closed
        if kind == "spot":
            return f'<emitter type="spot">{aim}{rgb("intensity", self.colour(20 * place.unit ** 2))}{real("cutoff_angle", 40)}</emitter>'
        if kind == "projector":
            return (f'<emitter type="projector">{aim}{real("fov", 50)}{real("scale", min(1e30, self.axes.power * place.unit ** 2))}'
                    '<texture name="irradiance" type="checkerboard"/></emitter>')
        if kind == "directional":
            return f'<emitter type="directional"><vector name="direction" value="0.3, -1, -0.2"/>{rgb("irradiance", self.colour(3))}</emitter>'
        if kind == "constant":
            return f'<emitter type="constant">{rgb("radiance", self.colour())}</emitter>'
        if kind == "envmap":
            write_sky(self.folder / "sky.pfm", self.rng)
            return ('<emitter type="envmap"><string name="filename" value="sky.pfm"/>'
                    f'{real("scale", min(1e29, self.axes.power))}</emitter>')
        if kind == "many":
            return "".join(self.point() for _ in range(200))
        return self.point()

    def area(self, radiance):
        return f'<emitter type="area">{rgb("radiance", self.colour(radiance))}</emitter>'

    def all(self):
        """One sky at most: a scene may hold no more."""
        kinds, skies = [], 0
        for kind in self.axes.lights:
            skies += kind in ("constant", "envmap")
            kinds.append("point" if kind in ("constant", "envmap") and skies > 1 else kind)
        return [self.one(kind) for kind in kinds]
