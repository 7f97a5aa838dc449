#!/usr/bin/python3
"""Virtual point lights by the million: what selecting them costs, and what it leaves of the picture.

Runs mote_study_selection at tiles of 4 x 4 pixels sampled from a picture of 512 x 512: all methods have the same lights, eye
paths and points along them, and are held against the light of all lights. That takes a million lights 5 to 20 s a tile, so
sums of 60 tiles lie in experiments/studies/selection/references, and only what is missing there is made (of other numbers of
lights in build/references); --references makes them and nothing else. Prints a table a scene, error against threshold, and
how the time of a lightcut grows with the number of lights: the slope of a line through the logarithms. Seconds are of one
processor, for the whole picture, without eye paths and direct light.

--quick: few tiles and lights, two minutes. --output FOLDER: many_virtual_lights.csv and .png. A method is
KIND:THRESHOLD:MAX_CUT:ERROR:SHARED_ANGLE:SHARED_ANGLE_IN_MEDIA (docs/scene-format.md, <selection>).
"""
import argparse
import csv
import json
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "experiments/figures"))
import plotting
from origin import Origin, table_of

SHARED = "multidimensional:0.02:1000:0:0.2:0.2"
TO_TWO_PERCENT = "multidimensional:0.018:1100:0:0.25:0.25"  # in the smoke room
METHODS = ["lightcuts:0.02:1000", "multidimensional:0.02:1000", SHARED, TO_TWO_PERCENT, "multidimensional:0.02:1000:0:5:5",
           "uniform:64", "uniform:256", "stochastic:64", "stochastic:256", "ris:128:16", "ris:256:32", "ris:512:64"]
# Methods that the estimated error ends, not their thresholds.
BY_ERROR = [f"multidimensional:0.002:4000:{error}:0.2:0.2" for error in (0.08, 0.04, 0.02)]
GROWTH = "multidimensional:0.002:4000:0.04:0.2:0.2"
# Scene, light paths for a million lights, bound [1/m^2].
SCENES = [("atrium", 1000000, 2.0), ("smoke_room", 410000, 20.0)]


def study(options, scene, paths, bound, methods, *more):
    command = [options.program, str(ROOT / "scenes" / f"{scene}.xml"), *methods, "--paths", str(paths), "--bound", str(bound),
               "--tiles", str(options.tiles), "--threads", str(options.threads), *more]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr)
    print(done.stderr.strip().splitlines()[0], flush=True)
    return [dict(line, scene=scene, paths=paths) for line in csv.DictReader(done.stdout.splitlines())]


def references(options, scene, paths):
    folder = ROOT / ("build/references" if options.quick else "experiments/studies/selection/references")
    folder.mkdir(parents=True, exist_ok=True)
    return ["--references", str(folder / f"{scene}_{paths}.txt")]


def table(lines):
    print("| scene | lights | method | error [%] | estimated [%] | bias [%] | median [%] | seconds | rays a pixel | groups | at the limit |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for l in lines:
        print(f"| {l['scene']} | {l['lights']} | {l['method']} | {l['relative_error_percent']} +- {l['its_standard_error']} | "
              f"{l['predicted_percent']} | {l['bias_percent']} | {l['median_percent']} | {l['gather_seconds']} | {l['rays_a_pixel']} | "
              f"{l['groups_a_cut']} | {l['at_limit']} |")


def slope(lines):
    """Slope of the logarithm of the seconds over that of the lights, by least squares."""
    x = [math.log(float(l["lights"])) for l in lines]
    y = [math.log(float(l["gather_seconds"])) for l in lines]
    return statistics.linear_regression(x, y).slope


def origin_of(options):
    """The program names its commit in the statistics of a render."""
    origin = Origin(__file__, options.quick)
    with tempfile.TemporaryDirectory() as name:
        statistics = Path(name) / "stats.json"
        subprocess.run([Path(options.program).parent / "mote", "render", ROOT / "scenes/cornell_box.xml", "-D", "resx=8", "-D", "resy=8",
                        "--passes", "1", "--quiet", "-o", Path(name) / "p.exr", "--stats", statistics], check=True)
        origin.programs.add(json.loads(statistics.read_text())["git_hash"])
    return origin


def write_table(path, lines, growths):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, lines[0].keys())
        writer.writeheader()
        writer.writerows(lines)
        claims = csv.writer(file)
        claims.writerow(["claim", "measured"])
        for scene, growth in growths.items():
            claims.writerow([f"{scene}: seconds grow as lights to the power", f"{slope(growth):.2f}"])


