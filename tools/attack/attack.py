"""The attack on one scene: every registered integrator renders it, and is compared with the reference."""
import copy
import importlib
import math
import subprocess
from dataclasses import asdict, dataclass

import numpy as np

from methods import REFERENCE
from runner import Outcome
from verdict import CONTINUE, LIE, STAGES, STAYS, STAYS_WHOLE, compare_means, noise_lies, regions, threshold

MORE_PASSES, MORE_SEEDS = 4, 8  # of the renders that separate a bias from a tail
KERNEL_PASSES = 64  # times the passes, for methods whose kernels shrink
SECOND, SECOND_PASSES, SECOND_WITHIN = "mote_bdpt", 64, 0.5  # where the reference is black: times its passes, and how far a mean may be off
COMMAND_EVERY = 10  # scenes: the command takes longer to start than most of them to render


@dataclass
class Finding:
    scene: str
    integrator: str
    what: str  # signal, time, memory, fault, not_finite, negative, refusal, command, mean, noise
    text: str
    known: str = ""  # reason, where docs/robustness.md lists it

    def line(self):
        known = f" [known: {self.known}]" if self.known else ""
        return f"scene {self.scene} {self.integrator} {self.what}: {self.text}{known}"


@dataclass
class Allowance:
    """Processor time [s] that a pair, and a scene as a whole, may take; what is left is that of the scene."""
    pair: float = math.inf
    left: float = math.inf

    def spend(self, seconds):
        self.left -= seconds


class Series:
    """Renders of one integrator with seeds from `first` on; more on demand."""

    def __init__(self, runner, scene, integrator, method, first, allowance):
        self.runner, self.scene, self.integrator, self.method, self.first = runner, scene, integrator, method, first
        self.allowance, self.processor = allowance, 0.0
        self.pictures, self.noises, self.broken, self.seconds, self.wrong = [], [], None, 0.0, {}

    def at_least(self, count):
        """None where there are now so many; else the outcome that is no picture."""
        if self.broken is None and len(self.pictures) < count:
            seeds = range(self.first + len(self.pictures), self.first + count)
            left = min(self.allowance.pair - self.processor, self.allowance.left)
            if left <= 0.0:
                self.broken = Outcome("unfinished", "no processor time is left")
                return self.broken
            outcome = self.runner.render(self.scene, self.integrator, self.method, seeds, left)
            self.processor += outcome.processor
            self.allowance.spend(outcome.processor)
            self.pictures += [np.load(path) for path in outcome.pictures]
            self.noises += outcome.noises
            self.seconds, self.wrong = max(self.seconds, outcome.seconds), {**self.wrong, **outcome.wrong}
            if outcome.kind != "rendered":
                self.broken = outcome
        return self.broken if len(self.pictures) < count else None


