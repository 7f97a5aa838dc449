#!/usr/bin/env python3
"""Proves that tools/count_house.py counts: plants one of each kind, and what only resembles it, in an empty folder."""
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import count_house  # noqa: E402

PAGE = """## Shapes
### `cube`
| `a` | float | 1 | a |
## Integrators
### `one`
| parameter | type |
|---|---|
| `paths` | integer | 1 | paths |
| `nested` | selection | all | a nested object |
### `two`
| `x` | integer | 1 | x |
## Selection
### `all`
| `y` | integer | 1 | y |
"""
ESTIMATOR = "class A final : public Estimator {\n"
CUT = "std::pop_heap(cut_.begin(), cut_.end());\n"
BOX = "const float x = max_of(max_of(x0, -x1), 0.0f);\n"
SHADOW_RAY = "lanes.origin_x[i] = x;\n"
SAMPLER = "SurfaceSamples sample_surfaces(const Scene& scene) {}\n"

# (file, content, what of count() it raises to how much)
CASES = [
    ("core/a.h", "1\n2\n3\n", {"lines": 3}),
    ("trade/a.c", "1\n", {"lines": 1}),
    ("tests/a.h", "1\n2\n", {}),
    ("core/a.txt", "1\n2\n", {}),
    ("docs/scene-format.md", PAGE, {"parameters": 1}),
    ("media/a.h", 'x = p.get_int("a", 1);\n', {"lines": 1, "apart": 1}),
    ("media/a.h", 'x = p->require_float("a");\n', {"lines": 1, "apart": 1}),
    ("media/a.h", '// p.get_int("a", 1)\n', {"lines": 1}),
    ("media/a.h", "Vec3 get_int(int);\n", {"lines": 1}),
    ("core/objects/a.h", 'x = p.get_int("a", 1);\n', {"lines": 1}),
    ("lights/a.h", '{"paths", "integer", "256", "light paths"},\n', {"lines": 1, "apart": 1}),
    ("lights/a.h", '{"selection", "selection", "all",\n"VPLs that light each receiver"},\n', {"lines": 2, "apart": 1}),
    ("lights/a.h", '{"paths", "integer", std::to_string(256), "paths"},\n', {"lines": 1, "apart": 1}),
    ("lights/a.h", 'names = {"boolean", "integer", "float", "string",\n"rgb"};\n', {"lines": 2}),
    ("lights/a.h", 'check_keys(pointer, {"name", "integrator", "settings"});\n', {"lines": 1}),
    ("lights/a.h", '{&Settings::paths, "paths", 256, "light paths"},\n', {"lines": 1}),
    ("lights/a.h", "/// Of all lights.\nint x;\n", {"lines": 2, "openings": 1}),
    ("lights/a.h", "int x;  ///< whether\nint y;  // Whether it is there\n", {"lines": 2, "openings": 1}),
    ("lights/a.h", "/// The sum\n/// Of all lights.\nint x;\n", {"lines": 3}),
    ("lights/a.h", "// Officers, none\n\n// Whatever it is\n", {"lines": 3}),
    ("lights/a.h", 'f("// Of strings");\n', {"lines": 1}),
    ("lights/a.h", "// The same again\n", {"lines": 1, "openings": 1}),
    ("tests/a.h", "// What is tested\n", {"openings_elsewhere": 1}),
    ("lights/a.h", "int most_lights;  // looks at all\n", {"lines": 1, "words": 1}),
    ("tests/a.py", "drawn = asked\n", {"words": 1}),
    ("lights/a.h", "int max_lights;  // gathers all; unknown\n", {"lines": 1}),
    ("lights/a.h", CUT, {"lines": 1}),
    ("lights/a.h", CUT + CUT, {"lines": 2, "twins": 1}),
    ("lights/a.h", BOX + BOX, {"lines": 2, "twins": 1}),
    ("lights/a.h", SHADOW_RAY * 3, {"lines": 3, "twins": 2}),
    ("lights/a.h", SAMPLER * 2, {"lines": 2, "twins": 1}),
    ("lights/a.h", "struct alignas(64) LaneValues {\nstruct alignas(64) LaneFloats {\nusing Lanes = std::array<float, 8>;\n",
     {"lines": 3, "twins": 1}),
    ("lights/a.h", "class LightTree {\nclass LightTree;\n", {"lines": 2}),
    ("lights/a.h", "class LightTree {\nclass LightTree {\n", {"lines": 2, "twins": 1}),
    ("lights/a.h", "struct SurfacePoints {\nclass SurfacePoints {\n", {"lines": 2, "twins": 1}),
    ("lights/a.h", "class TracedVisibility {\nclass TracedVisibility final : public X {\n", {"lines": 2, "twins": 1}),
    ("integrators/a.cpp", ESTIMATOR + "1\n2\n", {"lines": 3, "estimator": 3}),
    ("integrators/a.cpp", "class A : public X {\n", {"lines": 1}),
    ("lights/a.cpp", ESTIMATOR, {"lines": 1}),
    ("integrators/a.h", "std::optional<EyePath<Media>> path;\n", {"lines": 1, "packets of eye paths": 1}),
    ("integrators/a.h", "for (int x = x0; x < x1; ++x)\n// for (int x = x0; x < x1; ++x)\n", {"lines": 2, "image loops": 1}),
    ("lights/selection/a.h", "enum class SelectedBy : std::uint8_t { all };\nenum class VplSelection {};\n",
     {"lines": 2, "enums of selection": 2}),
    ("lights/a.h", "enum class ReceiverKind {};\n", {"lines": 1}),
    ("core/metrics/a.h", "x\n", {"lines": 1, "errors": 1}),
    ("experiments/a.py", "e = np.mean((x - r) ** 2)\n", {"errors": 1}),
    ("experiments/a.py", "e = (found - exact.mean(axis=0)) ** 2 - v\n", {"errors": 1}),
    ("experiments/a.py", "e = ((p - a) * (p - b)).mean()\n", {"errors": 1}),
    ("experiments/a.py", "e = ((found[0] - exact[i]) * (found[1] - exact[j])).mean()\n", {"errors": 1}),
    ("experiments/a.py", "e = np.mean((d / (r + r.mean())) ** 2)\n", {"errors": 1}),
    ("experiments/a.py", "e = np.mean(luminance(difference) ** 2)\n", {"errors": 1}),
    ("tests/a.py", "e = d**2 / (r**2 + 0.01)\n", {"errors": 1}),
    ("tests/a.py", "w = 1 / (r2 + (np.median(r) / 10) ** 2)\nw = 1.0 / (r2 + 0.01 * np.median(r2))\n", {"errors": 1}),
    ("experiments/a.cpp", "sum += d * d / (r * r + 0.01);\n", {"errors": 1}),
    ("experiments/a.cpp", "near = r * r / (r * r + 25.0);\n", {}),
    ("experiments/a.cpp", "sum += d * e / (r * r + 0.01);  // d * d / (r * r + 1)\n", {}),
    ("tests/a.py", "e = mote.compare(x, r)['error']  # (x - r) ** 2\n", {}),
    ("tests/a.py", "x = (eta - 1)**2 + k**2\n", {}),
]


def count(files):
    """Counts that differ from 0 in a folder of these files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files:
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content)
        house = count_house.House(Path(folder))
        numbers = {"lines": sum(house.lines_by_folder().values()), "apart": house.getters() + house.rows(),
                   "parameters": max((own for own, _ in house.parameters().values()), default=0), "circles": house.circles(),
                   "openings": house.openings(True), "openings_elsewhere": house.openings(False),
                   "estimator": max(house.estimators().values(), default=0), **house.structure(),
                   "words": house.words(), "twins": sum(house.twins().values()), "errors": house.error_measures()}
    return {name: number for name, number in numbers.items() if number}


def main():
    circle = [("lights/a/x.h", '#include "lights/b/y.h"\n'), ("lights/b/y.h", '#include "lights/a/x.h"\n')]
    cases = [([(name, content)], expected) for name, content, expected in CASES] + [(circle, {"lines": 2, "circles": 1})]
    failures = 0
    for files, expected in cases:
        found = count(files)
        if found != expected:
            failures += 1
            print(f"{files}: expected {expected}, got {found}")
    print(f"{len(cases)} cases, {failures} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
