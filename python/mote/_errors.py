"""The error of a scene, a file or a picture."""
from typing import List, Tuple

from . import _mote


class Error(Exception):
    """A scene, a file or a picture is at fault. The text is that of the command, with the nearest known word.

    file: which one; "" where there is none. In scenes of dictionaries the place in them: "scene.floor.bsdf".
    line: in it, from 1; 0 where there is none.
    errors: all that is wrong, as (text, file, line), in the order of the files.
    """

    file: str = ""
    line: int = 0
    errors: List[Tuple[str, str, int]] = []


_mote.register_error(Error)
