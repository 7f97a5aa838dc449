"""Paths as the compiled module takes them."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Union


def path_text(path: Union[str, Path]) -> str:
    """Raises TypeError for what is no path, such as None, and ValueError for one that holds a NUL character."""
    text = os.fsdecode(os.fspath(path))
    if "\0" in text:
        raise ValueError(f"a path holds no NUL character: {text!r}")
    return text