class Attack:
    def __init__(self, runner, methods, pairs, stages=STAGES, mote=None, allowance=Allowance()):
        self.runner, self.methods, self.pairs, self.stages, self.mote = runner, methods, pairs, stages, mote
        self.allowance = allowance

    def series(self, scene, name, first, allowance=None, **changes):
        method = copy.copy(self.methods[name])
        for key, value in changes.items():
            setattr(method, key, value)
        return Series(self.runner, scene, name, method, first, allowance or Allowance())

    def scene(self, scene, names, turn=0):
        """The record of a scene: findings, refusals, and what each integrator took. `turn` says which integrator comes first where not all may finish."""
        record = {"scene": scene.name, "facts": scene.facts, "findings": [], "refused": {}, "seconds": {}, "compared": [],
                  "unfinished": [], "tails": [], "blind": []}
        allowance = copy.copy(self.allowance)
        reference = self.series(scene, REFERENCE, 1, allowance)
        others = [n for n in names if n != REFERENCE]
        start = turn % max(1, len(others))
        for name in [REFERENCE, *others[start:], *others[:start]]:
            series = reference if name == REFERENCE else self.series(scene, name, 1001, allowance)
            findings = self.integrator(scene, name, series, reference, record)
            record["findings"] += [asdict(f) for f in findings]
            record["seconds"][name] = round(series.seconds, 3)
        record["processor"] = round(self.allowance.left - allowance.left, 2) if math.isfinite(allowance.left) else None
        if turn % COMMAND_EVERY == 0:
            record["findings"] += [asdict(f) for f in self.command(scene, reference)]
        return record

    def integrator(self, scene, name, series, reference, record):
        find = lambda what, text: Finding(scene.name, name, what, text)
        compared = len(reference.pictures) >= self.stages[0] or name == REFERENCE
        broken = series.at_least(self.stages[0] if compared else 1)
        if broken and broken.kind == "refused":
            record["refused"][name] = broken.text
            return []
        if broken and broken.kind == "unfinished":
            record["unfinished"].append(name)
        elif broken:
            return [find(broken.kind, broken.text)]
        found = self.light(scene, name, series, reference, record, find) if not broken else []
        return [*(find(kind, text) for kind, text in series.wrong.items()), *found]

    def light(self, scene, name, series, reference, record, find):
        """What is wrong with means and stated noise."""
        if "not_finite" in series.wrong | reference.wrong:
            return []
        if name == REFERENCE:
            return self.stated_noise(find, series)
        if reference.broken and len(reference.pictures) < self.stages[0]:
            same = reference.broken.kind != "refused"
            return [] if same else [find("refusal", f"rendered; {REFERENCE} refuses: {reference.broken.text}")]
        media = "<medium" in scene.path.read_text()
        if {name, REFERENCE} & set(scene.watched) or (media and not self.methods[name].sees_media):
            return []
        cells = self.methods[name].cells
        if not cells and not self.methods[name].takes_depth and scene.facts.get("max_depth", -1) > 0:
            return self.stated_noise(find, series)  # the reference's paths end, this one's do not
        ours = reference if not cells else self.series(scene, REFERENCE, 1, reference.allowance, cells=cells)
        return self.means(find, series, ours, record) + self.stated_noise(find, series)

    def means(self, find, series, reference, record):
        """The sequential test of means, and what more passes say of a difference."""
        for stage, seeds in enumerate(self.stages):
            broken = series.at_least(seeds) or reference.at_least(seeds)
            if broken:
                record["unfinished"].append(f"{series.integrator} at {seeds} seeds")
                return [] if broken.kind == "unfinished" else [find(broken.kind, f"at {seeds} seeds: {broken.text}")]
            if stage == 0:
                record["compared"].append(series.integrator)
            difference = compare_means(series.pictures[:seeds], reference.pictures[:seeds], series.method.bias)
            if difference.p < threshold(stage, self.pairs):
                stays, after, pictures = self.with_more_passes(series, reference, difference)
                if stays:
                    second = self.second_opinion(series, reference, difference, pictures)
                    if second:
                        record["blind"].append(f"{series.integrator}: {difference.text}, {second}")
                        return []
                    return [find("mean", f"{difference.text}, {after}{self.unknown_noise(series)}")]
                record["tails"].append(f"{series.integrator}: {difference.text}, {after}")
                return []
            if difference.p > CONTINUE:
                break
        return []

    @staticmethod
    def unknown_noise(series):
        """A difference that the method announces: it states no noise, and its plan says why."""
        return ", its noise is unknown" if all(n is None for n in series.noises) else ""

    def with_more_passes(self, series, reference, difference):
        """(True, text, pictures) where a difference stays with more passes and other seeds: a bias does; a tail moves, or shows in the spread; a
        kernel shrinks."""
        factors = (MORE_PASSES, KERNEL_PASSES) if series.method.shrinks else (MORE_PASSES,)
        texts = []
        for factor in factors:
            longer = [self.series(s.scene, s.integrator, s.first + 5000, cells=s.method.cells, passes=factor * s.method.passes)
                      for s in (series, reference)]
            if any(s.at_least(MORE_SEEDS) for s in longer):
                return True, "unclear: longer renders did not end", []
            after = compare_means(longer[0].pictures, longer[1].pictures, series.method.bias, difference.region)
            stays = after.p < STAYS and after.absolute / difference.absolute > STAYS_WHOLE
            texts.append(f"{'stays' if stays else 'moves'} with {factor} times the passes: {100 * after.relative:+.3g} %, p {after.p:.2g}")
            if not stays:
                break
        return stays, ", ".join(texts), longer[0].pictures

    def second_opinion(self, series, reference, difference, pictures):
        """What SECOND says, where most renders of the reference are black in the region and SECOND agrees with `pictures`; else ""."""
        lit = sum(regions(p)[difference.region] > 0.0 for p in reference.pictures)
        if 2 * lit > len(reference.pictures) or series.integrator == SECOND or not pictures:
            return ""
        second = self.series(series.scene, SECOND, series.first + 7000, cells=series.method.cells,
                             passes=SECOND_PASSES * self.methods[SECOND].passes)
        if second.at_least(MORE_SEEDS):
            return ""
        after = compare_means(pictures, second.pictures, series.method.bias, difference.region)
        agrees = after.p >= STAYS and abs(after.relative) < SECOND_WITHIN
        return f"{SECOND} agrees: {after.text}" if agrees else ""

    def stated_noise(self, find, series):
        """The spread between seeds against what each picture states."""
        for seeds in (n for n in self.stages if n in LIE):
            if series.at_least(seeds):
                return []
            lie = noise_lies(series.pictures[:seeds], series.noises[:seeds])
            if lie is None or lie[0] < min(LIE.values()):
                return []
            if lie[0] > LIE[seeds]:
                return [find("noise", lie[1])]
        return []

    def command(self, scene, reference):
        """`mote render` has the bits of the Python module, or its refusal."""
        if not self.mote or (reference.broken and reference.broken.kind != "refused"):
            return []
        picture = self.runner.folder / "command.exr"
        run = subprocess.run([self.mote, "render", scene.path, "--integrator", REFERENCE, "--passes", str(reference.method.passes),
                              "--seed", str(reference.first), "-t", "1", "-o", picture, "--quiet", *(f"-D{k}={v}" for k, v in scene.define.items())],
                             capture_output=True, text=True, errors="replace", check=False)
        find = lambda text: [Finding(scene.name, REFERENCE, "command", text)]
        if run.returncode != (1 if reference.broken else 0):
            return find(f"exit code {run.returncode}: {run.stderr.strip()[-300:]}")
        if reference.broken:
            return [] if run.stderr.startswith("mote: ") or ".xml:" in run.stderr else find(f"no sentence: {run.stderr[:300]}")
        image = importlib.import_module("mote").Picture.load(picture)["beauty"]
        return [] if np.array_equal(image, reference.pictures[0]) else find("other bits than the Python module's")
