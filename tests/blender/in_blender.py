"""Runs inside of Blender: installs the add-on and renders a room made here. Arguments: pictures | parts | cancel | live | window, ZIP,
FOLDER."""
import math
import sys
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).resolve().parent))
from making import add, check, colour, material, plane, render  # noqa: E402

SIZE = (96, 54)


def room():
    """A white floor and wall, a red cube with a bevel that stands there twice, an area lamp of 40 W above."""
    scene = bpy.context.scene
    white = material("white", "ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.7, 1))
    plane("floor", white, Matrix.Diagonal((3, 3, 1, 1)))
    plane("wall", white, Matrix.Translation((0, 2, 1)) @ Matrix.Rotation(math.pi / 2, 4, "X") @ Matrix.Diagonal((3, 3, 1, 1)))
    bpy.ops.mesh.primitive_cube_add(size=0.8, location=(-0.6, 0, 0.4))
    cube = bpy.context.object
    cube.data.materials.append(material("red", "ShaderNodeBsdfPrincipled", Base_Color=(0.7, 0.1, 0.1, 1), Roughness=0.4))
    add("copy", cube.data, Matrix.Translation((0.6, 0, 0.4)))
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.energy, lamp.size = 40, 1
    add("lamp", lamp, Matrix.Translation((0, 0, 3)))
    camera = bpy.data.cameras.new("camera")
    camera.angle = math.radians(50)
    scene.camera = add("camera", camera, Matrix.Translation((0, -4, 1.2)), Matrix.Rotation(math.radians(85), 4, "X"))
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = *SIZE, 100
    scene.render.engine = "MOTE"
    scene.mote.passes = 4
    return scene, cube


def pictures(folder):
    scene, cube = room()
    scene.view_layers[0].use_pass_z = scene.view_layers[0].use_pass_normal = True
    scene.mote.keep = str(folder / "kept")
    planes = render(scene, folder)
    beauty = colour(planes)
    check(beauty.shape[:2] == SIZE[::-1] and np.isfinite(beauty).all() and beauty.mean() > 0.01, "finite and not black")
    check(beauty[:20].mean() > 0 and np.ptp(beauty) > 0.05, "there is something to see")
    depth = planes["Depth.Z"]
    check(abs(depth[0, SIZE[0] // 2] - np.median(depth[0])) < 1 and 3 < np.nanmin(depth) < 4.5, "depth as Blender's pass")
    check(abs(planes["Normal.Z"][-1].mean() - 1) < 1e-3, "the floor's normal is up, at the bottom of the picture")
    red = beauty[..., 0] > 2 * beauty[..., 2]
    left, right = red[:, :SIZE[0] // 2].sum(), red[:, SIZE[0] // 2:].sum()
    check(left > 50 and abs(left - right) < 0.15 * left, "the cube stands there twice")
    check("shapegroup" in (folder / "kept" / "scene.xml").read_text(), "copies are instances")
    layers(scene, folder)
    modifiers(scene, cube, folder)
    camera(scene, folder)
    units(scene, folder)
    notes(scene)
    errors(scene)
    print("checked: all")


def layers(scene, folder):
    scene.mote.integrator, scene.mote.mote_vpl.paths = "mote_vpl", 32
    planes = render(scene, folder)
    check('name="paths" value="32"' in (folder / "kept" / "scene.xml").read_text(), "parameters of the panel arrive")
    total = sum(colour(planes, name) for name in scene.mote.layers.split() if "Albedo" not in name)
    check(len(scene.mote.layers.split()) >= 3 and np.allclose(total, colour(planes), atol=1e-5),
          f"render passes add up to the picture: {scene.mote.layers}")
    scene.mote.integrator = "volpath"


def modifiers(scene, cube, folder):
    faces = lambda: sum(path.stat().st_size for path in (folder / "kept").glob("mesh_*.ply"))
    before = faces()
    cube.modifiers.new("bevel", "BEVEL").segments = 8
    render(scene, folder)
    check(faces() > 2 * before, "meshes are those after modifiers")


def camera(scene, folder):
    """A shift of a quarter of the width moves the picture by as many pixels; so does an orthographic one."""
    data = scene.camera.data
    render(scene, folder)
    for kind in ("PERSP", "ORTHO"):
        data.type, data.ortho_scale, data.shift_x = kind, 4, 0.0
        scene.view_layers[0].use_pass_z = True
        still = np.minimum(render(scene, folder)["Depth.Z"], 20)
        data.shift_x = 0.25
        moved = np.minimum(render(scene, folder)["Depth.Z"], 20)
        check(np.median(np.abs(still[:, 24:] - moved[:, :-24])) < 0.02, f"shift of a camera: {kind}")
    data.type, data.shift_x = "PERSP", 0.0


def units(scene, folder):
    """One lamp at height h above a white plane: radiance rho/pi E below it, from E = I / h^2, and a sun's own."""
    for made in [o for o in scene.objects if o.type in ("MESH", "LIGHT")]:
        bpy.data.objects.remove(made)
    plane("floor", bpy.data.materials["white"], Matrix.Diagonal((50, 50, 1, 1)))
    scene.camera.matrix_world = Matrix.Translation((0, 0, 1))
    scene.camera.data.angle = math.radians(1)
    scene.mote.passes, rho = 16, 0.7
    for kind, radius, size, radiance in (("POINT", 0.0, 0, rho / math.pi * 100 / (4 * math.pi) / 9),
                                         ("POINT", 0.05, 0, rho / math.pi * 100 / (4 * math.pi) / 9),
                                         ("SPOT", 0.0, 0, rho / math.pi * 100 / (4 * math.pi) / 9),
                                         ("AREA", 0.0, 0.1, rho / math.pi * 100 / (math.pi if bpy.app.version >= (4, 5) else 4) / 9),
                                         ("SUN", 0.0, 0, rho / math.pi * 100)):
        lamp = bpy.data.lights.new("lamp", kind)
        lamp.energy = 100
        if kind == "AREA":
            lamp.size = size
        elif kind != "SUN":
            lamp.shadow_soft_size = radius
        made = add("lamp", lamp, Matrix.Translation((0, 0, 3)))
        found = colour(render(scene, folder)).mean()
        # The finite sizes and the picture's half degree change E by less than 2 (size / h)^2 = 0.002.
        check(abs(found / radiance - 1) < 0.003, f"100 W of {kind}, radius {radius}: {found:.5f} = {radiance:.5f}")
        bpy.data.objects.remove(made)


def notes(scene):
    mixed = material("hair", "ShaderNodeBsdfHair")
    scene.objects["floor"].data.materials[0] = mixed
    scene.mote.passes = 1
    add("lamp", bpy.data.lights.new("lamp", "SUN"), Matrix())
    bpy.ops.render.render()
    check("became a grey diffuse" in scene.mote.approximated, "what has no counterpart is listed")


def errors(scene):
    """A scene that mote refuses, no camera, no command: each is an error of Python with its reason."""
    scene.mote.integrator = "mote_vpl"
    scene.mote.mote_vpl.paths = -5
    expect("paths", "a parameter that mote refuses")
    scene.mote.mote_vpl.paths = 32
    bpy.context.preferences.addons["mote_render"].preferences.command = "no/such/mote"
    expect("no/such/mote", "a command that is not there")
    bpy.context.preferences.addons["mote_render"].preferences.command = ""
    check("FINISHED" in bpy.ops.render.render(), "and the next picture renders")  # resets Blender's own exit code as well


def expect(word, text):
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        return check(word in str(error), f"{text}: {str(error).strip()[:200]!r}")
    raise AssertionError(f"no error of {text}")


def cancelled(folder):
    scene, _ = room()
    scene.mote.passes, scene.mote.keep = 1000000, str(folder / "kept")
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = str(folder / "cancelled.exr")
    bpy.ops.render.render(write_still=True)
    from mote_render.exr import read_exr
    partial = read_exr(folder / "kept" / "picture.exr")
    check(np.isfinite(partial["R"]).all() and partial["R"].mean() > 0.01, "cancel keeps the picture so far")


def live(folder):
    """The live render of the viewport, without a window: the image of F12 where the view is the camera's, and it moves."""
    from types import SimpleNamespace

    from mote_render import viewport
    from mote_render.export_camera import ViewCamera
    from mote_render.export_scene import export_scene
    from mote_render.live_view import LiveView
    from mote_render.preferences import command
    scene, _ = room()
    still = colour(render(scene, folder))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    seen = SimpleNamespace(view_matrix=scene.camera.matrix_world.inverted(),
                           window_matrix=scene.camera.calc_matrix_camera(depsgraph, x=SIZE[0], y=SIZE[1]))
    camera = ViewCamera(seen, SIZE)
    export_scene(depsgraph, folder, SIZE, camera)
    view = LiveView(command(), folder / "scene.xml", ["--passes", "4"], lambda: None)
    try:
        first = finished(view)
        check(first.shape == (SIZE[1], SIZE[0], 3) and np.median(np.abs(first - still[..., :3])) < 1e-3 * first.mean(),
              "the live image of the camera's view is that of F12")
        origin, target, up = camera.pose
        view.move(*((x, y, z + 0.5) for x, y, z in (origin, target)), up)
        check(np.median(np.abs(finished(view) - first)) > 1e-2 * first.mean(), "a moved view shows something else")
    finally:
        view.close()
    try:
        viewport.require_drawing()
    except RuntimeError as error:
        check("drawing context" in str(error), f"without a window: {error}")
    else:
        raise AssertionError("the viewport was not refused")
    print("checked: all")


def finished(view):
    end = time.monotonic() + 120
    while not view.finished:
        check_alive(view, end)
    return view.image


def check_alive(view, end):
    if view.problem or time.monotonic() > end:
        raise AssertionError(view.problem or "no image within 120 s")
    time.sleep(0.02)


def window(folder):
    """In a window: the viewport shows the render. Runs after this script, as events do."""
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(lambda: show_room(folder), first_interval=1)


def show_room(folder):
    shown = bpy.context.window_manager.windows[0]
    area = next(a for a in shown.screen.areas if a.type == "VIEW_3D")
    with bpy.context.temp_override(window=shown, area=area, region=area.regions[-1]):
        room()
    space = area.spaces.active
    space.region_3d.view_perspective = "CAMERA"
    space.overlay.show_overlays = space.show_gizmo = False
    space.shading.type = "RENDERED"
    end = time.monotonic() + 60
    bpy.app.timers.register(lambda: look(folder, shown, area, end), first_interval=1)


def look(folder, shown, area, end):
    """Every second until the viewport shows the red cube, or a minute has passed."""
    area.tag_redraw()
    path = str(folder / "window.png")
    with bpy.context.temp_override(window=shown, area=area):
        bpy.ops.screen.screenshot(filepath=path)
    image = bpy.data.images.load(path)
    pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], -1)
    bpy.data.images.remove(image)
    x, y = area.x + area.width // 2, area.y + area.height // 2
    seen = pixels[y - 60:y + 60, x - 100:x + 100, :3]
    red = ((seen[..., 0] > 1.5 * seen[..., 2] + 0.02) & (seen[..., 0] > 1.5 * seen[..., 1] + 0.02)).mean()
    if red < 0.02 and time.monotonic() < end:
        return 1
    print(f"{'checked: all' if red >= 0.02 else 'FAILED'}, the red cube covers {100 * red:.0f} % of the viewport's middle", flush=True)
    bpy.ops.wm.quit_blender()
    return None


def main():
    what, archive, folder = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_install(filepath=archive, overwrite=True)
    bpy.ops.preferences.addon_enable(module="mote_render")
    if what == "parts":
        from parts import parts
        return parts(Path(folder))
    return {"pictures": pictures, "cancel": cancelled, "live": live, "window": window}[what](Path(folder))


main()
