"""The interface of programs that render the suite, and how many passes fit into a budget."""
from __future__ import annotations

import importlib.util
import sys
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any, Dict, List, NamedTuple

from .problem import BenchmarkError, hint
from .suite import Scene

RESERVE = 0.88  # of the budget: seconds vary from picture to picture, and a late one counts as none


class Job(NamedTuple):
    """Pictures of one scene with equal passes. seeds: consecutive. folder: where the pictures go, as EXR."""
    scene: Scene
    settings: Dict[str, Any]
    passes: int
    seeds: List[int]
    threads: int
    folder: Path


class Run(NamedTuple):
    """One picture; seconds as in the manifest (submission.py). file: in the job's folder."""
    seed: int
    file: str
    passes: int
    wall_s: float
    cpu_s: float
    load_s: float
    started: float


class Adapter(ABC):
    """Renders the suite's scenes by one program. Subclasses are called Renderer, in adapters/PROGRAM.py beside the suite."""
    repeatable = True  # the same seed gives the same noise

    def missing(self) -> str:
        """Why the program cannot be run here; "" where it can."""
        return ""

    def unsupported(self, scene: Scene, settings: Dict[str, Any]) -> str:
        """Why it cannot render a scene; "" where it can."""
        return ""

    @abstractmethod
    def version(self) -> str:
        """Name and version of the program."""

    @abstractmethod
    def render(self, job: Job) -> List[Run]:
        """Raises RuntimeError in the program's own words."""

    def notes(self) -> List[str]:
        """What was dropped or changed for this program so far."""
        return []


def load_adapter(folder: Path, program: str) -> Adapter:
    """The adapter of adapters/PROGRAM.py. Raises BenchmarkError with the nearest name."""
    file = Path(folder) / f"{program}.py"
    if not file.is_file():
        known = sorted(f.stem for f in Path(folder).glob("[a-z]*.py"))
        raise BenchmarkError(f"{folder}: no adapter '{program}'{hint(program, known)}")
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))
    spec = importlib.util.spec_from_file_location(f"mote_benchmark_{program}", file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module.Renderer()


class Pilot:
    """Passes that fit into a budget, from short renders whose pictures are discarded."""

    def __init__(self, adapter: Adapter, job: Job) -> None:
        self.adapter, self.job, self.passes, self.seconds = adapter, job, 0, 0.0

    def _try(self, passes: int) -> None:
        seed = self.job.seeds[0] + 500  # no seed of a picture
        run = self.adapter.render(self.job._replace(passes=passes, seeds=[seed]))[0]
        self.passes, self.seconds = passes, max(run.wall_s, 1e-4)

    def fit(self, budget: float) -> int:
        """0 where not even one pass fits."""
        if not self.passes:
            self._try(1)
        while self.seconds < budget / 6:
            # Few passes say little about those that follow: at most 16 times as many at once.
            self._try(max(2 * self.passes, min(16 * self.passes, int(self.passes * 0.3 * budget / self.seconds))))
        if self.seconds > budget and self.passes == 1:
            return 0
        return max(1, int(self.passes * RESERVE * budget / self.seconds))
