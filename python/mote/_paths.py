"""Paths as the compiled module takes them."""
from __future__ import annotations

import importlib.util
import os
from pathlib import Path
from typing import Union


def path_text(path: Union[str, Path]) -> str:
    """Raises TypeError for what is no path, such as None, and ValueError for one that holds a NUL character."""
    text = os.fsdecode(os.fspath(path))
    if "\0" in text:
        raise ValueError(f"a path holds no NUL character: {text!r}")
    return text


def oidn_package(method: str) -> str:
    """Folder of the package pyoidn in this interpreter's environment; "" where it has none, or none is needed."""
    spec = importlib.util.find_spec("pyoidn") if method == "oidn" else None
    return next(iter(spec.submodule_search_locations or ()), "") if spec else ""
