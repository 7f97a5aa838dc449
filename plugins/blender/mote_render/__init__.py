"""mote as a render engine of Blender 3.4 to 4.5: the scene is written to a folder, the command `mote` renders it."""
bl_info = {
    "name": "mote",
    "author": "The mote authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "category": "Render",
    "location": "Render properties > Render Engine",
    "description": "Many-light rendering and participating media",
}

import bpy

from . import engine, panels, preferences, properties

CLASSES = [*preferences.CLASSES, *properties.CLASSES, *engine.CLASSES, *panels.CLASSES]


def register():
    for made in CLASSES:
        bpy.utils.register_class(made)
    bpy.types.Scene.mote = bpy.props.PointerProperty(type=properties.MoteSettings)
    panels.share_panels(True)


def unregister():
    panels.share_panels(False)
    del bpy.types.Scene.mote
    for made in reversed(CLASSES):
        bpy.utils.unregister_class(made)
