"""Runs methods on the suite, each into a submission of its own."""
from __future__ import annotations

import json
import os
import platform
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any, Callable, Dict, List

from .. import cluster
from .adapter import RESERVE, Adapter, Job, Pilot, Run, load_adapter
from .problem import BenchmarkError, hint, key_problems, read_json
from .references import command
from .submission import MANIFEST, time_text, write_manifest
from .suite import FORMAT, Scene, Suite

_METHOD = {"name": (str,), "program": (str,), "kind": (str,), "noise": (str,), "unbiased": (bool,)}
YARDSTICK = ["--integrator", "path", "-D", "film.width=128", "-D", "film.height=128", "--passes", "32", "--seed", "1"]
AGAIN = 4      # attempts to fit a budget
EARLY = 0.6    # of a budget: pictures that take less are rendered with more passes


def read_methods(file: Path, names: List[str]) -> List[Dict[str, Any]]:
    """Those of methods.json that are named, else all. Raises BenchmarkError."""
    methods = read_json(file)
    lines = [line for i, m in enumerate(methods) for line in key_problems(f"{file}: method {i + 1}", m, _METHOD, {"settings": (dict,)})]
    known = [m.get("name") for m in methods]
    lines = lines or [f"{file}: no method '{name}'{hint(name, known)}" for name in names if name not in known]
    if lines:
        raise BenchmarkError(*lines)
    return [m for m in methods if not names or m["name"] in names]


def folder_name(method: str) -> str:
    return "".join(c if c.isalnum() else "_" for c in method)


def machine(threads: int) -> Dict[str, Any]:
    processor = platform.processor() or platform.machine()
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                processor = line.split(":", 1)[1].strip()
                break
    except OSError:
        pass
    return {"processor": processor, "threads": threads, "system": f"{platform.system()} {platform.release()}"}


def yardstick(suite: Suite, threads: int, times: int = 5) -> List[float]:
    """Seconds of renders that are the same everywhere, so that machines can be compared."""
    scene, seconds = suite.scenes[0], []
    with tempfile.TemporaryDirectory(prefix="mote_") as folder:
        for _ in range(times):
            stats = Path(folder) / "stats.json"
            cluster.run_mote(command(), ["render", str(scene.file), *YARDSTICK, "--threads", str(threads), "--quiet", "-o",
                                         str(Path(folder) / "yardstick.exr"), "--stats", str(stats)])
            seconds.append(round(json.loads(stats.read_text())["seconds"]["render"], 4))
    return seconds


def next_passes(passes: int, longest: float, budget: float) -> int:
    """Passes of the next attempt; the same where this one fits: in time, and not much too early."""
    if longest > budget:
        return max(1, min(passes - 1, int(passes * 0.9 * budget / longest)))
    return max(passes, int(passes * RESERVE * budget / longest)) if longest < EARLY * budget else passes


def _pictures(adapter: Adapter, job: Job, passes: int, budget: float) -> List[Run]:
    """Pictures that fit the budget; after AGAIN attempts the last ones, late or not."""
    runs: List[Run] = []
    for _ in range(AGAIN):
        runs = adapter.render(job._replace(passes=passes))
        wanted = next_passes(passes, max(r.wall_s for r in runs), budget)
        if wanted == passes:
            break
        passes = wanted
    return runs


