"""Installs the package into the build folder, moves it, and does with it what a consumer does.

Examples are built and run, layouts compared, the helper program looked for, flags of a project that adds mote to itself
looked through. --headers compiles each installed public header on its own as well (a minute of processor time).
"""
import argparse
import json
import os
import re
import resource
import shutil
import subprocess
import sys
from pathlib import Path

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--source", type=Path, required=True)
parser.add_argument("--build", type=Path, required=True)
parser.add_argument("--compiler", default="c++")
parser.add_argument("--headers", action="store_true")
arguments = parser.parse_args()
here = Path(__file__).resolve().parent
work = arguments.build / "package_test"
ccache = shutil.which("ccache")
launcher = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={ccache}"] if ccache else []
environment = {k: v for k, v in os.environ.items() if not k.startswith("MOTE_GRID") and k != "CXXFLAGS"}


def fail(what):
    sys.exit(f"package: {what}")


def run(*command, **options):
    done = subprocess.run([str(c) for c in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          env=environment, **options)
    if done.returncode != 0:
        fail(f"{' '.join(map(str, command))}\n{done.stdout[-6000:]}\nended with {done.returncode}")
    return done.stdout


def seconds():
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return children.ru_utime + children.ru_stime


def same_layouts(inside, outside):
    return inside == outside and inside.count("\n") > 30


def install():
    """The package in a folder that it was not installed to."""
    for folder in ("installed", "moved"):
        shutil.rmtree(work / folder, ignore_errors=True)
    run("cmake", "--install", arguments.build, "--prefix", work / "installed")
    (work / "installed").rename(work / "moved")
    for written in ("man/man1/mote-render.1", "bash-completion/completions/mote", "zsh/site-functions/_mote"):
        if not (work / "moved/share" / written).is_file():
            fail(f"share/{written} is not installed")
    return work / "moved"


def check_headers(include):
    """Fails unless every header of mote that an installed one includes is installed under `mote/`; returns the number of headers."""
    headers = sorted(include.rglob("*.h"))
    for header in headers:
        for line in re.findall(r'#include "([^"]+)"', header.read_text()):
            if not line.startswith("mote/") or not (include / line).exists():
                fail(f"{header} includes {line}")
        for private in re.findall(r"#include <((?:fmt|nlohmann|nanovdb|openvdb|OpenEXR|png|jpeglib|pugixml)[^>]*)>",
                                  header.read_text()):
            fail(f"{header} includes {private}, which is private")
    stray = [p.name for p in include.iterdir() if p.name != "mote"]
    if stray:
        fail(f"{stray} beside mote/ among the headers")
    return len(headers)


def public_headers():
    lines = (arguments.source / "cmake/public_headers.txt").read_text().splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def python_with_numpy():
    """For the plugin of Python integrators: this interpreter, or Debian's."""
    for python in (sys.executable, "/usr/bin/python3"):
        if Path(python).is_file() and subprocess.run([python, "-c", "import numpy"], capture_output=True).returncode == 0:
            return [f"-DPython3_EXECUTABLE={python}"]
    return []


def build_consumer(prefix):
    consumer, build = work / "consumer", work / "consumer_build"
    shutil.rmtree(build, ignore_errors=True)
    shutil.copytree(here / "consumer", consumer, dirs_exist_ok=True)
    text = "".join(f"#include <mote/{header}>\n" for header in public_headers())
    (consumer / "all_headers.cpp").write_text(text + "#include <mote/version.h>\n")
    run("cmake", "-S", consumer, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DMOTE_EXAMPLES={prefix}/share/doc/mote/examples", f"-DCMAKE_CXX_COMPILER={arguments.compiler}",
        "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
        *python_with_numpy(), *launcher)
    run("cmake", "--build", build)
    return build


def check_flags(commands, of):
    """No flag of mote's own compilation reaches others; what decides layouts does."""
    entries = [e["command"] for e in json.loads(commands.read_text()) if e["file"].endswith(of)]
    if not entries:
        fail(f"{commands} does not hold {of}")
    for command in entries:
        for flag in ("-march", "-Wshadow", "-Wpedantic", "-fno-math-errno", "FMT_SHARED", "nanovdb", "openvdb"):
            if flag in command:
                fail(f"{flag} reaches {of}: {command}")
        if re.search(rf"(-I|-isystem )\s*{re.escape(str(arguments.source))}(\s|$)", command):
            fail(f"mote's own folder is on the include path of {of}: {command}")
        if "-DGLM_FORCE_CTOR_INIT" not in command:
            fail(f"{of} would have other vectors than mote: {command}")


def check_examples(build, prefix):
    examples = build / "examples"
    room, box = work / "room.exr", arguments.source / "scenes/cornell_box.xml"
    run(prefix / "bin/mote", "render", arguments.source / "examples/ssbc/room.xml", "--passes", 4, "--auxiliary",
        "--quiet", "-o", room)
    for folder in sorted(p for p in (arguments.source / "examples").iterdir() if p.is_dir() and p.name != "notebook"):
        if folder.name.startswith("my_") or folder.name == "python_integrator":
            continue  # plugins: check_plugins()
        more = {"ssbc": [room, work / "compensated.exr"],
                "render_scene": [box, work / "box.exr", 1, "film.width=32", "film.height=24"],
                "render_from_c": [box, work / "box_of_c.exr", 1, "film.width", 32, "film.height", 24]}.get(folder.name, [])
        said = run(examples / folder.name / folder.name, *more).splitlines()[-1]
        print(f"{folder.name}: {said}")
        if folder.name == "ssbc":  # path tracing says that room.exr lacks 2.34 %
            added = float(re.search(r"adds ([\d.]+) %", said)[1])
            if not 1.2 < added < 2.34:
                fail(f"the compensation of room.exr adds {added} % of its light")


def check_pkg_config(prefix):
    """Examples by hand, with what the .pc files say; a component names no library that it does not use."""
    if not shutil.which("pkg-config"):
        print("no pkg-config: not tested")
        return
    environment["PKG_CONFIG_PATH"] = str(next(prefix.glob("lib*/**/pkgconfig")))
    flags = {name: run("pkg-config", "--static", "--cflags", "--libs", name).split()
             for name in ("mote", "mote-screenspace", "mote-c")}
    for unused in ("-lassimp", "-lpng", "-lpugixml", "-lOpenEXR"):
        if unused in flags["mote-screenspace"] or unused in flags["mote-c"]:
            fail(f"mote-screenspace.pc or mote-c.pc names {unused}")
        if not any(flag.startswith(unused) for flag in flags["mote"]):
            fail(f"mote.pc does not name {unused}")
    for name, package, compiler in (("epipolar_sampling.cpp", "mote-screenspace", [arguments.compiler, "-std=c++20"]),
                                    ("render_loop.cpp", "mote", [arguments.compiler, "-std=c++20"]),
                                    ("render_from_c.c", "mote-c", ["cc"])):
        source = arguments.source / "examples" / name.split(".")[0] / name
        program = work / name.split(".")[0]
        run(*compiler, source, "-o", program, *flags[package])
        if package == "mote-c":
            environment["LD_LIBRARY_PATH"] = str(next(prefix.rglob("libmote_c.so")).parent)
        words = [arguments.source / "scenes/cornell_box.xml", work / "by_hand.exr", 1, "film.width", 32] if package == "mote-c" else []
        print(f"{name} by hand: {run(program, *words).splitlines()[-1]}")
    del environment["PKG_CONFIG_PATH"], environment["LD_LIBRARY_PATH"]


def check_plugins(build, prefix):
    """The moved command renders with the plugins of the examples, which another compilation made."""
    uses = {"my_integrator": ["--integrator", "my_ambient_occlusion", "-D", "integrator.distance=0.3"],
            "my_selector": ["--integrator", "mote_vpl", "-D", "integrator.selection=by_intensity"],
            "python_integrator": ["--integrator", "python", "-D",
                                  f"integrator.file={arguments.source}/examples/python_integrator/ambient_occlusion.py"]}
    if not (build / "examples/python_integrator/python_integrator.so").is_file():
        print("no headers of Python, or no NumPy: python_integrator is not tested")
        del uses["python_integrator"]
    for name, words in uses.items():
        picture = work / f"{name}.exr"
        run(prefix / "bin/mote", "render", arguments.source / "scenes/cornell_box.xml", "--plugin",
            build / "examples" / name / f"{name}.so", *words, "-D", "film.width=32", "-D", "film.height=24", "--passes", 1,
            "--quiet", "-o", picture)
        print(f"{name}: {run(prefix / 'bin/mote', 'info', picture).splitlines()[1].strip()}")


def check_helper(build, prefix):
    found = Path(run(build / "where").strip()).resolve()
    if found != (prefix / "libexec/mote/mote_grid_reader").resolve():
        fail(f"the helper of the moved package was found in {found}")
    environment["MOTE_GRID_READER"] = "/somewhere/else"
    if run(build / "where").strip() != "/somewhere/else":
        fail("MOTE_GRID_READER does not come first")
    del environment["MOTE_GRID_READER"]


def check_guest():
    """The libraries in another project: configured, and one file of it compiled."""
    build = work / "guest"
    shutil.rmtree(build, ignore_errors=True)
    run("cmake", "-S", here / "guest", "-B", build, "-G", "Ninja", f"-DMOTE_SOURCE={arguments.source}",
        f"-DCMAKE_CXX_COMPILER={arguments.compiler}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra", *launcher)
    check_flags(build / "compile_commands.json", "guest.cpp")
    run("cmake", "--build", build, "--target", "mote_package_headers")
    entry = next(e for e in json.loads((build / "compile_commands.json").read_text()) if "guest.cpp" in e["file"])
    run("sh", "-c", entry["command"].replace(" -o ", " -fsyntax-only -o "), cwd=entry["directory"])


def check_each_header(include):
    for header in public_headers():
        run(arguments.compiler, "-std=c++20", "-DGLM_FORCE_CTOR_INIT", f"-I{include}", "-fsyntax-only", "-Wall",
            "-Wextra", "-Werror", "-x", "c++", "-", input=f"#include <mote/{header}>\n")


work.mkdir(exist_ok=True)
prefix = install()
count = check_headers(prefix / "include")
version = run(prefix / "bin/mote", "--version").strip()
build = build_consumer(prefix)
check_flags(build / "compile_commands.json", "all_headers.cpp")
layouts = run(build / "layouts")
inside = run(arguments.build / "bin/mote_package_layouts")
if not same_layouts(inside, layouts):
    fail(f"layouts differ:\n{inside}\n{layouts}")
if same_layouts(inside, layouts.replace("alignment 64", "alignment 32")):
    fail("a planted difference of layouts is not seen")
if version.split()[-1] != layouts.split()[1]:
    fail(f"the command says {version}, the headers {layouts.split()[1]}")
check_examples(build, prefix)
check_plugins(build, prefix)
check_pkg_config(prefix)
check_helper(build, prefix)
check_guest()
if arguments.headers:
    check_each_header(prefix / "include")
print(f"{count} headers installed; {seconds():.1f} processor seconds")
