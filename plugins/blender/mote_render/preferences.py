"""Where the command is: the add-on's preferences, else MOTE_COMMAND, else `mote` on the path."""
import os
import shutil

import bpy


class MotePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    command: bpy.props.StringProperty(
        name="Command", subtype="FILE_PATH",
        description="The command mote; empty: the variable MOTE_COMMAND, else mote on the path")

    def draw(self, _context):
        self.layout.prop(self, "command")


def command():
    """The command's path; RuntimeError where there is none."""
    addon = bpy.context.preferences.addons.get(__package__)
    chosen = (addon.preferences.command if addon else "") or os.environ.get("MOTE_COMMAND", "") or "mote"
    found = shutil.which(bpy.path.abspath(chosen))
    if found is None:
        raise RuntimeError(f"the command '{chosen}' is not there: set it in the add-on's preferences or in MOTE_COMMAND")
    return found


CLASSES = [MotePreferences]
