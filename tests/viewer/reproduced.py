"""What the viewer saved against what the command that it printed renders."""
import os
import shlex
import subprocess
import sys

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "..", "tools"))
from pixel_hash import pixel_hash  # noqa: E402


def same_bits(mote, command, saved, folder):
    """True where `mote render` makes the same picture; `saved` are the bytes of the EXR file."""
    ours = os.path.join(folder, "saved.exr")
    with open(ours, "wb") as file:
        file.write(saved)
    subprocess.run([mote, *shlex.split(command)[1:], "--quiet"], check=True, cwd=folder)
    return pixel_hash(ours) == pixel_hash(os.path.join(folder, "view.exr"))
