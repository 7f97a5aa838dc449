"""mote's own methods: settings are "integrator", its parameters, and "denoise"."""
import json
import os
import resource
import subprocess
import time
from typing import List

from mote import Picture
from mote.benchmark.adapter import Adapter, Job, Run
from mote.benchmark.references import command


def words_of(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Renderer(Adapter):
    def version(self):
        done = subprocess.run([command(), "--version"], capture_output=True, text=True, check=True)
        return done.stdout.strip().splitlines()[0]

    def unsupported(self, scene, settings):
        """What the plan says that this integrator leaves out, as an error of the command."""
        words = [command(), "plan", str(scene.file), "--integrator", settings["integrator"], *self._words(scene, settings)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        return "" if done.returncode == 0 else (done.stderr.strip().splitlines() or ["failed"])[0].removeprefix("mote: ")

    def _words(self, scene, settings):
        own = [f"integrator.{k}={words_of(v)}" for k, v in settings.items() if k not in ("integrator", "denoise")]
        return [part for word in scene.words() + own for part in ("-D", word)] + ["--lenient"] * scene.lenient

    def render(self, job: Job) -> List[Run]:
        return [self._one(job, seed) for seed in job.seeds]

    def _one(self, job, seed):
        path, stats = job.folder / f"{seed}.exr", job.folder / f"{seed}.json"
        denoise = job.settings.get("denoise", "")
        words = [command(), "render", str(job.scene.file), "-o", str(path), "--seed", str(seed), "--passes", str(job.passes), "--quiet",
                 "--threads", str(job.threads), "--stats", str(stats), "--integrator", job.settings["integrator"],
                 *self._words(job.scene, job.settings)] + ([f"--denoise={denoise}", "--auxiliary"] if denoise else [])
        cpu, began = processor_seconds(), time.time()
        done = subprocess.run(words, capture_output=True, text=True, check=False, env={**os.environ})
        if done.returncode:
            raise RuntimeError(done.stderr.strip() or f"mote ended with {done.returncode}")
        cpu = processor_seconds() - cpu
        said = json.loads(stats.read_text())
        seconds = said["seconds"]
        stats.unlink()
        keep_beauty(path, denoise)
        load = seconds["load"] + seconds.get("write", 0.0)
        wall = seconds["build"] + seconds["render"] + seconds["finish"] + seconds.get("denoise", 0.0)
        # mote_layers renders each of its parts at least once, which may be more passes.
        return Run(seed, path.name, said["passes"], wall, cpu, load, began + seconds["load"])


def keep_beauty(path, denoise):
    """The picture alone: layers would be a hundred times its size."""
    picture = Picture.load(path)
    said = {k: v for k, v in picture.metadata.items() if k in ("seed", "passes", "integrator")}
    Picture({"beauty": picture["denoised" if denoise else "beauty"]}, said).save(path)
    path.with_suffix(".png").unlink(missing_ok=True)
