"""pbrt-v4, where its program is (PBRT, or on the path): for scenes that are .pbrt files, since mote writes none."""
import os
import resource
import shutil
import subprocess
import time
from typing import List

from mote import Picture
from mote.benchmark.adapter import Adapter, Job, Run


def program():
    return os.environ.get("PBRT") or shutil.which("pbrt")


class Renderer(Adapter):
    def missing(self):
        found = program()
        return "" if found and os.access(found, os.X_OK) else "pbrt-v4 is not installed (PBRT names its program)"

    def unsupported(self, scene, settings):
        return "" if scene.file.suffix == ".pbrt" else "no .pbrt file of this scene, and mote does not write that format"

    def version(self):
        done = subprocess.run([program(), "--help"], capture_output=True, text=True, check=False)
        return (done.stdout or done.stderr).strip().splitlines()[0]

    def render(self, job: Job) -> List[Run]:
        return [self._one(job, seed) for seed in job.seeds]

    def _one(self, job, seed):
        """Its seconds contain those of loading, which it does not state apart."""
        path = job.folder / f"{seed}.exr"
        words = [program(), "--quiet", "--seed", str(seed), "--spp", str(job.passes), "--nthreads", str(job.threads), "--outfile", str(path),
                 str(job.scene.file)]
        before, began, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.time(), time.monotonic()
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode:
            raise RuntimeError(done.stderr.strip() or f"pbrt ended with {done.returncode}")
        Picture({"beauty": Picture.load(path)["beauty"]}).save(path)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return Run(seed, path.name, job.passes, wall, cpu, 0.0, began)
