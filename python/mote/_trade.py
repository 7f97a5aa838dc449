"""Error against time, for several methods: `mote trade`, run as a process of its own."""
from __future__ import annotations

import html
import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

from ._errors import Error
from ._scene import Scene
from ._scene_dict import texts_of


def _command() -> str:
    """The program: $MOTE, beside this package (as wheels and build trees have it), or on the path."""
    here = Path(__file__).resolve().parent
    candidates = [os.environ.get("MOTE"), here / "mote", here.parent.parent / "bin" / "mote", shutil.which("mote")]
    for candidate in candidates:
        if candidate and os.access(candidate, os.X_OK) and Path(candidate).is_file():
            return str(candidate)
    raise FileNotFoundError("the command `mote` was found neither beside the package nor on the path; set MOTE to it")


def _scene_file(scene: Scene, output: Path) -> Path:
    """The file of a scene that was made of text or a dictionary, in the folder of the trade."""
    text = scene.xml()
    if re.search(r'type="array(mesh|grid)"', text):
        raise Error("mote.trade: a scene with arrays has no file for the command to read; give meshes and grids as files")
    output.mkdir(parents=True, exist_ok=True)
    file = output / "scene.xml"
    folder = html.escape(scene._folder, quote=True)
    file.write_text(re.sub(r"(<scene\b[^>]*>)", lambda m: f'{m[1]}\n  <path value="{folder}"/>', text, count=1), encoding="utf-8")
    return file


def trade(scene: Union[Scene, str, Path], methods: Optional[List[Mapping[str, Any]]] = None, *, output: Union[str, Path],
          reference: Union[str, Path, None] = None, resolve: Optional[float] = None,
          seconds: Optional[float] = None, passes: Optional[int] = None, seeds: Optional[int] = None, threads: int = 0,
          define: Optional[Mapping[str, Any]] = None, fresh: bool = False, quiet: bool = True,
          plugins: Sequence[Union[str, Path]] = (), **parameters: Any) -> Dict[str, Any]:
    """Lets methods take turns on a scene and measures the error of each over time against a reference.

    scene: a file, or a mote.Scene (with its changes and plugins) of anything but arrays. plugins: shared libraries to load
    types from, as `--plugin`. methods: [{"name": ..., "integrator": ..., "settings": {...}}, ...] as in a methods file (docs/howto/trade.md); none: what
    suits the scene. reference: an EXR file; none: one is rendered. resolve: the
    smallest error that it must judge, relative. seconds or passes: for every method and each of
    `seeds`. Writes output/trade.html and all that it is made of, and returns its summary.json: for every method its
    error, seconds, passes and bias. What is in the folder already is taken up where its inputs are these (fresh: not).
    Runs the command `mote trade` as a process, so that its clocks measure nothing else. Raises mote.Error.
    """
    output = Path(output)
    options = []
    if isinstance(scene, Scene):
        is_file = not scene._folder  # others have a folder for the names of files in them
        defines = scene._scene.defines if is_file else []
        plugins = [*scene._scene.plugins, *plugins]
        options = [word for name, text in defines for word in ("-D", f"{name}={text}")]
        scene = scene.path if is_file else _scene_file(scene, output)
    command = [_command(), "trade", str(scene), "-o", str(output), "--threads", str(threads), *options]
    for plugin in plugins:
        command += ["--plugin", os.path.abspath(plugin)]
    rules = {"--reference": reference, "--resolve": resolve, "--time": seconds, "--passes": passes, "--seeds": seeds}
    for name, value in rules.items():
        command += [name, str(value)] if value is not None else []
    for name, text in texts_of({**parameters, **(define or {})}):
        command += ["-D", f"{name}={text}"]
    command += ["--fresh"] * fresh + ["--quiet"] * quiet
    with tempfile.TemporaryDirectory(prefix="mote_") as folder:
        if methods is not None:
            file = Path(folder) / "methods.json"
            file.write_text(json.dumps({"methods": list(methods)}), encoding="utf-8")
            command += ["--methods", str(file)]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE if quiet else None, text=True, check=False)
    if done.returncode != 0:
        raise Error((done.stderr or f"mote trade ended with {done.returncode}").strip().removeprefix("mote: "))
    return json.loads((output / "summary.json").read_text(encoding="utf-8"))
