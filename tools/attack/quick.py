"""The short attack of ./test: planted faults are found, and some scenes are rendered by every integrator."""
import dataclasses
import tempfile
from pathlib import Path

import runner
import scenes
import verdict
from attack import Attack
from axes import dice, sample_axes
from methods import read_methods
from planted import FAULTS
from registry import Registry
from runner import HERE, Runner
from student import two_sided_p

SCENES = [1, 5]  # on surfaces, and with a medium; quick ones
PLANTED_SECONDS, PLANTED_MEMORY = 2.0, 300 << 20  # limits of the test, smaller than those of an attack


def ordinary_axes(_):
    """A closed room without a medium, lit by a panel."""
    return dataclasses.replace(sample_axes(dice(0, 0)), unit=1.0, offset=0.0, shell="closed", media="none", lights=("area",), power=1.0,
                               camera="inside", sensor="perspective", objects=0, oddity="", film=(16, 12), max_depth=3,
                               glow=False, end=False)


def planted_faults(module, folder):
    """What is wrong with the attack: each planted fault must be found, by its name, and nothing else."""
    registry = Registry()
    methods = read_methods(registry.names("integrator"))
    given, scenes.sample_axes = scenes.sample_axes, ordinary_axes
    scene = scenes.write_scene(0, 0, folder, methods, registry)
    scenes.sample_axes = given
    limits = runner.SECONDS, runner.MEMORY
    runner.SECONDS, runner.MEMORY = PLANTED_SECONDS, PLANTED_MEMORY
    worker = Runner(module, folder, HERE / "planted.py")
    names = [*FAULTS, "mote_ray_bundles"]
    record = Attack(worker, methods, len(names)).scene(scene, names)
    worker.stop()
    runner.SECONDS, runner.MEMORY = limits
    found = {f["integrator"]: f["what"] for f in record["findings"]}
    wanted = {name: what for name, (what, _) in FAULTS.items()}
    return [] if found == wanted else [f"planted {wanted}, found {found}: {record['findings']}"]


def levels():
    """Student's distribution at tabulated values, and the sum of the stages' levels."""
    table = ((12.706, 1, 0.05), (2.776, 4, 0.05), (4.587, 10, 0.001), (1.96, 1e7, 0.05))
    wrong = [f"p({t}, {n}) is not {p}" for t, n, p in table if abs(two_sided_p(t, n) / p - 1.0) > 2e-3]
    if sum(verdict.threshold(k, 7) for k in range(len(verdict.STAGES))) * 7 > verdict.FALSE_ALARMS:
        wrong.append("the levels of the stages exceed the level of a run")
    return wrong


def quick(options, campaign):
    """0 where the attack finds what is planted, and nothing else."""
    with tempfile.TemporaryDirectory() as folder:
        wrong = levels() + planted_faults(options.bin.resolve().parent / "python", Path(folder))
        options.folder, options.scene, options.seeds = Path(folder) / "scenes", SCENES, verdict.STAGES[1]
        records = campaign(options)
    wrong += [f"{f['integrator']}: {f['what']} in scene {f['scene']}" for r in records for f in r["findings"] if not f["known"]]
    compared = sum(len(r["compared"]) for r in records)
    if compared < 5 * len(SCENES):
        wrong.append(f"only {compared} means were compared")
    print("\n".join(wrong) if wrong else f"{len(FAULTS)} planted faults found; {len(SCENES)} scenes, {compared} means agree")
    return 1 if wrong else 0
