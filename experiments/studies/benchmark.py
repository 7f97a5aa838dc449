#!/usr/bin/python3
"""Plot and table of the benchmark's scores: error at the largest budget, scene by scene, and mean ranks.

    benchmark/generate; python -m mote.benchmark references; python -m mote.benchmark run; python -m mote.benchmark score out/benchmark/*/
    experiments/studies/benchmark.py [--scores out/benchmark/scores] [--output docs/gallery] [--quick]

Exit code 1 where a submission was refused.
--quick: of the scores of small pictures.
"""
import argparse
import csv
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "experiments/figures"))
import plotting
from origin import Origin, tables_of


def largest_budgets(rows):
    """Scores of whole pictures at the largest budget of each scene that has one, by scene and method."""
    found = {}
    for row in rows:
        if row["region"] == "all" and isinstance(row["error"], float) and row["error"] == row["error"]:
            key = (row["scene"], row["method"])
            found[key] = max(found.get(key, row), row, key=lambda r: r["budget_s"])
    return found


def colour(method):
    """As in other plots, where some leave the program's name out."""
    return plotting.colour(method if method in plotting.COLOURS else method.removeprefix("mote "))


def plot(scores, path):
    """A row for each scene, a dot with its interval for each method."""
    suite = json.loads((ROOT / "benchmark/suite.json").read_text(encoding="utf-8"))
    scored = {scene for scene, _ in scores}
    scenes = [s["name"] for s in suite["scenes"] if s["name"] in scored]
    methods = list(dict.fromkeys(method for _, method in scores))
    made, axes, height_of = plotting.scene_rows(scenes, f"{plotting.RMSE} at the largest budget; diamonds: denoised", 760, (1,))
    for i, method in enumerate(methods):
        rows = [(height_of(scene, (i + 0.5) / len(methods)), r) for (scene, m), r in scores.items() if m == method]
        y, x = [y for y, _ in rows], [r["error"] for _, r in rows]
        spread = [[r["error"] - r["error_low"] for _, r in rows], [r["error_high"] - r["error"] for _, r in rows]]
        denoised = "OIDN" in method or method == "mote layers"
        axes.errorbar(x, y, xerr=spread, fmt="D" if denoised else "o", ms=5, lw=1.2, color=colour(method), label=method)
    plotting.legend_above(axes)
    plotting.save(made, path)


def write(scores, summary, origin, folder):
    folder.mkdir(parents=True, exist_ok=True)
    table, picture = folder / "benchmark.csv", folder / "benchmark.png"
    numbers = ("error", "error_low", "error_high", "bias", "systematic", "systematic_se", "seconds")
    with open(table, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["scene", "method", *numbers])
        writer.writerows([scene, method, *(f"{row[n]:.5g}" for n in numbers)] for (scene, method), row in scores.items())
        writer.writerow(["group", "ranked", "rank", "low", "high", "failures"])
        for group, ranks in summary["ranks"].items():
            writer.writerows([group, r["method"], f"{r['rank']:.2f}", f"{r['low']:.2f}", f"{r['high']:.2f}", len(r["failures"])] for r in ranks)
    plot(scores, picture)
    origin.stamp(picture, table)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scores", type=Path, help="folder that the command score wrote")
    parser.add_argument("--output", type=Path, help="folder of the table and of the plot")
    parser.add_argument("--quick", action="store_true", help="the scores are those of small pictures")
    args = parser.parse_args()
    args.scores = args.scores or ROOT / ("out/benchmark_quick/scores" if args.quick else "out/benchmark/scores")
    summary = json.loads((args.scores / "scores.json").read_text(encoding="utf-8"))
    scores = largest_budgets(tables_of(args.scores / "scores.csv")[0])
    for group, ranks in summary["ranks"].items():
        for r in ranks:
            print(f"{group:10} {r['method']:26} rank {r['rank']:.2f} ({r['low']:.2f} to {r['high']:.2f}), failures: {', '.join(r['failures']) or 'none'}")
    if args.output:
        write(scores, summary, Origin(__file__, args.quick), args.output)
    return int(bool(summary["refused"]))


if __name__ == "__main__":
    sys.exit(main())
