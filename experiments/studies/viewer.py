#!/usr/bin/python3
"""How long does the viewer make one wait, and what does it cost the render?

Starts `mote view` and speaks to it as the page does, without a browser (the time of a layer's toggle is measured in one by
tests/viewer/page_test.py):

- first picture: from the start of the program to the first frame, and to the first of all pixels;
- restart: from a changed knob to the next frame, of the integrator, of a light, of the camera;
- moving: frames a second while the camera turns at 320 x 200, sixty moves, each once the frame before has come;
- slowdown: processor seconds of the program for a number of passes with one client and without, against `mote render`.

    experiments/studies/viewer.py [--bin FOLDER] [--scene FILE] [--passes N] [--repeats N]
"""
import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "viewer"))
from view_program import Program  # noqa: E402

parser = argparse.ArgumentParser()
parser.add_argument("--bin", default=str(ROOT / "build/release/bin"))
parser.add_argument("--scene", default=str(ROOT / "scenes/cornell_box.xml"))
parser.add_argument("--passes", type=int, default=200)
parser.add_argument("--repeats", type=int, default=5)
arguments = parser.parse_args()
MOTE = os.path.join(arguments.bin, "mote")
SMALL = ["-D", "film.width=320", "-D", "film.height=200"]


def median(values):
    values = list(values)
    return f"{statistics.median(values):.3f} s ({min(values):.3f} to {max(values):.3f})"


def first_picture(options):
    begin = time.monotonic()
    with Program(MOTE, arguments.scene, *options) as program:
        client = program.connect()
        client.frame()
        first = time.monotonic() - begin
        client.frame(lambda h: not h["coarse"])
        return first, time.monotonic() - begin


def restarts(options):
    """Seconds from each kind of change to the frame that shows it."""
    found = {"integrator": [], "light": [], "camera": []}
    with Program(MOTE, arguments.scene, *options) as program:
        client = program.connect()
        scene, _ = client.wait_for(lambda h: h["type"] == "scene")
        frame, _ = client.frame()
        camera = scene["camera"]
        radiance = next(k for g in scene["knobs"]["A"] for k in g["knobs"] if g["kind"] == "emitter" and k["type"] == "rgb")
        for i in range(3 * arguments.repeats):
            time.sleep(0.3)  # the render is in its passes
            kind = list(found)[i % 3]
            view = [camera["origin"][0] + 0.01 * i, *camera["origin"][1:], *camera["target"], *camera["up"]]
            message = {"integrator": {"type": "set", "define": {"integrator.max_depth": str(8 + i)}},
                       "light": {"type": "set", "define": {radiance["path"]: f"{5 + i} 5 5"}},
                       "camera": {"type": "camera", "view": view}}[kind]
            begin = time.monotonic()
            client.send(message)
            change = frame["change"]
            frame, _ = client.frame(lambda h: h["change"] > change)
            found[kind].append(time.monotonic() - begin)
    return found


def moving(options):
    with Program(MOTE, arguments.scene, *SMALL, *options) as program:
        client = program.connect()
        camera = client.wait_for(lambda h: h["type"] == "scene")[0]["camera"]
        frame, _ = client.frame()
        moves, begin, sizes = 60, time.monotonic(), set()
        for i in range(moves):
            angle = 0.3 * math.sin(0.1 * i)
            back = [camera["origin"][k] - camera["target"][k] for k in range(3)]
            origin = [camera["target"][0] + back[0] * math.cos(angle) + back[2] * math.sin(angle), camera["origin"][1],
                      camera["target"][2] - back[0] * math.sin(angle) + back[2] * math.cos(angle)]
            client.send({"type": "camera", "view": [*origin, *camera["target"], *camera["up"]], "moving": True})
            change = frame["change"]
            frame, _ = client.frame(lambda h: h["change"] > change)
            sizes.add((frame["width"], frame["height"]))
        return moves / (time.monotonic() - begin), sizes


def processor_seconds(pid):
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def cost(watched):
    """Processor and wall seconds of a view until all passes are there."""
    begin = time.monotonic()
    with Program(MOTE, arguments.scene, *SMALL, "--integrator", "path", "--passes", str(arguments.passes)) as program:
        if watched:
            client = program.connect()
            client.frame(lambda h: h["finished"], 600)
            return processor_seconds(program.process.pid), time.monotonic() - begin
        used = -1.0
        while processor_seconds(program.process.pid) != used:  # until it rests
            used = processor_seconds(program.process.pid)
            time.sleep(0.5)
        return used, float("nan")


def cost_of_render():
    with tempfile.TemporaryDirectory() as folder:
        begin, before = time.monotonic(), os.times()
        subprocess.run([MOTE, "render", arguments.scene, *SMALL, "--integrator", "path", "--passes", str(arguments.passes),
                        "-o", os.path.join(folder, "x.exr"), "--quiet"], check=True)
        after = os.times()
        used = after.children_user + after.children_system - before.children_user - before.children_system
        return used, time.monotonic() - begin


def main():
    print(f"{Path(arguments.scene).name}, {os.cpu_count()} processors")
    for options in (["--integrator", "path"], ["--integrator", "mote_vpl"], []):
        name = options[-1] if options else "its own integrator"
        firsts = [first_picture(options) for _ in range(arguments.repeats)]
        print(f"{name}: first picture {median(f for f, _ in firsts)}, of all pixels {median(w for _, w in firsts)}", flush=True)
        if options:
            for kind, seconds in restarts(options).items():
                print(f"{name}: restart after a change of the {kind}: {median(seconds)}", flush=True)
        rate, sizes = moving(options)
        print(f"{name}: {rate:.1f} pictures a second while the camera moves, of {sorted(sizes)}", flush=True)
    kinds = {"mote render": cost_of_render, "a view without a client": lambda: cost(False), "a view with a client": lambda: cost(True)}
    used = {kind: [] for kind in kinds}
    for _ in range(arguments.repeats):  # in turns: a busy machine slows all of them
        for kind, measure in kinds.items():
            used[kind].append(measure()[0])
    base = statistics.median(used["mote render"])
    for kind, values in used.items():
        print(f"{arguments.passes} passes of path at 320 x 200, {kind}: {statistics.median(values):.2f} processor seconds "
              f"({min(values):.2f} to {max(values):.2f}), {100 * (statistics.median(values) / base - 1):+.1f} %")


main()
