"""Renders of the figure scripts: images of the `mote` command, their statistics, and the common options.

Every render is a file in OUTPUT/NAME/, with its statistics beside it; --redraw takes those of the last run as they are.
Errors come from independent seeds: `mean_and_error` is their mean and its standard error. Variants that are rendered with
the same seeds share their virtual point lights, so the differences of pairs are far less noisy than the renders are.

--NAME VALUE sets a value of the scenes or integrators (own_settings.py), --compare also renders without it and says how far
apart the pictures are, and --in-process renders by `import mote` instead of the command: the same bits, without its start.
"""
import argparse
import csv
import json
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import measure
from claims import Claims
from exr import read_exr
from origin import ROOT, Origin
from own_settings import OwnSettings

# Layers whose sum is volpath's multiple_scattering: light that scatters in a medium last, and elsewhere before.
BOUNDED, RECOVERED = "multiple_scattering_bounded", "compensation_volume"


class Picture:
    """Layers by name, and the statistics of the render; `cpu` is the seconds of all its threads."""

    def __init__(self, path):
        self.layers = read_exr(path)
        self.statistics = json.loads(path.with_suffix(".json").read_text())
        self.cpu = float(path.with_suffix(".cpu").read_text())

    def __getitem__(self, layer):
        return self.layers[layer]

    def multiple(self):
        """Light that was scattered in a medium last, and elsewhere before."""
        return sum(self.layers.get(name, 0.0) for name in ("multiple_scattering", BOUNDED, RECOVERED))

    def value(self, name):
        return self.statistics["values"][name]

    @property
    def passes(self):
        return self.statistics["passes"]

    @property
    def vpls(self):
        return self.statistics["vpls"] / self.passes


class Mote:
    def __init__(self, options, name, origin):
        self.origin = origin
        self.program = options.bin / "mote"
        self.folder = options.output / name
        self.redraw, self.own, self.compare = options.redraw, options.own, options.compare
        self.pilots = {}  # processor seconds of one and of three passes, by name
        measure.use(options.bin)
        self.module = measure.module() if options.in_process else None
        if not self.program.is_file():
            raise FileNotFoundError(f"no {self.program}: build it first (tools/build_release.sh mote)")
        self.folder.mkdir(parents=True, exist_ok=True)

    def render(self, scene, name, settings, passes, seed=1, threads=0, auxiliary=False):
        """`scene` is a name in scenes/ or a path; `settings` go to -D, but for `integrator`, which is a type (a scene of
        scenes/ without any: mote_vpl, as the papers' figures are about virtual point lights). 0 threads:
        one for every core. `auxiliary`: with what `mote ssbc` reads."""
        if not isinstance(scene, Path):
            scene, settings = ROOT / "scenes" / f"{scene}.xml", {"integrator": "mote_vpl"} | settings
        own = self.own.added_to(scene, settings)
        path = self.rendered(scene, name, own, passes, seed, threads, auxiliary)
        picture = Picture(path)
        self.origin.add(name, scene, own, passes, seed, picture.statistics)
        if self.compare and own != settings:
            plain = self.rendered(scene, f"{name}_plain", settings, passes, seed, threads, auxiliary)
            said = subprocess.run([self.program, "compare", path, plain, "--json"], check=True, capture_output=True, text=True)
            metrics = {k: v["value"] for k, v in json.loads(said.stdout)["metrics"].items()}
            print(f"{path.stem}: differs by {metrics['error']:.2%} from the one without {self.own.suffix()[1:]}, "
                  f"in the mean by {metrics['bias']:+.2%}")
        return picture

    def render_for(self, seconds, scene, name, settings, seed=1, pilot=""):
        """As many passes as take so many processor seconds on one thread, two at the least, by renders of one and of three passes;
        those of the same `pilot` (else `name`) are measured once."""
        pilot = pilot or name
        if pilot not in self.pilots:
            self.pilots[pilot] = [self.render(scene, f"{pilot}_{word}", settings, passes, threads=1).cpu
                                  for word, passes in (("one", 1), ("three", 3))]
        one, three = self.pilots[pilot]
        return self.render(scene, name, settings, max(2, round((seconds - one) / max((three - one) / 2, 1e-3))), seed, threads=1)

    def rendered(self, scene, name, settings, passes, seed, threads, auxiliary):
        """The file of a picture, with its statistics and its processor seconds beside it."""
        path = self.folder / f"{name}_{seed}.exr"
        if not (self.redraw and path.is_file()):
            render = self.render_in_process if self.module else self.render_by_command
            seconds = render(path, scene, settings, passes, seed, threads, auxiliary)
            path.with_suffix(".cpu").write_text(f"{seconds:.3f}\n")
        return path

    def render_by_command(self, path, scene, settings, passes, seed, threads, auxiliary):
        command = [self.program, "render", scene, "-o", path, "--seed", str(seed), "--quiet",
                   "--stats", path.with_suffix(".json")]
        command += ["--passes", str(passes), "--threads", str(threads)] + ["--auxiliary"] * auxiliary
        for key, value in settings.items():
            command += ["--integrator", value] if key == "integrator" else ["-D", f"{key}={word(value)}"]
        before = children_cpu()
        subprocess.run(command, check=True)
        return children_cpu() - before

    def render_in_process(self, path, scene, settings, passes, seed, threads, auxiliary):
        begin = time.process_time()
        defines = {key: word(value) for key, value in settings.items() if key != "integrator"}
        loaded = self.module.load(scene, integrator=settings.get("integrator", ""), define=defines)
        picture = self.module.render(loaded, passes=passes, seed=seed, threads=threads, auxiliary=auxiliary)
        picture.save(path)
        path.with_suffix(".json").write_text(json.dumps(picture.statistics))
        return time.process_time() - begin

    def ssbc(self, source, name, *options):
        """`mote ssbc` on an EXR file: the file it wrote, what it said, and the processor seconds of the whole command."""
        path = self.folder / f"{name}.exr"
        before = children_cpu()
        said = subprocess.run([self.program, "ssbc", source, "-o", path, *map(str, options)], check=True,
                              capture_output=True, text=True).stdout
        return path, said, children_cpu() - before


