"""The render panel, and Blender's own panels that make sense with mote."""
import bpy

from . import properties

# Panels of Blender that only its own engines understand.
FOREIGN = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes", "RENDER_PT_simplify"}


class MOTE_PT_render(bpy.types.Panel):
    bl_label, bl_space_type, bl_region_type, bl_context = "mote", "PROPERTIES", "WINDOW", "render"
    COMPAT_ENGINES = {"MOTE"}

    @classmethod
    def poll(cls, context):
        return context.engine == "MOTE"

    def draw(self, context):
        layout, settings = self.layout, context.scene.mote
        layout.use_property_split = True
        for name in ("passes", "seconds", "noise", "seed", "threads", "pixel_filter", "keep", "integrator"):
            layout.prop(settings, name)
        entry = properties.TABLE["integrators"][settings.integrator]
        for parameter in entry["parameters"]:
            layout.prop(getattr(settings, settings.integrator), parameter["name"])
        for line in settings.approximated.splitlines():
            layout.label(text=line, icon="INFO")


class MOTE_PT_passes(bpy.types.Panel):
    bl_label, bl_space_type, bl_region_type, bl_context = "Passes", "PROPERTIES", "WINDOW", "view_layer"
    COMPAT_ENGINES = {"MOTE"}

    @classmethod
    def poll(cls, context):
        return context.engine == "MOTE"

    def draw(self, context):
        for name in ("use_pass_z", "use_pass_normal", "use_pass_position"):
            self.layout.prop(context.view_layer, name)
        for name in context.scene.mote.layers.split():
            self.layout.label(text=name)


def share_panels(on):
    """Shows (or hides) with mote what Blender shows with its other engines."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and "BLENDER_RENDER" in engines and panel.__name__ not in FOREIGN:
            engines.add("MOTE") if on else engines.discard("MOTE")


CLASSES = [MOTE_PT_render, MOTE_PT_passes]
