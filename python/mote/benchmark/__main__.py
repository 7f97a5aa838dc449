"""python -m mote.benchmark: scenes, references, run, score, verify.

Exit codes as those of mote: 0 done, 1 the input is at fault or a submission is refused, 2 wrong usage.
"""
from __future__ import annotations

import argparse
import json
import secrets
import sys
from pathlib import Path
from typing import Dict, List

from .. import cluster
from . import references as made
from .adapter import load_adapter
from .checks import check_scene, significant
from .page import write_page
from .problem import BenchmarkError
from .report import Judged, text, write_files
from .running import read_methods, run, yardstick
from .scoring import all_scores
from .submission import Submission, read_submission
from .suite import Suite, load_suite
from .verify import judge, render_sample

HERE = Path(__file__).resolve()
# In the source tree and in a build of it; an installed package needs --suite.
USUAL = next((p / "benchmark" for p in HERE.parents if (p / "benchmark" / "suite.json").is_file()), Path("benchmark"))


def say(line: str) -> None:
    print(f"mote: {line}", file=sys.stderr, flush=True)


def scenes_command(suite: Suite, options: argparse.Namespace) -> int:
    for s in suite.chosen(options.scenes):
        budgets = " and ".join(f"{b:g}" for b in s.budgets)
        print(f"{s.name}: {s.tests}\n    {s.width} x {s.height} pixels, {budgets} s, seeds {suite.seeds_of(s)[0]} to "
              f"{suite.seeds_of(s)[-1]}; licence: {s.licence}" + f"; {s.origin}" * bool(s.origin)
              + f"\n    {s.missing()}" * bool(s.missing()))
    return 0


def references_command(suite: Suite, options: argparse.Namespace) -> int:
    made.make(suite, options.references, suite.chosen(options.scenes), options.scheduler, options.threads, options.hidden, say)
    print(options.references / made.LOG)
    return 0


def run_command(suite: Suite, options: argparse.Namespace) -> int:
    methods = read_methods(options.methods_file or suite.file.parent / "methods.json", options.methods)
    for folder in run(suite, methods, suite.chosen(options.scene or []), options.output, options.threads, options.fresh, say):
        print(folder)
    return 0


def load_references(suite: Suite, folder: Path, submissions: List[Submission]) -> Dict[str, made.References]:
    """Those of the scenes that a submission has pictures of."""
    wanted = {e.scene for s in submissions for e in s.entries}
    return {scene.name: made.load(folder, scene) for scene in suite.scenes if scene.name in wanted}


def judged_one(submission: Submission, suite: Suite, references: Dict[str, made.References]) -> Judged:
    certain, tested = [], []
    for scene in suite.scenes:
        if scene.name in references:
            more = check_scene(submission, scene, references[scene.name])
            certain += more[0]
            tested += more[1]
    return Judged(submission, all_scores(submission, suite, references), certain + significant(tested))


def score_command(suite: Suite, options: argparse.Namespace) -> int:
    submissions = [read_submission(folder, suite) for folder in options.folders]
    names = [s.method for s in submissions]
    if len(set(names)) < len(names):
        raise BenchmarkError(f"{options.folders[0]}: two submissions have a method of the same name")
    references = load_references(suite, options.references, submissions)
    log = options.references / made.LOG
    known = json.loads(log.read_text(encoding="utf-8"))["scenes"] if log.is_file() else {}
    noise = {scene: known.get(scene, {}).get("noise") or made.noise_by_region(r) for scene, r in references.items()}
    judged = [judged_one(s, suite, references) for s in submissions]
    hidden = sum(r.hidden is not None for r in references.values())
    facts = {"Suite": suite.label(), "Command": "python -m mote.benchmark score",
             "References": f"{len(references)} scenes, {hidden} of them with a hidden pair"}
    options.output.mkdir(parents=True, exist_ok=True)
    write_files(options.output, judged, suite, facts)
    write_page(options.output / "benchmark.html", judged, suite, references, noise, facts)
    print(text(judged, suite), end="")
    for name in ("scores.md", "scores.csv", "scores.json", "benchmark.html"):
        print(options.output / name)
    return 1 if any(j.refused for j in judged) else 0


