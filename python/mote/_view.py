"""The viewer in a notebook: mote.view(scene), a widget (anywidget) that shows the page of `mote view`."""
from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any, Mapping, Optional, Union

from . import _mote
from ._picture import Picture
from ._scene import Scene, load


def _script() -> str:
    """The page's modules as one, which sends its messages through the widget."""
    return _mote.page_script() + """
export default {
  render({ model, el }) {
    const root = document.createElement("div");
    root.style.height = `${model.get("height")}px`;
    el.append(root);
    const transport = { send: (message) => model.send(message) };
    model.on("msg:custom", (content, buffers) => {
      if (content.text !== undefined) return transport.receive(content.text);
      const data = buffers[0];
      transport.receive(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength));
    });
    start(root, transport);
  },
};
"""


def _widget_class() -> type:
    try:
        import anywidget
        import traitlets
    except ImportError as problem:
        raise ImportError("mote.view() needs anywidget (pip install anywidget); `mote view` needs nothing but a browser") from problem

    class View(anywidget.AnyWidget):
        """A scene that is rendered while the widget's knobs are turned, or pictures. close() ends the render."""
        _esm = _script()
        _css = _mote.page_file("viewer.css")
        height = traitlets.Int(640).tag(sync=True)

        def __init__(self, view: _mote.View, **more: Any) -> None:
            super().__init__(**more)
            self._view = view
            self.on_msg(lambda _, content, __: self._view.receive(json.dumps(content)))
            self._thread = threading.Thread(target=self._carry, daemon=True)
            self._thread.start()

        def _carry(self) -> None:
            while True:
                message = self._view.next_message(0.5)
                if message is None:
                    if self._view.closed:
                        return
                elif isinstance(message, str):
                    self.send({"text": message})
                else:
                    self.send({}, buffers=[message])

        def picture(self, name: str = "A") -> Optional[Picture]:
            """The last picture of this name; None where there is none yet."""
            inner = self._view.picture(name)
            return None if inner is None else Picture._of(inner)

        def close(self) -> None:
            self._view.close()
            super().close()

    return View


def view(scene: Union[Scene, str, Path, Picture, Mapping[str, Picture]], *, integrator: str = "",
         define: Optional[Mapping[str, Any]] = None, passes: int = 0, seed: int = 0, threads: int = 0,
         reference: Optional[Picture] = None, height: int = 640) -> Any:
    """A widget with the page of `mote view`: layers, difference, knobs, camera, the light of a pixel (docs/viewer.md).

    scene: one, or the name of its file; or a Picture, or several by their names, {"A": ..., "B": ...}. integrator, define:
    the first values of the knobs, as for mote.load(). passes: 0 means the scene's sample_count. reference: a Picture that
    is taken for right; the widget draws error against time. height: in pixels. Raises ImportError without anywidget.
    """
    inner = _mote.View()
    if reference is not None:
        inner.set_reference("reference", reference._picture)
    if isinstance(scene, Picture):
        scene = {"picture": scene}
    if isinstance(scene, Mapping):
        for name, picture in scene.items():
            inner.show_picture(name, picture._picture)
    else:
        if not isinstance(scene, Scene):
            scene = load(scene)
        defines = [(name.replace("__", "."), str(value)) for name, value in (define or {}).items()]
        inner.show_scene(scene._scene, integrator, defines, passes, seed, threads)
    return _widget_class()(inner, height=height)
