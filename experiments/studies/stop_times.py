#!/usr/bin/python3
"""How long does Ctrl-C take, in every integrator and every phase?

Renders large pictures and sends SIGINT after a while: in the first pass of every integrator, while a large mesh is loaded
and its tree is built, and while the picture is written. Prints one line each: seconds from the signal to the last
line of the program's own work (`stop`) and to its end (`end`), which includes writing what there is. The difference is
the disk's. `cpu`: processor seconds of all threads between the signal and the end, which a busy machine leaves as
they are. Then the same for --time. Exit code 0: every `stop` is within two seconds (--quick: ten, for busy machines).

    experiments/studies/stop_times.py [--quick] [--size N] [--bin FOLDER]
"""
import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SCENE = """<scene version="3.0.0">
<sensor type="perspective"><float name="fov" value="40"/><film type="hdrfilm"><integer name="width" value="{size}"/>
<integer name="height" value="{size}"/></film><transform name="to_world">
<lookat origin="0, 0, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
<shape type="sphere"><float name="radius" value="0.5"/><bsdf type="diffuse"/></shape>
<shape type="rectangle"><transform name="to_world"><scale value="2"/><translate z="-1"/></transform>
<bsdf type="diffuse"/></shape>{lights}{medium}{mesh}</scene>"""
FOG = """<shape type="cube"><bsdf type="null"/><medium type="homogeneous" name="interior">
<rgb name="sigma_t" value="0.5"/><rgb name="albedo" value="0.9"/></medium></shape>"""


def point_lights(count):
    return "".join(f"""<emitter type="point"><point name="position" x="{-0.9 + 1.8 * i / max(1, count - 1)}" y="0.9"
        z="{0.8 - 0.1 * (i % 7)}"/></emitter>""" for i in range(count))


def write_mesh(path, n):
    """A wavy sheet of 2 n^2 triangles."""
    with open(path, "w", encoding="ascii") as f:
        for y in range(n + 1):
            for x in range(n + 1):
                f.write(f"v {2 * x / n - 1:.6f} {2 * y / n - 1:.6f} {-0.9 + 0.01 * ((x * 7 + y * 13) % 10):.3f}\n")
        for y in range(n):
            for x in range(n):
                a = y * (n + 1) + x + 1
                f.write(f"f {a} {a + 1} {a + n + 2}\nf {a} {a + n + 2} {a + n + 1}\n")


def cases(size, quick):
    """By name: integrator, settings, lights, medium, mesh, seconds until the signal."""
    wait = 3.0 if quick else 8.0
    many = 50 if quick else 1000
    big = {"integrator.paths": 20000}
    surface = [("path", {}, 1), ("mote_layers", {}, 1), ("mote_vpl", big, 1), ("mote_vsl", big, 1),
               ("mote_photon_map", {"integrator.photon_paths": 10**7}, 1)]
    media = [("volpath", {}, 1), ("mote_layers", {}, 1), ("mote_vpl", big, 1), ("mote_photon_map", {"integrator.photon_paths": 10**7}, 1),
             ("mote_single_scattering", {}, many), ("mote_epipolar", {}, many),
             ("mote_vpl", {**big, "integrator.visibility": "shadow_map", "integrator.visibility.size": 64}, 1),
             ("mote_single_scattering", {"integrator.visibility": "shadow_map", "integrator.visibility.light_size": 256}, many)]
    for kind, medium, list_of in (("surfaces", "", surface), ("fog", FOG, media)):
        for integrator, settings, lights in list_of:
            more = "".join(f", {k.split('.', 1)[1]}={v}" for k, v in settings.items())
            yield f"{integrator}, {kind}{more}", integrator, settings, lights, medium, "", wait
    yield "loading a mesh", "path", {}, 1, "", "mesh", 0.3 if quick else 1.5
    yield "many lights, path", "path", {}, many, "", "", wait


def processor_seconds(process):
    try:
        fields = Path(f"/proc/{process.pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run(mote, folder, scene, integrator, settings, seconds, limit):
    command = [mote, "render", scene, "-o", folder / "o.exr", "--integrator", integrator, "-t", "2"]
    for key, value in settings.items():
        command += ["-D", f"{key}={value}"]
    if limit:
        command += ["--time", str(limit)]
    process = subprocess.Popen([str(c) for c in command], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    start = time.monotonic()
    if limit:
        start += limit
    else:
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            pass
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
    # The program writes its outputs as soon as its work has stopped: what lies before is `stop`.
    written = used = before = None
    while process.poll() is None:
        if before is None and time.monotonic() >= start:
            before = processor_seconds(process)
        used = processor_seconds(process) or used
        if written is None and any(f.name.endswith(".part") for f in folder.iterdir()):
            written = time.monotonic() - start
        time.sleep(0.01)
    end = time.monotonic() - start
    error = process.stderr.read().strip().splitlines()
    cpu = max(0.0, (used or 0.0) - (before or 0.0))
    return min(written or end, end), end, cpu, process.returncode, error[-1] if error else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--size", type=int)
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin")
    arguments = parser.parse_args()
    mote = arguments.bin / "mote"
    if not os.access(mote, os.X_OK):
        print(f"no {mote}", file=sys.stderr)
        return 2
    size = arguments.size or (400 if arguments.quick else 3000)
    bound = 10.0 if arguments.quick else 2.0
    late = 0
    print(f"{'stop':>6} {'end':>6} {'cpu':>6} code  {size} x {size} pixels; load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_mesh(folder / "mesh.obj", 100 if arguments.quick else 1500)
        for title, integrator, settings, lights, medium, mesh, wait in cases(size, arguments.quick):
            scene = folder / "scene.xml"
            shape = '<shape type="obj"><string name="filename" value="mesh.obj"/></shape>' if mesh else ""
            scene.write_text(SCENE.format(size=size, lights=point_lights(lights), medium=medium, mesh=shape), encoding="utf-8")
            for limit in (None, 1.0 if arguments.quick else 3.0):
                stop, end, cpu, code, line = run(mote, folder, scene, integrator, settings, wait, limit)
                late += stop > bound
                print(f"{stop:6.2f} {end:6.2f} {cpu:6.2f} {code:4}  {title}{', --time' if limit else ''}{'  LATE' if stop > bound else ''}"
                      f"  [{line[:70]}]", flush=True)
    return 1 if late else 0


if __name__ == "__main__":
    sys.exit(main())
