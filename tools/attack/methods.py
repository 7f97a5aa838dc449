"""Settings of the integrators in the attack: methods.toml, and defaults for types that it does not name."""
import tomllib
from dataclasses import dataclass
from pathlib import Path

REFERENCE = "volpath"


@dataclass
class Method:
    xml: str = ""
    passes: int = 8
    cells: tuple = ()
    bias: float = 0.0
    takes_depth: bool = True
    sees_media: bool = True
    shrinks: bool = False
    reason: str = ""


def read_methods(names):
    """By type of integrator."""
    rows = tomllib.loads(Path(__file__).with_name("methods.toml").read_text(encoding="utf-8"))
    for name in rows:
        if name not in names:
            raise SystemExit(f"methods.toml has settings of '{name}', which is not registered")
    return {name: method_of(rows.get(name, {})) for name in names}


def method_of(row):
    return Method(row.get("xml", ""), row.get("passes", 8), tuple(row.get("cells", ())), row.get("bias", 0.0),
                  row.get("depth", True), row.get("media", True), row.get("shrinks", False), row.get("reason", ""))
