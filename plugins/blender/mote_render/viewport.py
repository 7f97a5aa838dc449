"""The viewport: a live render of the scene as it is seen there, as a texture."""
import atexit
import shutil
import tempfile
from pathlib import Path

import bpy
import numpy as np

from . import preferences
from .export_camera import ViewCamera
from .export_scene import export_scene
from .live_view import LiveView


def require_drawing():
    """RuntimeError where there is no drawing context."""
    if bpy.app.background:
        raise RuntimeError("the viewport needs a drawing context, which Blender without a window does not have: render with F12")


class Viewport:
    """One region of a window. The scene is exported again when it has changed; a moved view is a message."""

    def __init__(self, redraw):
        """redraw() is called in a thread for each new image."""
        self.redraw, self.live, self.camera, self.problem = redraw, None, None, ""
        self.folder = Path(tempfile.mkdtemp(prefix="mote_view_"))

    def start(self, depsgraph, camera):
        """Renders the scene as it is now."""
        self.stop()
        export_scene(depsgraph, self.folder, camera.size, camera)
        settings = depsgraph.scene.mote
        options = ["--passes", str(settings.passes), "--seed", str(settings.seed)]
        if settings.threads:
            options += ["--threads", str(settings.threads)]
        self.live, self.camera = LiveView(preferences.command(), self.folder / "scene.xml", options, self.redraw), camera

    def follow(self, depsgraph, context):
        """Shows what the region shows."""
        camera = ViewCamera(context.region_data, (context.region.width, context.region.height))
        if self.live is None or not camera.same_lens(self.camera):
            self.start(depsgraph, camera)
        elif camera.pose != self.camera.pose:
            self.camera = camera
            self.live.move(*camera.pose)

    def draw(self, depsgraph, context):
        """Draws the last image; a scene that fails is tried again when it has changed."""
        try:
            require_drawing()
            if not self.problem:
                self.follow(depsgraph, context)
            self.problem = self.problem or self.live.problem
            if self.live is not None and self.live.image is not None:
                draw_image(self.live.image, (context.region.width, context.region.height))
        except (RuntimeError, ValueError, OSError) as error:
            self.problem = str(error)

    def stop(self):
        self.problem = ""
        if self.live is not None:
            self.live.close()
        self.live = None

    def close(self):
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)


def draw_image(image, size):
    """Rows from the top, in the scene's linear colours, which Blender's view transform follows."""
    import gpu
    from gpu_extras.presets import draw_texture_2d
    height, width = image.shape[:2]
    opaque = np.ones((height, width, 4), np.float32)
    opaque[..., :3] = image[::-1]
    texture = gpu.types.GPUTexture((width, height), format="RGBA32F", data=gpu.types.Buffer("FLOAT", opaque.size, opaque.ravel()))
    draw_texture_2d(texture, (0, 0), *size)


VIEWPORTS = {}  # by id() of the engine: an engine that has ended has no members any more


def of(engine):
    """The viewport of a render engine."""
    if id(engine) not in VIEWPORTS:
        VIEWPORTS[id(engine)] = Viewport(engine.tag_redraw)
    return VIEWPORTS[id(engine)]


def forget(key):
    view = VIEWPORTS.pop(key, None)
    if view is not None:
        view.close()


atexit.register(lambda: [forget(key) for key in list(VIEWPORTS)])
