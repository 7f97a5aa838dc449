"""Manual pages of everything that a scene can name, as the program declares it (docs/scene-format.md)."""
from __future__ import annotations

import textwrap
from functools import lru_cache
from typing import Any, Dict, List

from . import _mote
from ._errors import Error


class Manual(Dict[str, Any]):
    """The page of one type: {"category", "type", "summary", "example", "parameters"}. A parameter is {"name", "type",
    "default", "required", "values", "choices", "lower", "upper", "unit", "description"}. str(manual) is the page."""

    def __str__(self) -> str:
        lines = [f"{self['category']} '{self['type']}': {self['summary']}"]
        for p in self["parameters"]:
            facts = ", ".join(x for x in (p["type"], p["values"], p["default"] and f"default {p['default']}") if x)
            lines += [f"  {p['name']} ({facts})", *textwrap.wrap(p["description"], 110, initial_indent=" " * 6,
                                                                 subsequent_indent=" " * 6)]
        return "\n".join(lines)


@lru_cache(maxsize=1)
def manuals() -> List[Manual]:
    """All of them."""
    return [Manual(page) for page in _mote.manuals()]


def manual(type: str, category: str = "") -> Manual:
    """The manual page of a type: print(mote.manual("mote_vpl")). `category` ("bsdf", "integrator", ...) where several have
    a type of this name. Raises mote.Error."""
    pages = [m for m in manuals() if m["type"] == type and category in ("", m["category"])]
    if len(pages) == 1:
        return pages[0]
    if pages:
        raise Error(f"'{type}' is a type of several categories: " + ", ".join(m["category"] for m in pages))
    raise Error(f"there is no type '{type}'" + (f" of category '{category}'" if category else ""))