def word(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def children_cpu():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def compensation(kind, **settings):
    """Settings of mote_vpl with a compensation of this type."""
    return {"integrator.compensation": kind, **{f"integrator.compensation.{k}": v for k, v in settings.items()}}


def approximate(depth, **settings):
    return compensation("approximate", depth=depth, **settings)


def luminance(image):
    return image @ np.array([0.2126, 0.7152, 0.0722])


def around(plane, radius=2):
    """Every pixel's neighbours within so many pixels, itself among them, one after the other: a plane each."""
    padded, (height, width) = np.pad(plane, radius, mode="edge"), plane.shape
    steps = range(2 * radius + 1)
    return np.array([padded[i:i + height, k:k + width] for i in steps for k in steps])


def mean_and_error(values):
    """Mean of independent values along the first axis, and its standard error."""
    values = np.asarray(values, dtype=float)
    return values.mean(axis=0), values.std(axis=0, ddof=1) / len(values) ** 0.5


def show(axes, image, exposure, title=None):
    axes.imshow(np.clip(image * exposure, 0, 1) ** (1 / 2.2), interpolation="nearest")
    axes.axis("off")
    if title:
        axes.set_title(title, fontsize=9)


def write_csv(path, header, rows):
    """A table; the claims that were checked follow it when the script ends."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(header)
        for row in rows:
            table.writerow([f"{x:.5g}" if isinstance(x, float) else x for x in row])


def finish(origin, output):
    """The claims under the table, and where all of it comes from in table and picture. `output` lacks its suffix."""
    table, picture = (output.with_name(output.name + suffix) for suffix in (".csv", ".png"))
    if not table.is_file():
        return
    with open(table, "a", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([["claim", "measured", "holds"], *Claims.checked])
    origin.stamp(picture, table)


def main(script, documentation, figure):
    """Runs `figure(mote, quick, output)`, which returns an exit code; `output` lacks its suffix."""
    parser = argparse.ArgumentParser(description=documentation.split("\n")[0], epilog="--NAME VALUE, such as --bound 5 or "
                                     "--film.width 80, sets a parameter of the scene or of its integrators, as -D of mote render does.")
    parser.add_argument("--quick", action="store_true", help="less than a minute, at low resolution")
    parser.add_argument("--redraw", action="store_true", help="take the pictures of the last run where they are")
    parser.add_argument("--output", type=Path, default=ROOT / "out" / "figures")
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin", help="folder of mote")
    parser.add_argument("--in-process", action="store_true", help="render by `import mote`, not by the command")
    parser.add_argument("--compare", action="store_true", help="say how far --NAME VALUE is from what the script sets")
    options, words = parser.parse_known_args()
    origin = Origin(script, options.quick)
    try:
        options.own = OwnSettings(words, options.bin / "mote")
        options.own.check_names([Path(script), *(ROOT / "scenes").glob("*.xml"), *Path(__file__).parent.glob("scenes/*.xml")])
        name = Path(script).stem + options.own.suffix()
        mote = Mote(options, name + ("_quick" if options.quick else ""), origin)
        subprocess.run([ROOT / "scenes" / "generate", options.bin], stdout=subprocess.DEVNULL, check=True)
    except (FileNotFoundError, ImportError, ValueError, subprocess.CalledProcessError) as error:
        print(error, file=sys.stderr)
        return 2
    begin = time.monotonic()
    # Beside a full run, a quick one leaves its pictures alone.
    output = options.output / (name + ("_quick" if options.quick else ""))
    try:
        code = figure(mote, options.quick, output)
        options.own.check()
    except (ValueError, subprocess.CalledProcessError) as error:
        print(error, file=sys.stderr)
        return 2
    finish(origin, output)
    print(f"{time.monotonic() - begin:.0f} s: {output}.csv, {output.name}.png")
    return code
