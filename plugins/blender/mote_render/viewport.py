"""The viewport: a live render of the scene as it is seen there, drawn as a texture."""
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
    """RuntimeError where nothing can be drawn."""
    if bpy.app.background:
        raise RuntimeError("the viewport needs a drawing context, which Blender without a window does not have: render with F12")


class Viewport:
    """One region of a window. The scene is exported again when it has changed; a moved view is a message."""

    def __init__(self, engine):
        require_drawing()
        self.engine, self.live, self.camera = engine, None, None
        self.folder = Path(tempfile.mkdtemp(prefix="mote_view_"))

    def start(self, depsgraph, camera):
        """Renders the scene as it is now."""
        self.stop()
        export_scene(depsgraph, self.folder, camera.size, camera)
        settings = depsgraph.scene.mote
        options = ["--passes", str(settings.passes), "--seed", str(settings.seed)]
        if settings.threads:
            options += ["--threads", str(settings.threads)]
        self.live, self.camera = LiveView(preferences.command(), self.folder / "scene.xml", options, self.engine.tag_redraw), camera

    def follow(self, depsgraph, context):
        """Shows what the region shows."""
        camera = ViewCamera(context.region_data, (context.region.width, context.region.height))
        if self.live is None or not camera.same_lens(self.camera):
            self.start(depsgraph, camera)
        elif camera.pose != self.camera.pose:
            self.camera = camera
            self.live.move(*camera.pose)

    def draw(self, scene, size):
        import gpu
        from gpu_extras.presets import draw_texture_2d
        if self.live is None or self.live.image is None:
            return
        pixels = self.live.image[::-1]
        height, width = pixels.shape[:2]
        opaque = np.concatenate([pixels, np.ones_like(pixels[..., :1])], axis=2)
        texture = gpu.types.GPUTexture((width, height), format="RGBA32F",
                                       data=gpu.types.Buffer("FLOAT", opaque.size, np.ascontiguousarray(opaque).ravel()))
        self.engine.bind_display_space_shader(scene)
        draw_texture_2d(texture, (0, 0), *size)
        self.engine.unbind_display_space_shader()

    def stop(self):
        if self.live is not None:
            self.live.close()
        self.live = None

    def close(self):
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)
