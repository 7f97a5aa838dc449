#!/usr/bin/python3
"""In-scattering by integrals against steps, and by shadow maps against shadow rays: error, rays and CPU seconds a pass.

Errors are the relative RMSE (measure.py) of one pass of the light scattered once, against many steps and shadow rays; biases are of means over seeds, with standard error. CPU seconds are what further passes of one thread take: the
difference of two renders, the smallest of three; building trees and maps is not in them. Scenes: a square with lamps in
fog (in_scattering.xml), the shafts of figure 09_10, and the smoke room. A full run takes about 20 minutes.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
import measure
import occluders
from claims import Claims
from renders import ROOT, luminance, main, mean_and_error, write_csv

LAMPS = Path(__file__).resolve().parent / "in_scattering.xml"
SHAFTS = ROOT / "experiments" / "figures" / "scenes" / "shafts.xml"
FULL = {"integrator": "mote_single_scattering"}
STEPS = {"integrator.in_scattering": "steps"}
PASSES = 5


def by_map(size, **settings):
    settings = {"light_size": size, **settings}
    return {"integrator.visibility": "shadow_map", **{f"integrator.visibility.{k}": v for k, v in settings.items()}}


class Study:
    def __init__(self, mote, quick):
        self.mote, self.quick, self.rows = mote, quick, []
        mesh = mote.folder / "sculpture.ply"
        if not mesh.is_file():
            occluders.sculpture(mesh, rows=100 if quick else 200)
        small = {"resx": 64, "resy": 36} if quick else {"resx": 160, "resy": 90}
        self.scenes = {"lamps": (LAMPS, small), "shafts": (SHAFTS, {"mesh": mesh, **small}),
                       "dense shafts": (SHAFTS, {"mesh": mesh, "extinction": 0.6, **small}),
                       "smoke room": ("smoke_room", small)}
        self.truth = {}

    def render(self, scene, name, settings, passes=1, seed=1):
        file, more = self.scenes[scene]
        return self.mote.render(file, f"{scene}_{name}".replace(" ", "_"), {**FULL, **more, **settings}, passes, seed=seed,
                                threads=1)

    def reference(self, scene, seed):
        if (scene, seed) not in self.truth:
            steps = {"steps": 512} if scene == "smoke room" else {"steps": 1024 if self.quick else 2048}
            settings = {**STEPS, **{f"integrator.{k}": v for k, v in steps.items()}}
            self.truth[scene, seed] = self.render(scene, "many_steps", settings, 1, seed)["single_scattering"]
        return self.truth[scene, seed]

    def cpu(self, scene, name, settings):
        """Processor time of one pass [s], without loading and building. Renders differ by seed, as one name and seed are one file."""
        times = [[self.render(scene, f"{name}_{passes}", settings, passes, seed).cpu for seed in range(100, 101 if self.quick else 103)]
                 for passes in (1, 1 + PASSES)]
        return (min(times[1]) - min(times[0])) / PASSES

    def measure(self, scene, name, settings):
        seeds = range(1, 3 if self.quick else 5)
        errors, biases = [], []
        for seed in seeds:
            truth, picture = self.reference(scene, seed), self.render(scene, name, settings, 1, seed)
            light = picture["single_scattering"]
            errors.append(measure.error(light, [truth]))
            biases.append(luminance(light).mean() / luminance(truth).mean() - 1)
        bias, bias_error = mean_and_error(biases)
        row = {"scene": scene, "variant": name, "relative RMSE": float(np.mean(errors)), "bias": float(bias),
               "bias error": float(bias_error), "cpu": self.cpu(scene, name, settings),
               "steps per ray": picture.value("march_steps") / max(1, picture.value("marched_rays")),
               "clear": picture.value("unoccluded_rays") / max(1, picture.value("marched_rays")),
               "build": picture.statistics["seconds"]["build"],
               "megabytes": picture.statistics["values"].get("shadow_map_bytes", 0) * 1e-6}
        self.rows.append(row)
        print(f"{scene:13} {name:24} relative RMSE {row['relative RMSE']:6.2%}  bias {bias:+.2%} +- {bias_error:.2%}  cpu {row['cpu']:6.3f} s a pass  "
              f"{row['steps per ray']:5.1f} steps a ray, {row['clear']:4.0%} of rays without; {row['megabytes']:.1f} MB built "
              f"in {row['build']:.2f} s", flush=True)
        return row


    def lasting(self, scene, name, settings, passes=16):
        """The error after many passes: what their offsets do not take away."""
        many = {**STEPS, "integrator.steps": 512}
        truth = self.render(scene, f"many_{passes}", many, passes)["single_scattering"]
        rms = measure.error(self.render(scene, f"{name}_{passes}", settings, passes)["single_scattering"], [truth])
        print(f"{scene:13} {name:24} relative RMSE {rms:6.2%} after {passes} passes", flush=True)
        return rms


def run(mote, quick, output):
    study, claims = Study(mote, quick), Claims()
    rows = {}
    for scene in ("lamps", "shafts", "dense shafts")[: 2 if quick else 3]:
        for steps in ((64,) if quick else (16, 32, 64, 128)):
            for name, more in (("integrals", {}), ("steps", STEPS)):
                rows[scene, name, steps] = study.measure(scene, f"{name} {steps}", {**more, "integrator.steps": steps})
        a, b = rows[scene, "integrals", 64], rows[scene, "steps", 64]
        claims.check(f"{scene}: integrals are no less accurate than steps", f"{a['relative RMSE']:.2%} against {b['relative RMSE']:.2%}",
                     a["relative RMSE"] < (1.1 if quick else 1.02) * b["relative RMSE"])
        if not quick:
            claims.check(f"{scene}: and cost less", f"{a['cpu']:.3f} s against {b['cpu']:.3f} s", a["cpu"] < b["cpu"])
    lamps = rows["lamps", "integrals", 64]
    claims.check("lamps: most rays need no shadow ray", f"{lamps['clear']:.0%}", lamps["clear"] > 0.5)
    for scene in ("shafts", "smoke room")[: 1 if quick else 2]:
        traced = study.measure(scene, "traced", STEPS)
        maps = {}
        for size in ((256,) if quick else (128, 256, 512, 1024)):
            one = {"intervals": 1} if scene == "shafts" else {"max_megabytes": 256}
            maps[size] = study.measure(scene, f"map {size}", {**STEPS, **by_map(size, **one)})
        if quick:
            continue
        if scene == "shafts":
            left = {size: study.lasting(scene, f"map {size}", {**STEPS, **by_map(size, intervals=1)}) for size in maps}
            exact = study.lasting(scene, "traced", STEPS)
            claims.check(f"{scene}: coarse maps blur what passes would sharpen", f"{left[128]:.1%} against {exact:.1%}",
                         left[128] > 2 * exact)
        best = maps[512]
        claims.check(f"{scene}: marching by maps of 512^2 is cheaper", f"{best['cpu']:.3f} s against {traced['cpu']:.3f} s",
                     best["cpu"] < traced["cpu"])
        claims.check(f"{scene}: and their bias below one per cent", f"{best['bias']:+.2%} +- {best['bias error']:.2%}",
                     abs(best["bias"]) < 0.01 + 2 * best["bias error"])
    if not quick:
        write_csv(output.with_suffix(".csv"), list(study.rows[0]), [list(r.values()) for r in study.rows])
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
