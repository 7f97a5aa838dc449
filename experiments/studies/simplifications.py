#!/usr/bin/python3
"""Bias of each simplification of approximate compensation: signed, with standard error, one switch at a time.

Every variant differs from exact compensation in one thing (Engelhardt 2013, Sec. 10.2): the recursion ends after 0 to 3
steps, local visibility is left out, the transmittance inside the bounding region is that of the mean extinction; and then
all of them at once, the defaults. Strategies are none of these: they only change the noise, which is shown. The numbers
are of the light that scatters more than once, the last time in the medium, relative to exact compensation with the same
seeds (and so the same virtual point lights).
Scenes: the fog room of vpls_and_media.py, thin and thick, and the smoke room. A full run takes about 15 minutes.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
from claims import Claims
from renders import approximate, compensation, main, mean_and_error, write_csv

FOG = Path(__file__).resolve().parent / "vpls_and_media.xml"
EXACT = {"depth": -1, "strategy": "1-to-n", "local_visibility": True, "transmittance": "exact"}


def without(**switch):
    return compensation("approximate", **{**EXACT, **switch})


VARIANTS = {
    "depth 0": without(depth=0), "depth 1": without(depth=1), "depth 2": without(depth=2), "depth 3": without(depth=3),
    "no local visibility": without(local_visibility=False),
    "mean transmittance": without(transmittance="mean"),
    "n-to-1": without(strategy="n-to-1"), "1-to-1": without(strategy="1-to-1"),
    "1-to-1-homogeneous": without(strategy="1-to-1-homogeneous"),
    "the defaults, 1 step": approximate(1), "the defaults, 2 steps": approximate(2),
}
SCENES = {
    "thin fog": (FOG, {"sigma_t": 0.5, "albedo": 0.9, "paths": 32, "wall": 0.5, "size": 12}, 60),
    "thick fog": (FOG, {"sigma_t": 3, "albedo": 0.9, "paths": 32, "wall": 0.5, "size": 12}, 60),
    "smoke room": ("smoke_room", {"resx": 24, "resy": 15, "paths": 48, "bound": 4}, 40),
}


def run(mote, quick, output):
    rows, worst = [], {}
    seeds = range(1, 7 if quick else 13)
    for scene, (file, settings, passes) in SCENES.items():
        if quick and scene != "thick fog":
            continue
        passes = passes // 4 if quick else passes
        truth = [mote.render(file, f"{scene.replace(' ', '_')}_exact", {**settings, **compensation("exact")}, passes, seed=s)
                 .multiple().mean() for s in seeds]
        scale = sum(truth) / len(truth)
        for variant, switches in VARIANTS.items():
            name = f"{scene}_{variant}".replace(" ", "_").replace(",", "")
            means = [mote.render(file, name, {**settings, **switches}, passes, seed=s).multiple().mean() for s in seeds]
            bias, error = mean_and_error([(m - t) / scale for m, t in zip(means, truth)])
            rows.append([scene, variant, float(bias), float(error)])
            worst[variant] = max(worst.get(variant, 0), abs(bias) / error)
            print(f"{scene:11} {variant:22} {bias:+.2%} +- {error:.2%}", flush=True)
    write_csv(output.with_suffix(".csv"), ["scene", "variant", "bias", "error"], rows)
    claims = Claims()
    for strategy in ("n-to-1", "1-to-1", "1-to-1-homogeneous"):
        claims.check(f"{strategy} has no bias", f"{worst[strategy]:.1f} standard errors at most", worst[strategy] < 5)
    lost = [-r[2] for r in rows if r[0] == "thick fog" and r[1].startswith("depth")]
    claims.check("every step of the recursion brings back more", ", ".join(f"{x:.1%}" for x in lost),
                 all(a > b for a, b in zip(lost, lost[1:])))
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
