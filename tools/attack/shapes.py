"""Surfaces of random scenes: walls, objects, and degenerate or unusual shapes."""
from axes import log_uniform
from lights import DELTA
from xml_parts import diffuse, number, shape, xyz

# Without a mirror-like lobe: where lights are points, volpath cannot see what such lobes focus, and others can.
ROUGH = ("diffuse", "roughconductor", "roughplastic", "phong", "twosided", "principledthin")


def write_mesh(path, rng, oddity):
    """A PLY file of random triangles, some of them degenerate."""
    vertices = [tuple(rng.uniform(-0.5, 0.5) for _ in range(3)) for _ in range(24)]
    faces = [tuple(rng.sample(range(24), 3)) for _ in range(16)]
    if oddity == "zero_area":
        faces += [(0, 0, 1), (3, 3, 3)]
    if oddity == "needles":
        vertices += [(0.0, -0.5, 0.0), (1e-7, 0.5, 0.0), (0.0, 0.5, 1e-7)]
        faces += [(24, 25, 26)] * 3
    if oddity == "nan_mesh":
        vertices[5] = (float("nan"), 0.0, float("inf"))
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property float {a}" for a in "xyz"),
             f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header",
             *(" ".join(map(number, v)) for v in vertices), *(f"3 {a} {b} {c}" for a, b, c in faces)]
    path.write_text("\n".join(lines) + "\n")


class ShapeWriter:
    """Surfaces of a scene as text; meshes are written to `folder`."""

    def __init__(self, rng, axes, place, folder, types):
        self.rng, self.axes, self.place, self.folder = rng, axes, place, folder
        rough_only = any(kind in DELTA for kind in axes.lights)
        self.bsdfs = types.examples("bsdf", ROUGH if rough_only else None)

    def bsdf(self):
        if self.rng.random() < 0.6:
            return diffuse([round(self.rng.uniform(0.1, 0.8), 2) for _ in range(3)])
        return self.rng.choice(self.bsdfs)

    def walls(self):
        turns = {"floor": ('<rotate x="1" angle="-90"/>', (0, -2, 0)), "back": ("", (0, 0, -2)),
                 "left": ('<rotate y="1" angle="90"/>', (-2, 0, 0)), "right": ('<rotate y="1" angle="-90"/>', (2, 0, 0))}
        names = {"open": ("floor", "back", "left", "right"), "floor": ("floor",)}.get(self.axes.shell, ())
        walls = [shape("rectangle", self.place.transform((2, 2, 1), *turns[name]) + diffuse((0.6, 0.5, 0.4))) for name in names]
        if self.axes.shell == "closed":
            walls.append(shape("cube", self.place.transform((2, 2, 2)) + diffuse((0.5, 0.6, 0.5))))
        return walls

    def object(self):
        rng = self.rng
        kind = rng.choice(("sphere", "cube", "cylinder", "disk", "rectangle"))
        turn = f'<rotate x="1" y="0.3" angle="{rng.randrange(360)}"/>'
        size = [rng.uniform(0.2, 0.6)] * 3
        return shape(kind, self.place.transform(size, turn, [rng.uniform(-1.2, 1.2) for _ in range(3)]) + self.bsdf())

    def odd(self):
        oddity, place, rng = self.axes.oddity, self.place, self.rng
        if oddity in ("zero_area", "needles", "nan_mesh"):
            write_mesh(self.folder / "mesh.ply", rng, oddity)
            return shape("ply", '<string name="filename" value="mesh.ply"/>' + place.transform() + self.bsdf())
        if oddity == "flat_cube":
            return shape("cube", place.transform((1, log_uniform(rng, -20, -3), 1)) + self.bsdf())
        if oddity == "radius_0":
            return shape("sphere", '<float name="radius" value="0"/>' + place.transform() + self.bsdf())
        if oddity == "coincident_shapes":
            return 2 * shape("cube", place.transform((0.6, 0.6, 0.6)) + diffuse((0.5, 0.5, 0.5)))
        if oddity == "nested_cubes":
            return "".join(shape("cube", place.transform([0.1 * i] * 3) + diffuse((0.5, 0.5, 0.5))) for i in range(1, 9))
        if oddity == "empty_group":
            return '<shape type="shapegroup" id="group"/>' + self.instance((1, 1, 1))
        if oddity.endswith("instance"):
            scale = {"instance": (0.5, 2, 1), "tiny_instance": (log_uniform(rng, -20, -3), 1, 1), "mirrored_instance": (-1, 0.3, 2)}
            group = shape("shapegroup", shape("sphere", '<float name="radius" value="0.4"/>' + self.bsdf()), ' id="group"')
            return group + self.instance(scale[oddity])
        return ""

    def instance(self, scale):
        return shape("instance", '<ref id="group"/>' + self.place.transform(scale, "", (0.3, -0.4, 0.2)))

    def all(self):
        return [*self.walls(), *(self.object() for _ in range(self.axes.objects)), self.odd()]