def name_of(method):
    """The method in words; None for one that the plot leaves out."""
    kind, *numbers = method.split(":")
    if kind == "ris":
        return f"resampling, {numbers[1]} of {numbers[0]}" if numbers[2:] in ([], ["none", "cut"]) else None
    if kind in ("uniform", "stochastic"):
        return f"{kind}, {numbers[0]}"
    threshold, _, error, angle = (float(n) for n in [*numbers, "0", "0"][:4])
    ended = f"error {100 * error:g} %" if error else f"{100 * threshold:g} %"
    return f"{kind}, {ended}" + (f", shared {angle:g}" if angle else "")


def plot_table(table, path):
    """Error against time of each scene, and time against the number of lights, from the table of a run."""
    rows = [row for row in csv.DictReader(table_of(table).splitlines()) if row["paths"]]
    made, axes = plotting.figure(rows=3, height=1320)
    for ax, (scene, _, _) in zip(axes, SCENES):
        ends = []
        for row in rows:
            name, error = name_of(row["method"]), float(row["relative_error_percent"])
            if row["scene"] == scene and error > 0 and name:
                x, colour = float(row["gather_seconds"]), plotting.colour(name)
                ax.errorbar(x, error, float(row["its_standard_error"]), fmt="o", color=colour, markersize=5)
                ends.append((name, x, error, colour))
        plotting.log_axes(ax, "processor seconds of a pass", "relative RMSE of pixels [%]", percent=False)
        ax.set_title(f"{scene.replace('_', ' ')}: a million lights, against the light of all of them", loc="left", fontsize=12)
        plotting.label_ends(ax, ends)
    ends = []
    for colour, (scene, _, _) in zip((plotting.BLUE, plotting.ORANGE_RED), SCENES):
        own = [row for row in rows if row["scene"] == scene and row["method"] == GROWTH and float(row["relative_error_percent"]) == 0]
        x, y = [float(row["lights"]) for row in own], [float(row["gather_seconds"]) for row in own]
        axes[2].plot(x, y, "o-", color=colour)
        ends.append((f"{scene.replace('_', ' ')}, exponent {slope(own):.2f}", x[-1], y[-1], colour))
    plotting.log_axes(axes[2], "number of lights", "processor seconds of a pass", percent=False)
    axes[2].xaxis.set_major_locator(plotting.LogLocator())
    axes[2].xaxis.set_major_formatter(plotting.FuncFormatter(lambda v, _: f"{v:,.0f}"))
    axes[2].set_title("a cut that ends by an estimated error of 4 %, or at 4000 clusters", loc="left", fontsize=12)
    plotting.label_ends(axes[2], ends)
    plotting.save(made, path)


def write(options, lines, growths):
    options.output.mkdir(parents=True, exist_ok=True)
    table, picture = options.output / "many_virtual_lights.csv", options.output / "many_virtual_lights.png"
    write_table(table, lines, growths)
    plot_table(table, picture)
    origin_of(options).stamp(picture, table)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/mote_study_selection"))
    parser.add_argument("--quick", action="store_true", help="few tiles and lights")
    parser.add_argument("--references", action="store_true", help="make what is missing of the references, and nothing else")
    parser.add_argument("--tiles", type=int, help="of 4 x 4 pixels")
    parser.add_argument("--threads", type=int, default=1, help="for references; methods have one")
    parser.add_argument("--output", type=Path, help="folder of the table and of the plot")
    options = parser.parse_args()
    options.tiles = options.tiles or (6 if options.quick else 60)
    share, lines, growths = (50 if options.quick else 1), [], {}
    for scene, paths, bound in SCENES:
        methods = [] if options.references else METHODS + BY_ERROR
        lines += study(options, scene, paths // share, bound, methods, *references(options, scene, paths // share))
    if options.references:
        return
    table(lines)
    for scene, paths, bound in SCENES:
        growths[scene] = []
        for exponent in range(3, 6 if options.quick else 8):
            number = int(paths * 10.0 ** (exponent - 6))
            growths[scene] += study(options, scene, number, bound, [GROWTH], "--costs")
        table(growths[scene])
        print(f"{scene}: seconds grow as lights^{slope(growths[scene]):.2f}", flush=True)
        lines += growths[scene]
    if options.output:
        write(options, lines, growths)


if __name__ == "__main__":
    main()
