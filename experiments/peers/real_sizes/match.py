"""Do the peers render the same scene? Their mean radiance against that of our path tracer, at low resolution.

Every program renders some pictures with seeds of their own, and the standard errors come from their spread. What is no
noise by pixels is seen in the column `pattern`: the systematic error of the halves of one against those of the other
(figures/measure.py).
"""
import csv
from pathlib import Path

import numpy as np
from measure import series_error
from mote_runs import Mote
from peer_runs import export, pictures, run_peer

ROOT = Path(__file__).resolve().parent.parent.parent.parent
HEAD = ("scene", "renderer", "mote", "peer", "difference", "standard error", "pattern", "its standard error")


def mean_and_error(shown):
    means = np.array([picture.mean() for picture in shown])
    return means.mean(), means.std(ddof=1) / len(means)**0.5


def pattern(ours, theirs):
    """Systematic difference of the mean images over all pixels, relative to ours: (value, standard error)."""
    halves = lambda shown: (np.mean(shown[::2], axis=0), np.mean(shown[1::2], axis=0))
    found = series_error(halves(theirs), halves(ours))
    return found["systematic"], found["systematic_standard_error"]


def match(program, names, settings, output):
    """Prints a table, which output/match.csv holds too; returns an exit code."""
    s, rows = settings["match"], []
    sizes = [f"resx={s['width']}", f"resy={s['height']}", "film.rfilter=box"]
    print("| " + " | ".join(HEAD) + " |\n|" + "---|" * len(HEAD), flush=True)
    for name in names:
        scene, folder = settings["scenes"][name], output / name
        mote = Mote(program, ROOT / "scenes" / f"{name}.xml", sizes, settings["threads"])
        method = {"integrator": scene["integrator"], "settings": scene.get("settings", {})}
        ours = list(pictures(folder / "mote", mote.run(method, folder / "mote", [s["ours"]] * s["pictures"], 1)))
        export(mote, scene["integrator"], folder / "exported")
        for raw in (peer for peer in settings["peers"] if not peer["denoise"]):
            peer = raw["program"]
            log = run_peer(raw, mote, {**settings, "cycles": {**settings["cycles"], "filter": "box"}}, folder / "exported",
                           folder / peer, [s["theirs"]] * s["pictures"], 1000)
            if log is None:
                print(f"{peer} is not installed: left out")
                continue
            theirs = list(pictures(folder / peer, log))
            (m, m_error), (p, p_error) = mean_and_error(ours), mean_and_error(theirs)
            error, (structure, its_error) = np.hypot(m_error, p_error), pattern(ours, theirs)
            rows.append([name, peer, m, p, p / m - 1, error / m, structure, its_error])
            print(f"| {name} | {peer} | {m:.5g} | {p:.5g} | {100 * (p / m - 1):+.2f} % | {100 * error / m:.2f} % | "
                  f"{100 * structure:.1f} % | {100 * its_error:.1f} % |", flush=True)
    with open(output / "match.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([HEAD, *rows])
    return 0
