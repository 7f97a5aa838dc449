"""Cycles in Blender's module bpy (experiments/peers/cycles): "denoise" by its own OpenImageDenoise, "guiding"."""
import subprocess

from _peer import Peer


class Renderer(Peer):
    program = "cycles"

    def missing(self):
        from peer_runs import python_with_bpy
        return "" if python_with_bpy() else "Cycles is not installed (tools/install_bpy.sh, or MOTE_CYCLES_PYTHON)"

    def version(self):
        from peer_runs import python_with_bpy
        done = subprocess.run([python_with_bpy(), "-c", "import bpy; print(bpy.app.version_string)"], capture_output=True, text=True,
                              check=True)
        return f"Cycles {done.stdout.strip().splitlines()[-1]}"
