"""The render engine: export, run the command, show its picture and its layers; in the viewport a live render."""
import shutil
import tempfile
from pathlib import Path

import bpy

from . import command, passes, preferences, viewport
from .export_scene import export_scene


class MoteEngine(bpy.types.RenderEngine):
    bl_idname, bl_label = "MOTE", "mote"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def render(self, depsgraph):
        render = depsgraph.scene.render
        size = [int(n * render.resolution_percentage / 100) for n in (render.resolution_x, render.resolution_y)]
        keep = depsgraph.scene.mote.keep
        folder = Path(bpy.path.abspath(keep) if keep else tempfile.mkdtemp(prefix="mote_"))
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self.render_in(folder, depsgraph, size)
        except (RuntimeError, ValueError, OSError) as error:
            self.fail(str(error))
        except KeyboardInterrupt:  # the module bpy crashes when one leaves a callback
            self.fail("interrupted")
        finally:
            if not keep:
                shutil.rmtree(folder, ignore_errors=True)

    def render_in(self, folder, depsgraph, size):
        program = preferences.command()
        self.update_stats("mote", "exports the scene")
        begin, notes = export_scene(depsgraph, folder, size)
        settings = depsgraph.scene.original.mote
        settings.approximated = "\n".join(notes)
        for note in notes:
            self.report({"WARNING"}, "mote: " + note)
        picture = folder / "picture.exr"
        picture.unlink(missing_ok=True)
        code, words, cancelled = command.run(
            [program, "render", str(folder / "scene.xml"), "-o", str(picture), *options(settings),
             *(["--auxiliary"] if passes.wants_features(depsgraph.view_layer) else [])], self.progress, self.test_break)
        if picture.is_file() and (cancelled or code == 0):
            settings.layers = " ".join(passes.show(self, picture, size, begin, depsgraph.view_layer))
        elif not cancelled:
            raise RuntimeError(f"mote ended with {code}: {words}")

    def progress(self, text, share):
        self.update_stats("mote", text)
        self.update_progress(share)

    def fail(self, text):
        """F12 shows it; Python gets it as RuntimeError of bpy.ops.render.render."""
        self.report({"ERROR"}, text)
        self.error_set(text)

    def view_update(self, context, depsgraph):
        """The scene has changed, or is shown for the first time."""
        viewport.of(self).stop()

    def view_draw(self, context, depsgraph):
        shown = viewport.of(self)
        shown.draw(depsgraph, context)
        self.update_stats("mote", shown.problem)

    def __del__(self):
        viewport.forget(id(self))

    def update_render_passes(self, scene, view_layer):
        """Layers of the last picture: which there are the integrator decides."""
        passes.register(self, scene, view_layer)


def options(settings):
    result = ["--passes", str(settings.passes), "--seed", str(settings.seed)]
    for name, flag in (("seconds", "--time"), ("noise", "--noise"), ("threads", "--threads")):
        if getattr(settings, name):
            result += [flag, str(getattr(settings, name))]
    return result


CLASSES = [MoteEngine]
