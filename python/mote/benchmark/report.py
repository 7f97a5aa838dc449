"""Tables of scores: text for the terminal, CSV and JSON for programs."""
from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Sequence

from .checks import Finding
from .ranks import Rank, rank
from .scoring import Score, model_difference, time_to
from .submission import Submission
from .suite import Suite

COLUMNS = ("method", "scene", "budget_s", "region", "error", "error_low", "error_high", "bias", "bias_low", "bias_high", "systematic",
           "systematic_se", "seconds", "late")
MARKS = {"measured": "", "below": "≤ ", "extrapolated": "≈ "}


class Judged(NamedTuple):
    """One submission with all that was found. refused: it has no rank."""
    submission: Submission
    scores: List[Score]
    findings: List[Finding]

    @property
    def refused(self) -> bool:
        return bool(self.findings)


def group(submission: Submission) -> str:
    """Methods are ranked among those of their group: what is denoised apart from what is not."""
    return "denoised" if submission.kind == "denoised" else "raw"


def last_budget(scores: Sequence[Score], scene: str, region: str = "all") -> Score:
    return max((s for s in scores if s.scene == scene and s.region == region), key=lambda s: s.budget)


def scenes_of(judged: Sequence[Judged], suite: Suite) -> List[str]:
    scored = {s.scene for j in judged for s in j.scores}
    return [scene.name for scene in suite.scenes if scene.name in scored]


def ranks(judged: Sequence[Judged], suite: Suite) -> Dict[str, List[Rank]]:
    """By group, at the largest budget of each scene."""
    found = {}
    for name in ("raw", "denoised"):
        of = [j for j in judged if group(j.submission) == name and not j.refused]
        found[name] = rank({j.submission.method: {scene: last_budget(j.scores, scene).squares for scene in scenes_of(judged, suite)}
                            for j in of})
    return {name: of for name, of in found.items() if of}


def percent(value: float, low: float, high: float, sign: str = "") -> str:
    if not math.isfinite(value):
        return "-"
    return f"{100 * value:{sign}.2f} ({100 * low:{sign}.2f} to {100 * high:{sign}.2f}) %"


def seconds_text(target: float, scores: Sequence[Score], unbiased: bool) -> str:
    value, how = time_to(target, scores, unbiased)
    return how if how not in MARKS else f"{MARKS[how]}{value:.2g}" if value < 100 else f"{MARKS[how]}{value:.0f}"


def scene_rows(judged: Judged, scene: str, suite: Suite) -> List[List[str]]:
    """A row for each budget: method, seconds, error, bias, systematic error, errors by region, seconds to the targets."""
    rows = []
    own = [s for s in judged.scores if s.scene == scene]
    whole = [s for s in own if s.region == "all"]
    for score in whole:
        regions = [s for s in own if s.budget == score.budget and s.region != "all"]
        late = f"{score.late} late" if score.late else "no picture"
        rows.append([judged.submission.method, f"{score.budget:g}", late if score.failed else f"{score.seconds:.2f}", percent(*score.error),
                     percent(*score.bias, sign="+"),
                     "-" if score.failed else f"{100 * score.systematic[0]:.2f} ± {100 * score.systematic[1]:.2f} %",
                     ", ".join(f"{s.region} {100 * s.error.value:.1f}" for s in regions if not s.failed) or "-",
                     "; ".join(f"{100 * t:g} %: {seconds_text(t, whole, judged.submission.unbiased)}" for t in suite.targets)])
    return rows


SCENE_HEAD = ["method", "budget [s]", "seconds", "error (95 %)", "bias (95 %)", "systematic", "error by region [%]", "seconds to"]
RANK_HEAD = ["method", "mean rank (95 %)", "worst scene, times the least error", "failures", "probability of a better rank than"]


def rank_rows(found: Sequence[Rank]) -> List[List[str]]:
    rows = []
    for r in found:
        times = "failed" if math.isinf(r.worst[1]) else f"{r.worst[1]:.2f}"
        rows.append([r.method, f"{r.rank:.2f} ({r.low:.2f} to {r.high:.2f})", f"{r.worst[0]}: {times}", ", ".join(r.failures) or "none",
                     ", ".join(f"{other} {p:.2f}" for other, p in r.better.items()) or "-"])
    return rows


def models(judged: Sequence[Judged], scene: str) -> List[str]:
    """Differences of models, program by program: what its raw, unbiased method shares over all seeds."""
    lines = []
    for j in judged:
        difference = model_difference(j.submission, j.scores, scene)
        if difference:
            lines.append(f"{j.submission.program}: all seeds of {j.submission.method} share {100 * difference:.2f} %, which time does not "
                         "reduce: its scene or its models differ, or the method is biased; contained in the errors of all methods of that program")
    return lines


def text_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows]) + "\n"


def text(judged: Sequence[Judged], suite: Suite) -> str:
    parts = []
    for name, of in ranks(judged, suite).items():
        parts += [f"{name}: ranks over {len(scenes_of(judged, suite))} scenes at the largest budget", text_table(RANK_HEAD, rank_rows(of))]
    for scene in scenes_of(judged, suite):
        parts += [suite.scene(scene).title, text_table(SCENE_HEAD, [row for j in judged for row in scene_rows(j, scene, suite)])]
        parts += models(judged, scene)
    for j in judged:
        parts += [f"{j.submission.method}: REFUSED: {f.scene + ': ' * bool(f.scene)}{f.check}: {f.text}" for f in j.findings]
    return "\n".join(parts) + "\n"


def write_files(folder: Path, judged: Sequence[Judged], suite: Suite, facts: Dict[str, Any]) -> None:
    """scores.csv, scores.json and scores.md in the folder."""
    with open(folder / "scores.csv", "w", newline="", encoding="utf-8") as file:
        for key, value in facts.items():
            file.write(f"# {key}: {value}\n")
        table = csv.writer(file)
        table.writerow(COLUMNS)
        for j in judged:
            for s in j.scores:
                numbers = [*s.error, *s.bias, *s.systematic, s.seconds]
                table.writerow([j.submission.method, s.scene, f"{s.budget:g}", s.region, *(f"{v:.6g}" for v in numbers), s.late])
    (folder / "scores.md").write_text(text(judged, suite), encoding="utf-8")
    summary = {"facts": facts, "ranks": {name: [r._asdict() for r in of] for name, of in ranks(judged, suite).items()},
               "refused": {j.submission.method: [f._asdict() for f in j.findings] for j in judged if j.refused}}
    finite = json.dumps(summary, indent=1, default=str).replace("Infinity", "null")
    (folder / "scores.json").write_text(finite + "\n", encoding="utf-8")
