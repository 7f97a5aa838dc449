"""One scene across every border: the command, C++, C, Python, Mitsuba 3 and two machines give the same bits.

The C++ and the C program are the examples, as the test of the package has built them with the installed package. Parts
that are not installed (the Python module, Mitsuba) are LEFT OUT by name. Pictures are read by a reader of OpenEXR that
shares no line with mote.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--mote", type=Path, required=True)
parser.add_argument("--source", type=Path, required=True)
parser.add_argument("--examples", type=Path, required=True)
parser.add_argument("--module", type=Path, help="the folder of the Python module")
parser.add_argument("--python", help="the Python that it was built for (a path that is absolute)")
arguments = parser.parse_args()
sys.path.insert(0, str(arguments.source / "plugins/blender/mote_render"))
import numpy as np  # noqa: E402
from exr import read_exr  # noqa: E402

PASSES = 2
SIZE = {"resx": 40, "resy": 40}
METHODS = ({"integrator": "mote_vpl"}, {"integrator": "volpath"})
of_python = """
import sys, mote
scene, out, passes = sys.argv[1:4]
mote.render(mote.load(scene, **dict(d.split("=") for d in sys.argv[4:])), passes=int(passes)).save(out)
"""
of_mitsuba = """
import sys, numpy, mitsuba as mi
mi.set_variant("scalar_rgb")
mi.set_log_level(mi.LogLevel.Error)
import mote.mitsuba
scene, out, passes = sys.argv[1:4]
parameters = dict(d.split("=") for d in sys.argv[4:])
if parameters["integrator"] == "volpath":
    parameters["integrator"] = "mote_volpath"
loaded = mi.load_file(scene, **parameters)
mi.render(loaded, spp=int(passes))
planes = {}
for layer, bitmap in loaded.integrator().layers.items():
    values = numpy.array(bitmap, copy=False).reshape(bitmap.height(), bitmap.width(), -1)
    for i, field in enumerate(bitmap.struct_()):
        planes[field.name.split(".")[-1] if not layer else layer + "." + field.name.split(".")[-1]] = values[:, :, i].copy()
numpy.savez(out + ".npz", **planes)
"""


for name, value in vars(arguments).items():
    if isinstance(value, Path):
        setattr(arguments, name, value.absolute())  # commands run in folders of their own


def run(*command, folder, **environment):
    done = subprocess.run([str(c) for c in command], cwd=folder, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, env={**os.environ, **environment})
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout[-3000:]}\nended with {done.returncode}")


def has(python, module):
    return subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0


def command(scene, out, defines, passes, folder, *more):
    words = [word for define in defines for word in ("-D", define)]
    run(arguments.mote, "render", scene, "-o", out, "--quiet", *words, *more, *(["--passes", passes] if passes else []),
        folder=folder)


def two_machines(scene, out, defines, folder):
    for first in range(PASSES):
        command(scene, f"{first}.film", defines, None, folder, "--pass-range", f"{first}:{first + 1}")
    words = [word for define in defines for word in ("-D", define)]
    run(arguments.mote, "merge", *[f"{first}.film" for first in range(PASSES)], "-o", out, "--quiet", folder=folder)


def ways():
    """{name: function of (scene, out, defines, folder)}; and what is left out, with the reason."""
    examples, left_out = arguments.examples, []
    of = {"C++": lambda s, o, d, f: run(examples / "render_scene/render_scene", s, o, PASSES, *d, folder=f),
          "C": lambda s, o, d, f: run(examples / "render_from_c/render_from_c", s, o, PASSES,
                                      *[w for define in d for w in define.split("=")], folder=f),
          "two machines": two_machines}
    if arguments.module:
        of["Python"] = lambda s, o, d, f: run(arguments.python, "-B", "-c", of_python, s, o, PASSES, *d, folder=f,
                                              PYTHONPATH=str(arguments.module))
    else:
        left_out.append("LEFT OUT: Python (tools/python_packages.sh fetches what the module is built with)")
    if has("python3", "mitsuba"):
        of["Mitsuba"] = lambda s, o, d, f: run("python3", "-B", "-c", of_mitsuba, s, o, PASSES, *d, folder=f,
                                               PYTHONPATH=str(arguments.source / "python"), MOTE_COMMAND=str(arguments.mote))
    else:
        left_out.append("LEFT OUT: Mitsuba (no Python package 'mitsuba')")
    return of, left_out


def picture_of(folder):
    """Image that the interface under test wrote, then removed: an EXR file, or planes by their names in such a file."""
    exr, planes = folder / "picture.exr", folder / "picture.exr.npz"
    if planes.exists():
        with np.load(planes) as file:
            channels = {name: file[name] for name in file}
        planes.unlink()
    else:
        channels = read_exr(exr)
        exr.unlink()
    return channels


def same_bits(ours, theirs):
    return set(ours) == set(theirs) and len(ours) > 4 and all(
        ours[name].shape == theirs[name].shape and ours[name].tobytes() == theirs[name].tobytes() for name in ours)


def scene_for_all(folder):
    """The Cornell box with a sampler that Mitsuba has."""
    scenes = arguments.source / "scenes"
    text = (scenes / "cornell_box.xml").read_text().replace('"sobol"', '"independent"').replace(
        '"meshes/', f'"{scenes}/meshes/')
    (folder / "box.xml").write_text(text)
    return folder / "box.xml"


of, left_out = ways()
with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    scene = scene_for_all(folder)
    for method in METHODS:
        defines = [f"{key}={value}" for key, value in {**SIZE, **method}.items()]
        command(scene, "command.exr", defines, PASSES, folder)
        command(scene, "other.exr", defines, PASSES + 1, folder)
        expected = read_exr(folder / "command.exr")
        if expected["R"].shape != (SIZE["resy"], SIZE["resx"]) or not expected["R"].max() > 0.0:
            sys.exit("the command's picture is not the one that was requested")
        if same_bits(read_exr(folder / "other.exr"), expected):
            sys.exit("another picture has the same bits: the comparison sees nothing")
        for border, render in of.items():
            render(scene, "picture.exr", defines, folder)
            if not same_bits(picture_of(folder), expected):
                sys.exit(f"{method['integrator']}: {border} has other bits than the command")
print("\n".join(left_out + [f"command = {' = '.join(sorted(of))}, to the bit, by {' and '.join(m['integrator'] for m in METHODS)}"]))
