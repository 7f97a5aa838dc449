"""A whole scene, as Blender would render it, as scene.xml with meshes and pictures beside it."""
from . import properties
from .export_camera import add_camera
from .export_lights import add_lights
from .export_materials import Materials
from .export_meshes import add_meshes
from .export_world import add_world
from .scene_xml import Export, add, add_value


def export_scene(depsgraph, folder, size, view=None):
    """Writes folder/scene.xml; returns (where the picture begins in the film, what was approximated). `view`: a ViewCamera
    instead of the scene's camera.
    """
    export, settings = Export(folder), depsgraph.scene.mote
    export.pixel_filter = settings.pixel_filter
    add_integrator(export, settings)
    begin = view.add_to(export) if view else add_camera(export, depsgraph, size)
    render = depsgraph.scene.render
    for wrong, text in ((render.use_motion_blur, "motion blur"), (render.film_transparent, "the transparent film"),
                        (render.use_border, "the render region")):
        if wrong:
            export.note(f"{text} is left out")
    add_meshes(export, depsgraph, Materials(export))
    add_lights(export, depsgraph)
    add_world(export, depsgraph.scene)
    kinds = {e.get("type") for e in export.root.iter("emitter")}
    if "area" in kinds and kinds & {"constant", "envmap"}:
        export.note("lamps with a size hide the world behind them")
    export.write(folder / "scene.xml")
    return begin, export.notes


def add_integrator(export, settings):
    integrator = add(export.root, "integrator", settings.integrator)
    for name, kind, value in properties.parameters(settings):
        if kind in properties.TABLE["objects"]:
            add(integrator, kind, value, name)
        elif kind == "boolean" or not isinstance(value, str) or kind == "string":
            add_value(integrator, name, value)
        else:  # a number whose default the page describes in words
            add_value(integrator, name, int(value) if kind == "integer" else float(value))
