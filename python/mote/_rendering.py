"""Rendering."""
from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any, Callable, Dict, Optional, Union

from . import _mote
from ._paths import oidn_package, path_text
from ._picture import Picture
from ._scene import Scene, load


def _line(progress: Dict[str, Any]) -> None:
    wanted = f" of {progress['passes_wanted']}" if progress["passes_wanted"] else ""
    left = f", {progress['seconds_left']:.0f} s left" if progress["seconds_left"] is not None else ""
    noise = f", noise {100 * progress['noise']:.2g} %" if progress["noise"] < float("inf") else ""
    print(f"\rpass {progress['passes']}{wanted}, {progress['seconds']:.1f} s{left}{noise}   ", end="", file=sys.stderr,
          flush=True)


def render(scene: Union[Scene, str, Path], *, passes: Optional[int] = None, seconds: Optional[float] = None,
           noise: Optional[float] = None, error: Optional[float] = None, seed: int = 0, threads: int = 0,
           progress: Union[bool, Callable[[Dict[str, Any]], Any]] = False,
           callback: Optional[Callable[[Picture], Any]] = None, checkpoint: Union[str, Path, None] = None,
           checkpoint_every: float = 60.0, resume: bool = False, auxiliary: bool = False, denoise: str = "") -> Picture:
    """Renders until the first of these rules holds: so many passes, so many seconds (from the call on), a noise such as
    0.02 (relative), or an error whose interval is below this, bias included (for a scene loaded with
    define={"film.interval": True}, and a method whose error is known: docs/testing.md). Without any: the scene's sample_count of passes. Scene, seed and passes determine every bit of the
    picture, whatever the number of threads (0: one for every core).

    progress: True prints a line; a function is called with {"passes", "passes_of_this_run", "passes_wanted", "seconds",
    "seconds_left", "noise"}. callback: called now and then with the Picture so far (its beauty). Either may return False
    to stop: the picture is then `interrupted`, and holds what there is. Both are called in the caller's thread; other
    threads of Python run meanwhile.

    Ctrl-C, or an exception of a callback, ends the render within two seconds. What there is is kept: the exception has
    it as its attribute `picture`:

        try:
            picture = mote.render(scene, seconds=3600)
        except KeyboardInterrupt as stopped:
            picture = stopped.picture

    checkpoint: a file of its own, refused where something else stands there, that is written every `checkpoint_every` seconds and when the render is interrupted; with
    resume=True the render continues from there, to the very bits that it would have had. auxiliary: also layers of what
    is seen (Albedo, N, Ns, P, Depth, ...). denoise: "bmfr", or "oidn" where it is installed, adds the layer "denoised".
    Raises mote.Error, and ValueError for arguments out of range.
    """
    if not isinstance(scene, Scene):
        scene = load(scene)
    for value, name in ((passes, "passes"), (seconds, "seconds"), (noise, "noise"), (error, "error")):
        if value is not None and not value > 0:
            raise ValueError(f"{name} must be above 0, not {value}")
    if not 0 <= checkpoint_every < math.inf:
        raise ValueError(f"checkpoint_every must be 0 or above, not {checkpoint_every}")
    if resume and checkpoint is None:
        raise ValueError("resume needs a checkpoint")
    if not 0 <= threads <= 4096:
        raise ValueError(f"threads must be between 0 and 4096, not {threads}")
    reported = _line if progress is True else (progress or None)
    preview = (lambda inner: callback(Picture._of(inner))) if callback else None
    words = ["mote.render", scene.path or "{...}"]
    words += [f"{name}={value}" for name, value in
              (("passes", passes), ("seconds", seconds), ("noise", noise), ("error", error), ("seed", seed)) if value is not None]
    inner, raised = _mote.render(scene._scene, passes, seconds, noise, error, seed, threads, path_text(checkpoint or ""),
                                 checkpoint_every, resume, auxiliary, denoise, oidn_package(denoise), words, reported, preview)
    picture = Picture._of(inner)
    if progress is True:
        print(file=sys.stderr)
    if raised is not None:
        raised.picture = picture
        raise raised
    return picture