def run_scene(adapter: Adapter, scene: Scene, suite: Suite, method: Dict[str, Any], folder: Path, threads: int, content: Dict[str, Any],
              say: Callable[[str], None]) -> None:
    """Adds the pictures of a scene to the manifest, or why there are none."""
    reason = scene.missing() or adapter.unsupported(scene, method.get("settings", {}))
    if reason:
        content["left_out"].append({"scene": scene.name, "reason": reason})
        say(f"{method['name']}: {scene.name}: left out: {reason}")
        return
    job = Job(scene, method.get("settings", {}), 1, suite.seeds_of(scene), threads, folder / scene.name)
    job.folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="mote_") as scratch:
        pilot = Pilot(adapter, job._replace(folder=Path(scratch)))
        for budget in scene.budgets:
            passes = pilot.fit(budget)
            if not passes:
                content["left_out"].append({"scene": scene.name, "budget_s": budget, "reason": f"one pass takes {pilot.seconds:.1f} s"})
                say(f"{method['name']}: {scene.name}: one pass takes longer than {budget:g} s")
                continue
            place = job.folder / f"{budget:g}s"
            place.mkdir(exist_ok=True)
            runs = _pictures(adapter, job._replace(folder=place), passes, budget)
            content["pictures"] += [{"scene": scene.name, "budget_s": budget, "seed": r.seed, "file": f"{scene.name}/{budget:g}s/{r.file}",
                                     "passes": r.passes, "wall_s": round(r.wall_s, 4), "cpu_s": round(r.cpu_s, 4),
                                     "load_s": round(r.load_s, 4), "started": time_text(r.started)} for r in runs]
            say(f"{method['name']}: {scene.name}: {runs[0].passes} passes in {max(r.wall_s for r in runs):.2f} of {budget:g} s")


def run_method(suite: Suite, method: Dict[str, Any], scenes: List[Scene], output: Path, threads: int, fresh: bool,
               say: Callable[[str], None], stick: List[float]) -> bool:
    """One submission; False where its program is not here. Scenes that are in its manifest are not rendered again."""
    adapter = load_adapter(suite.file.parent / "adapters", method["program"])
    if adapter.missing():
        say(f"{method['name']}: left out: {adapter.missing()}")
        return False
    folder = output / folder_name(method["name"])
    folder.mkdir(parents=True, exist_ok=True)
    content = {"format": FORMAT, "suite": suite.label(), "method": method["name"], "program": method["program"],
               "version": adapter.version(), "settings": method.get("settings", {}), "kind": method["kind"], "noise": method["noise"],
               "unbiased": method["unbiased"], "repeatable": adapter.repeatable, "machine": machine(threads), "yardstick_s": stick,
               "pictures": [], "left_out": [], "notes": []}
    before = read_json(folder / MANIFEST) if (folder / MANIFEST).is_file() and not fresh else {}
    same = ("suite", "program", "version", "settings", "kind", "noise", "machine")
    if all(before.get(key) == content[key] for key in same):
        content = before
    done = {p["scene"] for p in content["pictures"] + content["left_out"]}
    for scene in suite.scenes:
        if scene.name in done and not (scene in scenes and fresh):
            continue
        if scene not in scenes:
            content["left_out"].append({"scene": scene.name, "reason": "not in this run"})
            continue
        try:
            run_scene(adapter, scene, suite, method, folder, threads, content, say)
        except (RuntimeError, OSError, ValueError, subprocess.SubprocessError) as problem:  # the others are to run all night
            lines = str(problem).strip().splitlines() or ["failed"]
            content["pictures"] = [p for p in content["pictures"] if p["scene"] != scene.name]
            content["left_out"].append({"scene": scene.name, "reason": lines[-1]})
            say(f"{method['name']}: {scene.name}: failed: {lines[-1]}")
        content["notes"] = sorted({*content["notes"], *adapter.notes()})
        write_manifest(folder, content)
    write_manifest(folder, content)
    return True


def run(suite: Suite, methods: List[Dict[str, Any]], scenes: List[Scene], output: Path, threads: int, fresh: bool,
        say: Callable[[str], None]) -> List[Path]:
    """The folders of the submissions."""
    threads, start = threads or os.cpu_count() or 1, time.time()
    stick = yardstick(suite, threads)
    folders = [output / folder_name(m["name"]) for m in methods if run_method(suite, m, scenes, output, threads, fresh, say, stick)]
    say(f"{len(folders)} of {len(methods)} methods in {time.time() - start:.0f} s")
    return folders
