#!/usr/bin/env python3
"""A scene of Blender rendered by Cycles and by mote: means with standard errors, and processor time to equal error.

    python3 experiments/studies/blender_agreement.py MOTE [SAMPLES [SEEDS [BPY_PYTHON]]] [--quick]

Each engine renders SEEDS pictures of SAMPLES samples a pixel. The standard error is that of the mean over seeds. Time
to equal error: variance of a pixel between seeds, averaged over the picture, times processor seconds a picture (export and
loading included); the ratio is Cycles' over mote's. It falls with SAMPLES for mote, whose process starts and loads anew for
every picture. With BPY_PYTHON, a Python that has the module bpy, it renders there instead of in `blender`.
experiments/figures/blender_cycles.py draws the pictures.
"""
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from blender_runs import agreement, blender, run  # noqa: E402

WIDTH = 64


def main():
    given = [argument for argument in sys.argv[1:] if argument != "--quick"]
    usual = ("4", "2", "") if len(given) < len(sys.argv) - 1 else ("64", "8", "")
    mote, samples, seeds, python = [*given, *usual[len(given) - 1:]]
    with tempfile.TemporaryDirectory() as name:
        found = run(blender(python), mote, Path(name), WIDTH, samples, seeds)
    print("| scene | Cycles | mote | difference | standard error | processor s | time to equal error |\n" + "|---" * 7 + "|")
    for scene, log in found.items():
        a = agreement(log)
        print(f"| {scene} | {a['cycles_mean']:.5f} | {a['mote_mean']:.5f} | {a['difference']:+.2%} | {a['standard_error']:.2%} "
              f"| {a['cycles_seconds']:.2f}, {a['mote_seconds']:.2f} | {a['equal_error']:.2f} |")
    print("\n".join(f"{scene}: {line}" for scene, log in found.items() for line in log["notes"]))


main()
