"""Mitsuba in the plot of mote trade: DIR/mitsuba.peer.csv, with the columns of DIR/trade.csv (docs/guide.md).

The scene and the seeds are those of DIR/trade.json, the reference is DIR/reference.exr; every seed gets as much time as
the slowest method of the trade took. Then `mote trade --redraw -o DIR` draws all of them together.
"""
import csv
import json
import shlex
import sys
import tempfile
import time
from pathlib import Path

import mitsuba as mi
import numpy as np
import renderers

sys.path.append(str(Path(__file__).resolve().parents[2] / "figures"))
import measure  # noqa: E402

COLUMNS = ("method", "integrator", "settings", "seed", "passes", "wall_s", "cpu_s", "build_s", "error", "relmse",
           "relmse_trimmed", "bias", "bias_se", "non_finite", "final")


def defines_of(command):
    """The words after every -D of a command line."""
    words = shlex.split(command)
    return [words[i + 1] for i, word in enumerate(words[:-1]) if word in ("-D", "--define")]


class Clock:
    def __init__(self):
        self.wall, self.cpu = time.monotonic(), time.process_time()

    def read(self):
        return time.monotonic() - self.wall, time.process_time() - self.cpu


def one_seed(folder, method, integrator, seed, limit, reference):
    """Rows at 1, 2, 4, ... passes until `limit` seconds of rendering are over."""
    clock = Clock()
    scene = renderers.load_mitsuba(folder)
    build, rows, total, passes, brightness = clock.read()[0], [], 0.0, 0, []
    wall = cpu = 0.0
    while not rows or wall < limit:
        more = max(1, passes)  # doubles the passes
        start = Clock()
        picture = renderers.mitsuba_picture(scene, more, renderers.seed_list(1, offset=1000 * seed + len(rows))[0])
        spent = start.read()
        wall, cpu = wall + spent[0], cpu + spent[1]
        total, passes = total + more * picture.astype(float), passes + more
        brightness.append((more, picture.mean(dtype=float)))
        found = measure.module().compare((total / passes).astype(np.float32), reference)
        rows.append({"method": method, "integrator": integrator, "settings": "", "seed": seed, "passes": passes,
                     "wall_s": wall + build, "cpu_s": cpu + build, "build_s": build, "error": found["error"], "relmse": found["relmse"],
                     "relmse_trimmed": found["relmse_trimmed"], "bias": found["bias"],
                     "bias_se": bias_error(brightness, reference["beauty"]),
                     "non_finite": int(np.count_nonzero(~np.isfinite(picture))), "final": 0})
    rows[-1]["final"] = 1
    return rows


def bias_error(brightness, reference):
    """Standard error of the bias from means of unequal numbers of passes; '' while there is but one."""
    if len(brightness) < 3:
        return ""
    n, mean = np.array([b[0] for b in brightness], float), np.array([b[1] for b in brightness])
    overall = (n * mean).sum() / n.sum()
    from_overall = mean - overall
    of_one_pass = (n * from_overall**2).sum() / (len(n) - 1)
    return np.sqrt(of_one_pass / n.sum()) / reference.mean()


def write_peer(options):
    folder = Path(options.trade)
    measure.use(Path(options.mote).parent)
    facts = json.loads((folder / "trade.json").read_text())["facts"]
    with open(folder / "trade.csv", newline="") as file:
        limit = max(float(row["wall_s"]) for row in csv.DictReader(file))
    reference = measure.module().Picture.load(folder / "reference.exr")
    rows = []
    with tempfile.TemporaryDirectory() as exported:
        for line in renderers.export(options.mote, facts["scene"], options.defines or defines_of(facts["command"]),
                                     exported):
            print(line)
        integrator = mi.load_file(str(Path(exported) / "scene.xml")).integrator().class_name()
        for seed in facts["seeds"]:
            rows += one_seed(exported, f"Mitsuba {mi.__version__}", integrator, seed, limit, reference)
            last = rows[-1]
            print(f"seed {seed}: {last['passes']} passes, {last['wall_s']:.2f} s, error {100 * last['error']:.2f} %, "
                  f"bias {100 * last['bias']:+.2f} %", flush=True)
    with open(folder / "mitsuba.peer.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    print(f"{folder / 'mitsuba.peer.csv'}: now 'mote trade --redraw -o {folder}'")
    return 0
