"""The axes of a random scene: each has an ordinary value, and with a small probability an extreme one.

Extremes are rare in each axis, so that a scene has one or two of them and a difference has few possible causes.
"""
import random
from dataclasses import asdict, dataclass

EXTREME = 0.15  # probability of an extreme value, for each axis


def dice(seed, number):
    """Random numbers of one scene: the same on every machine."""
    return random.Random(f"attack {seed} {number}")


def log_uniform(rng, low, high):
    """10^x with x uniform between the exponents."""
    return 10.0 ** rng.uniform(low, high)


@dataclass
class Axes:
    """Values of one scene. Lengths are canonical: walls stand at -2 and 2; `unit` and `offset` are applied last."""
    unit: float            # [m] length that the canonical 1 becomes
    offset: float          # distance of the scene from the origin, in canonical lengths
    shell: str             # walls around the scene
    media: str             # arrangement of media
    medium: str            # kind of the first medium
    tau: float             # optical depth across four canonical lengths
    g: float               # mean cosine of the phase function
    albedo: tuple
    glow: bool             # media emit
    lights: tuple          # kinds of lights
    power: float           # factor on all lights
    camera: str            # where it stands
    sensor: str
    objects: int
    oddity: str            # a degenerate or unusual shape; empty for none
    film: tuple
    max_depth: int
    end: bool              # a parameter stands at the end of its declared range

    def facts(self):
        """The axes as JSON has them; conditions of known findings refer to these names."""
        return {**asdict(self), "film": "x".join(map(str, self.film))}


MEDIA = ("none", "none", "none", "box", "box", "sphere", "room", "nested", "overlapping", "coincident", "flat", "sensor")
LIGHTS = ("area", "area", "sphere_light", "point", "spot", "directional", "constant", "envmap", "projector")
CAMERAS = ("outside", "outside", "outside", "inside", "inside", "in_wall", "on_boundary", "along_wall")
ODDITIES = ("zero_area", "needles", "flat_cube", "radius_0", "nan_mesh", "coincident_shapes", "instance", "tiny_instance",
            "mirrored_instance", "nested_cubes", "empty_group", "light_in_wall", "light_at_camera", "closed_light")
FILMS = ((1, 1), (1, 40), (40, 1), (3, 2), (48, 32))


def _extreme(rng, ordinary, extreme):
    """Both are sampled, so that an axis never changes those after it."""
    values = ordinary(rng), extreme(rng)
    return values[rng.random() < EXTREME]


def _ordinary_albedo(rng):
    return tuple(round(rng.uniform(0.3, 0.95), 3) for _ in range(3))


def _extreme_albedo(rng):
    return rng.choice(((0.0,) * 3, (1.0,) * 3, (0.0, 0.5, 1.0), (1.0, 1e-6, 0.999999), (0.999,) * 3))


def _extreme_lights(rng):
    return rng.choice(((), ("many",), tuple(rng.choice(LIGHTS) for _ in range(4))))


def sample_axes(rng):
    """The axes of a scene from its random numbers."""
    return Axes(
        unit=_extreme(rng, lambda r: 1.0, lambda r: log_uniform(r, -9, 9)),
        offset=_extreme(rng, lambda r: 0.0, lambda r: log_uniform(r, 0, 6)),
        shell=rng.choice(("open", "open", "closed", "floor", "none")),
        media=rng.choice(MEDIA),
        medium=rng.choice(("homogeneous", "homogeneous", "grid", "constant_grid", "spike", "vdb")),
        tau=_extreme(rng, lambda r: log_uniform(r, -1, 1), lambda r: log_uniform(r, -3, 6)),
        g=_extreme(rng, lambda r: r.choice((0.0, r.uniform(-0.6, 0.8))),
                   lambda r: r.choice((-1, 1)) * (1.0 - log_uniform(r, -3, -0.7))),
        albedo=_extreme(rng, _ordinary_albedo, _extreme_albedo),
        glow=rng.random() < 0.1,
        lights=_extreme(rng, lambda r: (r.choice(LIGHTS),), _extreme_lights),
        power=_extreme(rng, lambda r: 1.0, lambda r: log_uniform(r, -30, 30)),
        camera=rng.choice(CAMERAS),
        sensor=_extreme(rng, lambda r: "perspective", lambda r: r.choice(("orthographic", "thinlens"))),
        objects=rng.randrange(4),
        oddity=_extreme(rng, lambda r: "", lambda r: r.choice(ODDITIES)),
        film=_extreme(rng, lambda r: (16, 12), lambda r: r.choice(FILMS)),
        max_depth=rng.choice((-1, -1, -1, rng.randrange(2, 7))),
        end=rng.random() < EXTREME)

