"""Two independent references of a scene, NAME_a.exr and NAME_b.exr, with their cost; two hidden ones, _c and _d."""
from __future__ import annotations

import json
import os
import platform
import secrets
import time
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from .. import cluster
from .._errors import Error
from .._measuring import series_error
from .._picture import Picture
from .problem import BenchmarkError
from .regions import regions_of
from .suite import Scene, Suite

LOG = "references.json"
OPEN, HIDDEN = "ab", "cd"


class References(NamedTuple):
    """Radiance (height, width, 3) of both, the regions, and the hidden pair where it was made."""
    first: np.ndarray
    second: np.ndarray
    regions: Dict[str, np.ndarray]
    hidden: Optional[Tuple[np.ndarray, np.ndarray]] = None

    def errors(self, pictures: List[np.ndarray], mask: Optional[np.ndarray] = None) -> Dict[str, float]:
        """series_error() against both, whose noise is in none of the numbers."""
        return series_error(pictures, self.first, self.second, mask=mask)

    def mean(self) -> np.ndarray:
        return 0.5 * (self.first + self.second)


def command() -> str:
    from .._trade import _command
    return _command()


def seed_of(scene: Scene, letter: str) -> int:
    """Open references have prescribed seeds, far from those of pictures; those of hidden ones are random."""
    return secrets.randbits(31) if letter in HIDDEN else 900000 + 2 * scene.number + OPEN.index(letter)


def file_of(folder: Path, scene: Scene, letter: str) -> Path:
    return Path(folder) / f"{scene.name}_{letter}.exr"


def _client(scheduler: str) -> Any:
    """Raises BenchmarkError where the package or the scheduler is missing."""
    try:
        from distributed import Client
    except ImportError:
        raise BenchmarkError("--scheduler: the Python package 'distributed' is missing (pip install distributed)") from None
    try:
        return Client(scheduler, timeout=20, set_as_default=False)
    except (OSError, ValueError) as problem:
        raise BenchmarkError(f"--scheduler: there is no scheduler at '{scheduler}': {problem}") from None


def make_one(scene: Scene, path: Path, letter: str, scheduler: str, threads: int) -> Dict[str, Any]:
    """Renders one by this machine or by the workers of a Dask cluster; returns what it cost."""
    seed, began, machines = seed_of(scene, letter), time.time(), [platform.processor() or platform.machine()]
    options = ["--seed", str(seed), "--auxiliary", "--integrator", scene.integrator] + ["--lenient"] * scene.lenient
    defines = scene.words() + [f"integrator.{k}={str(v).lower() if isinstance(v, bool) else v}" for k, v in scene.settings.items()]
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        if scheduler:
            with _client(scheduler) as client:
                cluster.render(scene.file, path, scheduler, passes=scene.passes, threads=threads or 1, options=options, defines=defines,
                               mote=command(), resume=True, quiet=True, client=client)
                machines = sorted({w["host"] for w in client.scheduler_info(n_workers=-1)["workers"].values()})
        else:
            words = [part for d in defines for part in ("-D", d)]
            cluster.run_mote(command(), ["render", str(scene.file), *options, *words, "--passes", str(scene.passes), "--quiet",
                                         "--threads", str(threads), "-o", str(path)])
    except cluster.ClusterError as problem:
        raise BenchmarkError(f"{scene.file}: {problem}") from None
    return {"seed": seed, "passes": scene.passes, "seconds": round(time.time() - began, 2), "machines": machines,
            "integrator": scene.integrator}


def make(suite: Suite, folder: Path, scenes: List[Scene], scheduler: str, threads: int, hidden: bool, say) -> Dict[str, Any]:
    """Makes what is missing, and writes seeds, seconds, machines and the noise by region to references.json."""
    log_file = Path(folder) / LOG
    log = json.loads(log_file.read_text(encoding="utf-8")) if log_file.is_file() else {"suite": suite.label(), "scenes": {}}
    for scene in scenes:
        if scene.missing():
            say(f"left out: {scene.name}: {scene.missing()}")
            continue
        made = log["scenes"].setdefault(scene.name, {})
        for letter in OPEN + (HIDDEN if hidden else ""):
            path = file_of(folder, scene, letter)
            if path.is_file() and made.get(letter, {}).get("passes") == scene.passes:
                continue
            made[letter] = make_one(scene, path, letter, scheduler, threads)
            say(f"{scene.name}_{letter}: {made[letter]['seconds']:.1f} s, {scene.passes} passes")
        made["noise"] = noise_by_region(load(folder, scene))
        log_file.write_text(json.dumps(log, indent=1) + "\n", encoding="utf-8")
        say(f"{scene.name}: noise of each reference " + ", ".join(f"{k} {100 * v:.2f} %" for k, v in made["noise"].items()))
    return log


def noise_by_region(references: References) -> Dict[str, float]:
    """Relative noise of one reference: from how the two differ, whose systematic part is 0."""
    pair = [references.first, references.second]
    return {name: round(float(references.errors(pair, mask)["noise"]), 6) for name, mask in references.regions.items()}


def load(folder: Path, scene: Scene) -> References:
    """Raises BenchmarkError where one is missing, damaged or of another size."""
    pictures = {}
    for letter in OPEN + HIDDEN:
        path = file_of(folder, scene, letter)
        if letter in HIDDEN and not path.is_file():
            continue
        if not path.is_file():
            raise BenchmarkError(f"{path}: is not there: 'python -m mote.benchmark references {scene.name}' makes it")
        try:
            pictures[letter] = Picture.load(path)
        except Error as problem:
            raise BenchmarkError(str(problem)) from None
        if (pictures[letter].width, pictures[letter].height) != (scene.width, scene.height):
            raise BenchmarkError(f"{path}: {pictures[letter].width} x {pictures[letter].height} pixels, and the suite has "
                                 f"{scene.width} x {scene.height}")
    radiance = {letter: np.asarray(p["beauty"]) for letter, p in pictures.items()}
    bad = [letter for letter, r in radiance.items() if not np.isfinite(r).all()]
    if bad:
        raise BenchmarkError(f"{file_of(folder, scene, bad[0])}: pixels that are not finite")
    hidden = (radiance["c"], radiance["d"]) if "c" in radiance and "d" in radiance else None
    return References(radiance["a"], radiance["b"], regions_of(pictures["a"], pictures["b"]), hidden)


def default_folder(suite: Suite) -> Path:
    """MOTE_BENCHMARK_REFERENCES, else out/benchmark/references beside the suite's folder."""
    usual = suite.file.resolve().parent.parent / "out" / "benchmark" / ("references_quick" if suite.quick else "references")
    return Path(os.environ.get("MOTE_BENCHMARK_REFERENCES", usual))
