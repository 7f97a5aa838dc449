"""Times of ray-bundles, as the program mote_study_ray_bundles prints them: processor time on one thread."""
import argparse
import csv
import io
import subprocess
import sys
import time
from pathlib import Path

from origin import ROOT, Origin
from renders import finish


class BundleTimes:
    def __init__(self, folder):
        self._path = folder / "mote_study_ray_bundles"
        if not self._path.is_file():
            raise FileNotFoundError(f"no {self._path}: build it first (tools/build_release.sh mote_study_ray_bundles)")

    def rows(self, scene, forms, sides, directions, *options):
        """One dictionary of numbers a form and number of rays across the scene."""
        command = [self._path, scene, "--forms", ",".join(forms), "--sides", ",".join(map(str, sides)), "--directions",
                   str(directions), *map(str, options)]
        text = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=True).stdout
        return [{k: v if k == "form" else float(v) for k, v in row.items()} for row in csv.DictReader(io.StringIO(text))]


def write_table(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        table.writerows(rows)


def main(script, documentation, figure):
    """Runs `figure(times, quick, output)`, which returns an exit code; `output` lacks its suffix."""
    parser = argparse.ArgumentParser(description=documentation.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="less than a minute: fewer rays and directions")
    parser.add_argument("--output", type=Path, default=ROOT / "out" / "figures")
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin", help="folder of the programs")
    options = parser.parse_args()
    try:
        times = BundleTimes(options.bin)
        subprocess.run([ROOT / "scenes" / "generate", options.bin], stdout=subprocess.DEVNULL, check=True)
    except (FileNotFoundError, subprocess.CalledProcessError) as error:
        print(error, file=sys.stderr)
        return 2
    begin = time.monotonic()
    options.output.mkdir(parents=True, exist_ok=True)
    output = options.output / (Path(script).stem + ("_quick" if options.quick else ""))
    code = figure(times, options.quick, output)
    finish(Origin(script, options.quick), output)
    print(f"{time.monotonic() - begin:.0f} s")
    return code
