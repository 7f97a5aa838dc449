"""The camera. Blender's looks along -z with x to the right, ours along z with x to the left.

A shift is a picture that is wider or higher on one side and cut: exact to half a pixel, and it costs what is cut.
"""
import math

from mathutils import Matrix, Vector

from .scene_xml import add, add_matrix

TURNED = Matrix.Diagonal((-1, 1, -1, 1))
BEHIND = 100.0  # a parallel view begins so far behind its origin [m]


def add_camera(export, depsgraph, size):
    """Adds the sensor and its film; returns (x, y) [pixels from the top left] where `size` begins in the film."""
    scene = depsgraph.scene
    if scene.camera is None:
        raise RuntimeError("the scene has no camera")
    obj = scene.camera.evaluated_get(depsgraph)
    camera = obj.data
    frame = camera.view_frame(scene=scene)
    low, high = [[f(corner[i] for corner in frame) for i in (0, 1)] for f in (min, max)]
    middle, extent = [(a + b) / 2 for a, b in zip(low, high)], [b - a for a, b in zip(low, high)]
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        export.note("camera: pixels became square")
    matrix = obj.matrix_world.normalized() @ TURNED
    clip = {"near_clip": float(camera.clip_start), "far_clip": float(camera.clip_end)}
    if camera.type == "ORTHO":
        if camera.dof.use_dof:
            export.note("camera: depth of field of an orthographic one is left out")
        across = Matrix.Translation(obj.matrix_world.normalized().to_3x3() @ Vector((*middle, 0)))
        sensor = add(export.root, "sensor", "orthographic", **clip)
        add_matrix(sensor, across @ matrix @ Matrix.Diagonal((extent[0] / 2, extent[0] / 2, 1, 1)))
        return add_film(export, sensor, size, (0, 0))
    if camera.type != "PERSP":
        export.note("camera: a panorama became a perspective")
    # Pixels that a symmetric film has more, by twice the shift; y counts down from the top.
    more = [round(2 * m / e * n) for m, e, n in zip(middle, extent, size)]
    distance = -frame[0][2]
    width = extent[0] * (size[0] + abs(more[0])) / size[0]
    lens = depth_of_field(export, obj, camera)
    sensor = add(export.root, "sensor", "thinlens" if lens else "perspective", fov_axis="x",
                 fov=math.degrees(2 * math.atan2(width / 2, distance)), **lens, **clip)
    add_matrix(sensor, matrix)
    return add_film(export, sensor, size, more)


def depth_of_field(export, obj, camera):
    """Radius of the lens opening [m], focal length over twice the f-number, and the distance of focus."""
    dof = camera.dof
    if not dof.use_dof:
        return {}
    if dof.aperture_blades or dof.aperture_ratio != 1:
        export.note("camera: its aperture is a circle")
    distance = dof.focus_distance
    if dof.focus_object is not None:
        along = obj.matrix_world.col[2].to_3d().normalized()
        distance = abs(along.dot(obj.matrix_world.translation - dof.focus_object.matrix_world.translation))
    return {"aperture_radius": camera.lens * 1e-3 / (2 * dof.aperture_fstop), "focus_distance": float(distance)}


def add_film(export, sensor, size, more):
    film = add(sensor, "film", "hdrfilm", width=size[0] + abs(more[0]), height=size[1] + abs(more[1]))
    add(film, "rfilter", export.pixel_filter)
    return max(more[0], 0), max(-more[1], 0)


class ViewCamera:
    """What a region of a window sees, without depth of field; shifts by less than half a pixel are left out."""

    def __init__(self, region, size):
        """`region`: a RegionView3D, `size` its pixels."""
        self.size = size
        p = region.window_matrix
        self.parallel = p[3][3] == 1.0
        self.matrix = region.view_matrix.inverted()
        if self.parallel:  # sees what is behind it, too
            self.matrix = self.matrix @ Matrix.Translation((0, 0, BEHIND))
        self.extent = 1.0 / p[0][0]  # half the width, at distance 1 of a perspective
        shift = (-p[0][3], -p[1][3]) if self.parallel else (p[0][2], p[1][2])  # of the middle, over half the extent
        self.more = [round(s * n) for s, n in zip(shift, size)]

    @property
    def pose(self):
        """Origin, target and up."""
        origin, turned = self.matrix.translation, self.matrix.to_3x3().normalized()
        return tuple(tuple(v) for v in (origin, origin - turned.col[2], turned.col[1]))

    def same_lens(self, other):
        """True where nothing but a pose of a perspective differs, which a message changes."""
        if self.parallel and self.pose != other.pose:
            return False
        return (self.size, self.parallel, self.more) == (other.size, other.parallel, other.more) \
            and abs(self.extent - other.extent) < 1e-5 * self.extent

    def add_to(self, export):
        """As add_camera()."""
        size, more = self.size, self.more
        width = self.extent * (size[0] + abs(more[0])) / size[0]
        matrix = self.matrix.normalized() @ TURNED
        if self.parallel:
            sensor = add(export.root, "sensor", "orthographic")
            add_matrix(sensor, matrix @ Matrix.Diagonal((width, width, 1, 1)))
        else:
            sensor = add(export.root, "sensor", "perspective", fov_axis="x", fov=math.degrees(2 * math.atan(width)))
            add_matrix(sensor, matrix)
        return add_film(export, sensor, size, more)
