#!/usr/bin/env python3
"""Writes core/materials/conductor_table.cpp: eta and k of every conductor that Mitsuba 3 has by name, as linear RGB.

    tools/conductor_table.py > core/materials/conductor_table.cpp && clang-format -i core/materials/conductor_table.cpp

The spectra are measurements (Palik, Handbook of Optical Constants; the SOPRA database) that come with Mitsuba, which
averages each over the sensitivities of linear sRGB and cuts what is negative at 0. Needs `mitsuba` (pip).
"""
from pathlib import Path

import mitsuba as mi

mi.set_variant("scalar_rgb")
mi.set_log_level(mi.LogLevel.Error)  # says which colours are cut


def index_of(name):
    values = mi.traverse(mi.load_dict({"type": "conductor", "material": name}))
    return [float(values[part][channel]) for part in ("eta.value", "k.value") for channel in range(3)]


def number(x):
    digits = f"{x:.6g}" if x > 1e-6 else "0"
    return digits + ("f" if "." in digits or "e" in digits else ".0f")


def main():
    folder = Path(mi.__file__).parent / "data" / "ior"
    names = sorted(path.name[: -len(".eta.spd")] for path in folder.glob("*.eta.spd"))
    index = {name: index_of(name) for name in names}
    print("// Indices of refraction eta + i k of conductors, as linear RGB. Written by tools/conductor_table.py from the"
          "\n// measured spectra (Palik, Handbook of Optical Constants; SOPRA) that Mitsuba 3.9 averages in the same way.")
    print('#include "core/materials/conductor_table.h"\n\nnamespace mote::core {\nnamespace {\n')
    print("constexpr NamedConductor rows[] = {\n{\"none\", false, {0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}},")
    for name, values in index.items():
        stem = name.removesuffix("_palik")
        if stem != name and index.get(stem) == values:
            continue  # a second name, said in the row of the first
        twice = "true" if index.get(name + "_palik") == values else "false"
        eta, k = (", ".join(number(x) for x in part) for part in (values[:3], values[3:]))
        print(f'{{"{name}", {twice}, {{{eta}}}, {{{k}}}}},')
    print("};\n\n}  // namespace\n\nstd::span<const NamedConductor> conductor_table() { return rows; }\n"
          "\n}  // namespace mote::core")


main()
