"""The attack on one scene: every registered integrator renders it, and is compared with the reference."""
import copy
import importlib
import subprocess
from dataclasses import asdict, dataclass

import numpy as np

from methods import REFERENCE
from verdict import CONTINUE, LIE, STAGES, compare_means, noise_lies, threshold

MORE_PASSES = 4  # of the renders that separate a bias from a tail


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


class Series:
    """Renders of one integrator with seeds from `first` on; more on demand."""

    def __init__(self, runner, scene, integrator, method, first):
        self.runner, self.scene, self.integrator, self.method, self.first = runner, scene, integrator, method, first
        self.pictures, self.noises, self.broken, self.seconds, self.wrong = [], [], None, 0.0, {}

    def at_least(self, count):
        """The outcome that is no picture, or None where there are now so many."""
        if self.broken is None and len(self.pictures) < count:
            seeds = range(self.first + len(self.pictures), self.first + count)
            outcome = self.runner.render(self.scene, self.integrator, self.method, seeds)
            self.pictures += [np.load(path) for path in outcome.pictures]
            self.noises += outcome.noises
            self.seconds, self.wrong = max(self.seconds, outcome.seconds), {**self.wrong, **outcome.wrong}
            if outcome.kind != "rendered":
                self.broken = outcome
        return self.broken


class Attack:
    def __init__(self, runner, methods, pairs, stages=STAGES, mote=None):
        self.runner, self.methods, self.pairs, self.stages, self.mote = runner, methods, pairs, stages, mote

    def series(self, scene, name, first, **changes):
        method = copy.copy(self.methods[name])
        for key, value in changes.items():
            setattr(method, key, value)
        return Series(self.runner, scene, name, method, first)

    def scene(self, scene, names):
        """The record of a scene: findings, refusals, and what each integrator took."""
        record = {"scene": scene.name, "facts": scene.facts, "findings": [], "refused": {}, "seconds": {}, "compared": []}
        reference = self.series(scene, REFERENCE, 1)
        for name in [REFERENCE, *(n for n in names if n != REFERENCE)]:
            series = reference if name == REFERENCE else self.series(scene, name, 1001)
            findings = self.integrator(scene, name, series, reference, record)
            record["findings"] += [asdict(f) for f in findings]
            record["seconds"][name] = round(series.seconds, 3)
        record["findings"] += [asdict(f) for f in self.command(scene, reference)]
        return record

    def integrator(self, scene, name, series, reference, record):
        find = lambda what, text: Finding(scene.name, name, what, text)
        broken = series.at_least(self.stages[0])
        if broken and broken.kind == "refused":
            record["refused"][name] = broken.text
            return []
        if broken:
            return [find(broken.kind, broken.text)]
        found = self.light(scene, name, series, reference, record, find)
        return [*(find(kind, text) for kind, text in series.wrong.items()), *found]

    def light(self, scene, name, series, reference, record, find):
        """What is wrong with means and stated noise."""
        if "not_finite" in series.wrong | reference.wrong:
            return []
        if name == REFERENCE:
            return self.stated_noise(find, series)
        if reference.broken:
            same = reference.broken.kind != "refused"
            return [] if same else [find("refusal", f"rendered; {REFERENCE} refuses: {reference.broken.text}")]
        media = "<medium" in scene.path.read_text()
        if {name, REFERENCE} & set(scene.watched) or (media and not self.methods[name].sees_media):
            return []
        record["compared"].append(name)
        cells = self.methods[name].cells
        ours = reference if not cells else self.series(scene, REFERENCE, 1, cells=cells)
        return self.means(find, series, ours) + self.stated_noise(find, series)

    def means(self, find, series, reference):
        """The sequential test of means, and what more passes say of a difference."""
        for stage, seeds in enumerate(self.stages):
            broken = series.at_least(seeds) or reference.at_least(seeds)
            if broken:
                return [find(broken.kind, f"at {seeds} seeds: {broken.text}")]
            p, text, relative, region = compare_means(series.pictures, reference.pictures, series.method.bias)
            if p < threshold(stage, self.pairs):
                return [find("mean", f"{text}, {self.with_more_passes(series, reference, relative, region)}")]
            if p > CONTINUE:
                break
        return []

    def with_more_passes(self, series, reference, relative, region):
        """A bias stays where passes are added; a tail moves towards the reference, or shows."""
        longer = [self.series(s.scene, s.integrator, s.first + 5000, cells=s.method.cells,
                              passes=MORE_PASSES * s.method.passes) for s in (series, reference)]
        if any(s.at_least(self.stages[0]) for s in longer):
            return "unclear: longer renders did not end"
        after = compare_means(longer[0].pictures, longer[1].pictures, series.method.bias, region)[2]
        if abs(after) < 0.5 * abs(relative):
            return f"moves with {MORE_PASSES} times the passes: {100 * after:+.3g} %"
        return f"stays with {MORE_PASSES} times the passes: {100 * after:+.3g} %"

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
