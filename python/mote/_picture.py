"""Pictures: layers by name as NumPy arrays."""
from __future__ import annotations

import base64
import html
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple, Union

import numpy as np

from . import _errors, _mote  # noqa: F401  (errors are registered first)
from ._paths import path_text


def _image(png: bytes, width: int) -> str:
    return f'<img width="{width}" src="data:image/png;base64,{base64.b64encode(png).decode()}">'


class Shown:
    """What Picture.show() returns: a PNG and its caption."""

    def __init__(self, png: bytes, caption: str) -> None:
        self.png, self.caption = png, caption

    def _repr_png_(self) -> bytes:
        return self.png

    def _repr_html_(self) -> str:
        return f"<figure>{_image(self.png, 480)}<figcaption>{html.escape(self.caption)}</figcaption></figure>"


class Picture(Mapping):
    """Layers by name: picture["beauty"], picture["direct"], ...; list(picture) are their names.

    A layer is a float32 array (height, width, channels), or (height, width) where it has one channel, row by row from
    the top. It is read-only: change a copy, and assign it. Light is radiance in W/(m^2 sr), R, G, B; positions P and distances Depth are in metres, normals N and Ns
    unit vectors in world space; "Variance" is that of the mean of the beauty, "Variance.NAME" that of another layer.
    Where a render was interrupted in its first pass, "alpha" is 1 for the pixels that are finished.

    Picture({"beauty": array, ...}, {"worldToCamera": ...}) makes one of arrays of one's own.
    """

    def __init__(self, layers: Optional[Mapping] = None, metadata: Optional[Mapping] = None) -> None:
        self._picture = _mote.Picture()
        self._cache: Dict[str, np.ndarray] = {}
        for name, values in (layers or {}).items():
            self[name] = values
        for name, text in (metadata or {}).items():
            self._picture.set_metadata(name, str(text))

    @classmethod
    def _of(cls, inner: _mote.Picture) -> Picture:
        picture = cls()
        picture._picture = inner
        return picture

    @classmethod
    def load(cls, path: Union[str, Path]) -> Picture:
        """Reads an OpenEXR file; of one that mote wrote also passes, noise and the order of the layers. Raises mote.Error."""
        return cls._of(_mote.Picture.read(path_text(path)))

    def save(self, path: Union[str, Path], half: bool = False) -> None:
        """Writes all layers to an OpenEXR file, as float32 or (half) float16, or the beauty to a PNG, as png() makes it. Raises
        mote.Error, also for a name that ends neither in .exr nor in .png."""
        text = path_text(path)
        if not text.lower().endswith(".png"):
            self._picture.save(text, half)
            return
        try:
            Path(text).write_bytes(self.png())
        except OSError as problem:
            raise _errors.Error(f"{text}: cannot be written: {problem.strerror}") from problem

    def copy(self) -> Picture:
        return Picture._of(self._picture.copy())

    # Layers, as a mapping.
    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._cache:
            if name not in self:
                try:
                    self._picture.read_layer(name)
                except _errors.Error as error:
                    raise KeyError(str(error)) from None
            self._cache[name] = self._picture.read_layer(name)
            self._cache[name].setflags(write=False)
        return self._cache[name]

    def __setitem__(self, name: str, values: Any) -> None:
        """Adds or replaces a layer of 1 or 3 channels. Raises mote.Error for another size than the picture's."""
        array = np.ascontiguousarray(values, dtype=np.float32)
        self._picture.write_layer(name, array[:, :, np.newaxis] if array.ndim == 2 else array)
        self._cache.pop(name, None)

    def __iter__(self) -> Iterator[str]:
        return iter(self.layers)

    def __len__(self) -> int:
        return len(self.layers)

    def __contains__(self, name: object) -> bool:
        return name in self.layers

    @property
    def layers(self) -> List[str]:
        """Names of the layers, in the order of the file."""
        return [name for name, _ in self._picture.layers()]

    @property
    def channels(self) -> Dict[str, List[str]]:
        """Of every layer the names of its channels: {"beauty": ["R", "G", "B"], "Depth": ["Z"], ...}."""
        return dict(self._picture.layers())

    # What is known of it.
    @property
    def width(self) -> int:
        return self._picture.width

    @property
    def height(self) -> int:
        return self._picture.height

    @property
    def passes(self) -> int:
        """How many were added up; 0 where only a part of the first was, or it was not rendered."""
        return self._picture.passes

    @property
    def noise(self) -> float:
        """The relative error that the passes are expected to have left (docs/testing.md); infinity: not known."""
        return self._picture.noise

    @property
    def error_interval(self) -> Optional[Tuple[float, float]]:
        """Ends of the interval of 95 % confidence of the relative RMSE, bias included; None: not known."""
        text = self.metadata.get("errorInterval", "").split()
        return (float(text[0]), float(text[1])) if len(text) == 2 else None

    @property
    def interrupted(self) -> bool:
        return self._picture.interrupted

    @property
    def metadata(self) -> Dict[str, str]:
        """A copy of what the file says about itself: seed, passes, integrator, sceneHash, worldToCamera, ..."""
        return self._picture.metadata

    @property
    def statistics(self) -> Dict[str, Any]:
        """What `mote render --stats` writes: seconds, rays, plan, ...; empty for a picture that was not rendered."""
        text = self._picture.statistics
        return json.loads(text) if text else {}

    @property
    def warnings(self) -> List[str]:
        return self._picture.warnings

    def png(self, layer: str = "beauty", exposure: Optional[float] = None) -> bytes:
        """A PNG file of a layer. `exposure` in stops; none: it adapts to the picture."""
        return self._picture.png(layer, exposure)

    def srgb(self, layer: str = "beauty", exposure: Optional[float] = None) -> np.ndarray:
        """The pixels of png(): 8-bit sRGB (height, width, 3), as matplotlib's imshow takes them."""
        return self._picture.srgb(layer, exposure)

    def _ipython_key_completions_(self) -> List[str]:
        return self.layers

    def show(self, layer: str = "beauty", against: Optional[Picture] = None, exposure: Optional[float] = None) -> Shown:
        """A layer for a notebook to display. against: the signed difference to the same layer of another picture: red where
        this one is brighter, blue where it is darker, white where they agree; full colour is a difference of
        2^-exposure (none: four times the mean absolute difference)."""
        if against is None:
            return Shown(self.png(layer, exposure), f"{layer}")
        difference = np.asarray(self[layer], np.float64).mean(axis=2) - np.asarray(against[layer], np.float64).mean(axis=2)
        full = 4.0 * float(np.abs(difference).mean()) or 1.0 if exposure is None else 2.0 ** -exposure
        strength = np.clip(np.abs(difference) / full, 0.0, 1.0)[:, :, np.newaxis]
        end = np.where(difference[:, :, np.newaxis] > 0.0, (0.5, 0.0, 0.0), (0.0, 0.03, 0.5))
        colours = Picture({"beauty": 1.0 + strength * (end - 1.0)})
        return Shown(colours.png(exposure=0.0), f"{layer}, difference: red {full:+.3g}, white 0, blue {-full:+.3g} W/(m^2 sr)")

    def _repr_png_(self) -> Optional[bytes]:
        return self.png() if "beauty" in self else None

    def _repr_html_(self) -> Optional[str]:
        """The picture, and every layer of colours as a small one."""
        if "beauty" not in self:
            return None
        small = [(name, self.png(name)) for name, channels in self.channels.items()
                 if channels == ["R", "G", "B"] and name != "beauty" and not name.startswith("Variance")]
        figures = "".join(f'<figure style="display:inline-block;margin:4px">{_image(png, 160)}'
                          f'<figcaption>{html.escape(name)}</figcaption></figure>' for name, png in small)
        return f"<div>{_image(self.png(), self.width)}<br>{figures}<br>{html.escape(repr(self))}</div>"

    def __repr__(self) -> str:
        noise = f", noise {100 * self.noise:.2g} %" if math.isfinite(self.noise) else ""
        return (f"<mote.Picture {self.width} x {self.height}, {self.passes} passes{noise}"
                f"{', interrupted' if self.interrupted else ''}: {', '.join(self.layers)}>")
