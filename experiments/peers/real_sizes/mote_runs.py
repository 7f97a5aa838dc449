"""Our own pictures: references, and each method at doubling passes, every picture with its own seed."""
import json
import resource
import subprocess
from pathlib import Path

from doubling import next_passes
from exr import read_exr, read_header


class Mote:
    def __init__(self, program, scene, sizes, threads):
        """`scene`: the file; `sizes`: words of -D for the size and the filter, for all of its pictures."""
        self.program, self.scene, self.sizes, self.threads = str(program), str(scene), list(sizes), threads

    def render(self, output, integrator, settings, *rule, seed, sizes=None):
        """One picture; its statistics. Raises RuntimeError with mote's own words."""
        command = [self.program, "render", self.scene, "-o", str(output), "--seed", str(seed), "--quiet",
                   "--threads", str(self.threads), "--stats", str(output.with_suffix(".json")), *map(str, rule)]
        command += ["--integrator", integrator] + defined(self.sizes if sizes is None else sizes)
        command += defined(f"integrator.{name}={word(value)}" for name, value in settings.items())
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(done.stderr.strip() or f"mote ended with {done.returncode}")
        return json.loads(output.with_suffix(".json").read_text())

    def timed(self, output, method, passes, seed):
        """Passes, seed, file, and seconds without loading the scene and writing the file; `cpu_s` has those of writing."""
        before = processor_seconds()
        denoise = ["--denoise=oidn", "--auxiliary"] if method.get("denoise") else []
        statistics = self.render(output, method["integrator"], method.get("settings", {}), "--passes", passes, *denoise,
                                 seed=seed)
        seconds = statistics["seconds"]
        return {"layer": "denoised" if denoise else "", "passes": passes, "seed": seed, "file": output.name,
                "cpu_s": processor_seconds() - before,
                "wall_s": seconds["build"] + seconds["render"] + seconds["finish"] + seconds.get("denoise", 0.0),
                "build_s": seconds["load"],
                "commit": statistics["git_hash"]}

    def loading(self, folder, method):
        """Processor seconds of a picture of two by two pixels: those of loading the scene."""
        before = processor_seconds()
        tiny = [word for word in self.sizes if not word.startswith(("resx", "resy"))] + ["resx=2", "resy=2"]
        self.render(folder / "loading.exr", method["integrator"], {}, "--passes", 1, seed=1, sizes=tiny)
        return processor_seconds() - before

    def run(self, method, folder, budget, seed):
        """Pictures at doubling passes, within about `budget` seconds of rendering."""
        folder.mkdir(parents=True, exist_ok=True)
        loading = self.loading(folder, {"integrator": "path", "settings": {}})
        runs, passes = [], next_passes([], budget)
        while passes:
            run = self.timed(folder / f"{len(runs)}.exr", method, passes, seed + len(runs))
            run["cpu_s"] = max(0.0, run["cpu_s"] - loading)
            runs.append(run)
            passes = next_passes(runs, budget)
        log = {"version": f"mote {runs[0]['commit']}", "notes": [], "build_s": runs[-1]["build_s"], "runs": runs}
        (folder / "log.json").write_text(json.dumps(log, indent=1))
        return log


def defined(words):
    return [part for word in words for part in ("-D", word)]


def word(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def found_references(folders, name):
    """[NAME_a.exr, NAME_b.exr], each in the first folder that has it, or None; NAME.exr represents a missing NAME_a.exr."""
    first = lambda words: next((Path(f) / w for w in words for f in folders if (Path(f) / w).is_file()), None)
    return [first([f"{name}_a.exr", f"{name}.exr"]), first([f"{name}_b.exr"])]


def make_reference(mote, path, scene, seconds):
    """By the scene's path tracer; the last letter of the file's name is its seed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    print(f"{path.stem}: a reference, {seconds} s", flush=True)
    mote.render(path, scene["integrator"], scene.get("settings", {}), "--passes", 10**6, "--time", seconds,
                seed=1000 + ord(path.stem[-1]))
    return path


def filter_of(path):
    """`box` where the command of a picture says so, else the default of our scenes."""
    header, _ = read_header(Path(path).read_bytes())
    return "box" if b"film.rfilter=box" in header.get("commandLine", b"") else "gaussian"


def beauty_and_variance(path):
    """Arrays [height, width, 3]; the variance is that of the mean of each pixel."""
    layers = read_exr(path)
    if "Variance" not in layers:
        raise RuntimeError(f"{path} has no layer Variance: not a picture of mote render")
    return layers[""], layers["Variance"]