def verify_command(suite: Suite, options: argparse.Namespace) -> int:
    submission = read_submission(options.folder, suite)
    adapter = load_adapter(suite.file.parent / "adapters", submission.program)
    if adapter.missing():
        raise BenchmarkError(f"{options.folder}: cannot be verified here: {adapter.missing()}")
    references = load_references(suite, options.references, [submission])
    there = {s.name: [b for b in s.budgets if submission.at(s.name, b)] for s in suite.chosen(options.scenes or list(references))}
    if not any(there.values()):
        raise BenchmarkError(f"{options.folder}: has no picture of these scenes")
    try:
        # The budget is sampled, so that none is safe from being rendered again.
        samples = [render_sample(submission, suite.scene(name), secrets.choice(budgets), adapter)
                   for name, budgets in there.items() if budgets]
    except RuntimeError as problem:
        raise BenchmarkError(f"{options.folder}: {problem}") from None
    found = judge(submission, samples, references, yardstick(suite, submission.machine["threads"]))
    for f in found:
        print(f"{submission.method}: REFUSED: {f.scene + ': ' * bool(f.scene)}{f.check}: {f.text}")
    if not found:
        print(f"{submission.method}: {len(samples)} scenes rendered again: nothing found")
    return 1 if found else 0


def parser() -> argparse.ArgumentParser:
    p = argparse.ArgumentParser(prog="python -m mote.benchmark", description="A benchmark of renderers that others submit to")
    commands = p.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def add(name, function, summary):
        c = commands.add_parser(name, help=summary, description=summary)
        c.set_defaults(run=function)
        c.add_argument("--suite", type=Path, default=USUAL, help="suite.json or its folder (default: that of the source tree)")
        c.add_argument("--quick", action="store_true", help="small pictures and budgets: proves that everything runs")
        c.add_argument("--references", type=Path, help="folder of the references (default: MOTE_BENCHMARK_REFERENCES, or out/benchmark)")
        return c

    add("scenes", scenes_command, "List the scenes, and what each tests").add_argument("scenes", nargs="*")
    c = add("references", references_command, "Render the missing references")
    c.add_argument("scenes", nargs="*")
    c.add_argument("--scheduler", default="", help="address of a Dask scheduler, whose workers render")
    c.add_argument("-t", "--threads", type=int, default=0)
    c.add_argument("--hidden", action="store_true", help="two more with secret seeds, for a judge")
    c = add("run", run_command, "Render submissions by methods of methods.json")
    c.add_argument("methods", nargs="*", metavar="METHOD", help="default: all")
    c.add_argument("--methods-file", type=Path)
    c.add_argument("--scene", action="append", help="only this one (repeatable)")
    c.add_argument("-o", "--output", type=Path, help="folder of the submissions (default: out/benchmark)")
    c.add_argument("-t", "--threads", type=int, default=0, help="default: all cores")
    c.add_argument("--fresh", action="store_true", help="render again what is there")
    c = add("score", score_command, "Score submissions, check them, and write table and page")
    c.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    c.add_argument("-o", "--output", type=Path, help="folder of the page (default: out/benchmark/scores)")
    c = add("verify", verify_command, "Render a submission's pictures again: seeds and times")
    c.add_argument("folder", type=Path, metavar="FOLDER")
    c.add_argument("scenes", nargs="*")
    return p


def main(arguments=None) -> int:
    options = parser().parse_args(arguments)
    try:
        suite = load_suite(options.suite, options.quick)
        options.references = options.references or made.default_folder(suite)
        out = Path("out") / ("benchmark_quick" if options.quick else "benchmark")
        if getattr(options, "output", 0) is None:
            options.output = out / "scores" if options.command == "score" else out
        return options.run(suite, options)
    except (BenchmarkError, cluster.ClusterError) as problem:
        for line in str(problem).splitlines():
            say(line.removeprefix("mote: "))
        return 1
    except OSError as problem:
        say(f"{problem.filename}: {problem.strerror}" if problem.filename else str(problem))
        return 1
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
