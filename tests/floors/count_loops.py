#!/usr/bin/env python3
"""There is one eye path and one gather: counts their calls, so that a second one is noticed.

Usage: count_loops.py ROOT
Each pattern below belongs to one idea, and ONLY lists where it may stand and how often. A new method uses
integrators/eye_path/eye_path.h and lights/virtual_lights/vpl_gather.h; where it truly needs a walk of its own, the
table says so, with the reason. Prints every offence as file: reason, and ends with 1 if there is one.
"""
import re
import sys
from pathlib import Path

FOLDERS = ["media", "lights", "compensation", "screenspace", "gathering", "integrators", "trade", "viewer", "apps", "python", "plugins"]

# idea: (pattern, {file: calls})
IDEAS = {
    "a walk from vertex to vertex": (r"\bwalk<\w+>\(", {
        "integrators/eye_path/eye_path.h": 1,            # the eye path
        "lights/virtual_lights/light_path.h": 1,         # the light path
        "integrators/bidirectional/subpath_walk.cpp": 1, # both at once, and the densities of every vertex
        "lights/direct_light/direct_light.h": 1,             # the other technique for direct light
        "compensation/residual_transport.cpp": 1,        # a step inside the bounding region
        "gathering/eye_bundles/eye_bundles.cpp": 1,      # one ray of a bundle, in a direction that all receivers share
        # Legs that cross media by marching, the last one through tracked media, and lights without a position.
        "integrators/single_scattering/single_scattering_eye.cpp": 3,
    }),
    "a channel sampled for a path": (r"\bsample_hero\(", {
        "integrators/eye_path/eye_path.h": 1,
        "lights/virtual_lights/light_path.h": 1,
        "compensation/residual_transport.cpp": 1,
        "integrators/single_scattering/single_scattering_eye.cpp": 1,
        "integrators/screen_space_compensation/hidden_light.cpp": 1,
        "integrators/bidirectional/strategies.h": 1,
        # A light path, and a connection to infinity: estimates that are multiplied must be independent.
        "integrators/bidirectional/strategies.cpp": 2,
    }),
    "scattering from a vertex of an eye path": (r"\bapply_scattering<\w+>\(", {
        "integrators/eye_path/eye_path.h": 1,
        "lights/direct_light/direct_light.h": 1,
    }),
    "Russian roulette of eye paths": (r"\bsurvives<\w+>\(", {
        "integrators/eye_path/eye_path.h": 1,
        "integrators/path_tracing/wavefront.cpp": 1,      # lanes of surfaces alone, in structures of arrays
    }),
    "the light of virtual lights at receivers": (r"(?<!bool )\bcontributions_of\(", {
        "lights/virtual_lights/vpl_gather.h": 1,
        "lights/selection/recording_selector.cpp": 2,    # one chosen VPL with and without the bound, for a pixel's record
        "lights/virtual_lights/lobe_contributions.cpp": 1,    # pairs of groups, each remembered by itself
    }),
    "a gather over pairs": (r"(?<!void )\bgather_pairs\(", {
        "lights/virtual_lights/vpl_gather.h": 1,         # a tile and all its lights, by rays
        "lights/shadow_maps/shadow_map_gather.h": 1,     # a light and all its receivers, by its map
        "lights/selection/matrix/matrix_rows.cpp": 1,           # rows of a matrix: all lights, each remembered by itself
    }),
}


def code_of(path):
    """The text without comments."""
    text = path.read_text(encoding="utf-8", errors="replace")
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def offences(root):
    sources = [p for folder in FOLDERS for p in sorted((root / folder).rglob("*")) if p.suffix in {".h", ".cpp"}]
    for idea, (pattern, allowed) in IDEAS.items():
        found = {}
        for path in sources:
            calls = len(re.findall(pattern, code_of(path)))
            if calls:
                found[path.relative_to(root).as_posix()] = calls
        for name in sorted(found.keys() | allowed.keys()):
            if found.get(name, 0) != allowed.get(name, 0):
                yield f"{name}: {idea}: {found.get(name, 0)} where {allowed.get(name, 0)} are known"


def main():
    lines = list(offences(Path(sys.argv[1]).resolve()))
    for line in lines:
        print(line)
    print(f"{len(IDEAS)} ideas, {len(lines)} offences")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
