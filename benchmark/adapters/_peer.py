"""What the adapters of Mitsuba and Cycles share: the scene as mote exports it, and the programs of experiments/peers."""
import json
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace
from typing import List

import numpy as np
from mote import Picture
from mote.benchmark.adapter import Adapter, Job, Run
from mote.benchmark.references import command

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "experiments" / part) for part in ("figures", "peers/real_sizes")]
SETTINGS = ROOT / "experiments" / "peers" / "real_sizes" / "settings.json"


class Peer(Adapter):
    program = ""

    def __init__(self):
        self._version, self._notes = "", []

    def notes(self):
        return self._notes

    def unsupported(self, scene, settings):
        """Exports the scene once, without its grids, to see whether mote can."""
        from peer_runs import export
        with tempfile.TemporaryDirectory(prefix="mote_") as folder:
            try:
                export(self._mote(scene, 1), scene.integrator, folder)
            except (RuntimeError, OSError) as problem:
                return (str(problem).strip().splitlines() or ["failed"])[0].removeprefix("mote: ")
        return ""

    def _mote(self, scene, threads):
        return SimpleNamespace(program=command(), scene=str(scene.file), sizes=scene.words(), threads=threads)

    def render(self, job: Job) -> List[Run]:
        from peer_runs import export, pictures, run_peer
        given = json.loads(SETTINGS.read_text(encoding="utf-8"))
        given["cycles"]["filter"] = "box"
        peer = {"program": self.program, "denoise": False, "guiding": False, **job.settings}
        mote = self._mote(job.scene, job.threads)
        with tempfile.TemporaryDirectory(prefix="mote_") as folder:
            exported, output = Path(folder) / "exported", Path(folder) / "pictures"
            dropped = export(mote, job.scene.integrator, exported)
            log = run_peer(peer, mote, given, exported, output, [job.passes] * len(job.seeds), job.seeds[0])
            if log is None:
                raise RuntimeError("a part of it is not installed (OpenImageDenoise: pip install pyoidn)")
            self._version = log["version"]
            self._notes = sorted({*self._notes, *(f"{job.scene.name}: {note}" for note in [*dropped, *log["notes"]])})
            runs = []
            for seed, run, picture in zip(job.seeds, log["runs"], pictures(output, log)):
                Picture({"beauty": np.asarray(picture, np.float32)}).save(job.folder / f"{seed}.exr")
                runs.append(Run(seed, f"{seed}.exr", run["passes"], run["wall_s"], run["cpu_s"], log["build_s"], run["started"]))
            return runs
