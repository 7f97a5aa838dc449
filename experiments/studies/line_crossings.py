#!/usr/bin/python3
"""Does it pay to place samples where the epipolar lines of two lights cross? (Engelhardt 2013, Sec. 9.5)

mote_epipolar with `crossings` against mote_epipolar without, one pass with the same lines and march steps, on scenes with
two and three lights in fog and in smoke. Counted: samples at crossings, rays and grid lookups that they save. Measured:
processor time, in pairs that take turns on one thread, and the error against the picture that marches every pixel. One case
is as favourable to crossings as it gets: many spread samples, no refinement, and few steps a ray. Exit code 0: all is as
documented; 1: it is not; 2: wrong usage, or mote is missing. A full run takes about 8 minutes
of one core, --quick one.

    experiments/studies/line_crossings.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

FIGURES = Path(__file__).resolve().parent.parent / "figures"
sys.path.insert(0, str(FIGURES))
from claims import Claims
from engelhardt_09_10_against_subsampling import relative_mse
from occluders import sculpture
from renders import ROOT, main, mean_and_error, write_csv

SPOT = """<emitter type="spot"><rgb name="intensity" value="{}"/><float name="cutoff_angle" value="{}"/>
    <transform name="to_world"><lookat origin="{}" target="{}" up="0, 1, 0"/></transform></emitter>
"""


def with_light(mote, scene, *spot):
    """The scene with a spot light more."""
    text = (ROOT / "scenes" / f"{scene}.xml").read_text(encoding="utf-8")
    path = mote.folder / f"{scene}_2.xml"
    path.write_text(text.replace("</scene>", SPOT.format(*spot) + "</scene>"), encoding="utf-8")
    return path


def cases(mote, quick):
    """By name: the scene, its settings, and its size."""
    mesh = mote.folder / "sculpture.ply"
    sculpture(mesh, 60 if quick else 200)
    three = (FIGURES / "scenes" / "three_lights.xml", {"mesh": mesh.resolve()})
    fog = (with_light(mote, "fog_grille", "200, 210, 260", 26, "-5.4, 2.9, -1", "0, 1.3, 0"), {})
    room = (with_light(mote, "smoke_room", "30, 34, 40", 28, "3.5, 2.6, 4.6", "1.2, 0.9, 1.4"),
            {"smoke": (ROOT / "scenes" / "generated" / "smoke.vdb").resolve()})
    large, small = ((320, 180), (80, 60)) if quick else ((640, 360), (320, 240))
    sampling = {"samples": 8, "steps": 32 if quick else 64}
    return {"three lights, fog": (*three, large, sampling), "two lights, fog": (*fog, large, sampling),
            "two lights, smoke": (*room, small, {"samples": 8, "steps": 16, "voxels": 2}),
            "three lights, favourable": (*three, large, {"samples": 32, "steps": 4, "tolerance": 0}),
            "smoke, favourable": (*room, small, {"samples": 32, "steps": 4, "tolerance": 0, "voxels": 2})}


def measure(mote, name, scene, settings, size, sampling, seeds, turns):
    settings = {"resx": size[0], "resy": size[1], **settings}
    march = {f"integrator.{k}": v for k, v in sampling.items() if k in ("steps", "voxels")}
    lines = {**settings, "integrator": "mote_epipolar", "integrator.lines": round(1024 * sum(size) / 3000),
             **{f"integrator.{k}": v for k, v in sampling.items()}}
    tag = name.replace(" ", "_").replace(",", "")
    off, on, errors = [], [], []
    for seed in range(1, seeds + 1):
        full = mote.render(scene, tag + "_full", {**settings, **march, "integrator": "mote_single_scattering"}, 1, seed)
        for turn in range(turns):
            for pictures, crossings in ((off, False), (on, True)):
                pictures.append(mote.render(scene, f"{tag}_{'on' if crossings else 'off'}_{turn}",
                                            {**lines, "integrator.crossings": crossings}, 1, seed, threads=1))
        errors.append([relative_mse(p[-1], full) for p in (off, on)])
    mean = lambda pictures, of: sum(of(p) for p in pictures) / len(pictures)
    saved = lambda of: float(1 - mean(on, of) / mean(off, of))
    rays, lookups = lambda p: p.statistics["rays"], lambda p: p.statistics["lookups"]["density"]
    time, time_error = mean_and_error([b.cpu / a.cpu for a, b in zip(off, on)])
    marched, shared = (mean(on, lambda p: p.value(key)) for key in ("marched_rays", "shared_rays"))
    error_off, error_on = np.mean(errors, axis=0)
    return {"case": name, "marched": marched, "shared": shared, "share": 2 * shared / marched,
            "marched_saved": saved(lambda p: p.value("marched_rays")), "eye_rays_saved": saved(lambda p: rays(p)["closest"]),
            "rays_saved": saved(lambda p: sum(rays(p).values())), "lookups_saved": saved(lookups),
            "edge_rays": mean(off, lambda p: p.value("epipolar_texels") / sum(rays(p).values())),
            "seconds": mean(off, lambda p: p.cpu), "time": float(time), "time_error": float(time_error),
            "error_off": float(error_off), "error_on": float(error_on),
            "memory": mean(on, lambda p: p.value("screen_space_bytes_peak")) /
                      mean(off, lambda p: p.value("screen_space_bytes_peak"))}


def draw(rows, path):
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.2), sharey=True)
    names = [r["case"] for r in rows]
    axes[0].barh(names, [100 * r["share"] for r in rows])
    axes[0].set_xlabel("marched rays at crossings [%]")
    for k, (key, label) in enumerate((("rays_saved", "rays"), ("lookups_saved", "lookups in media"))):
        axes[1].barh([i - 0.2 + 0.4 * k for i in range(len(rows))], [100 * r[key] for r in rows], 0.4, label=label)
    axes[1].set_xlabel("saved [%]")
    axes[1].legend(loc="lower left")
    axes[2].errorbar([r["time"] for r in rows], names, xerr=[2 * r["time_error"] for r in rows], fmt="o")
    axes[2].axvline(1, color="grey", linewidth=1)
    axes[2].set_xlabel("processor time, with over without (2 s.e.)")
    axes[0].invert_yaxis()
    figure.tight_layout()
    figure.savefig(path.with_suffix(".png"), dpi=90)
    plt.close(figure)


def run(mote, quick, output):
    rows = []
    for name, case in cases(mote, quick).items():
        rows.append(measure(mote, name, *case, seeds=2 if quick else 4, turns=1 if quick else 2))
        r = rows[-1]
        print(f"{name:24} {r['marched']:.0f} marched rays, {r['share']:.1%} of them at crossings; saved: "
              f"{r['rays_saved']:+.2%} of all rays, {r['eye_rays_saved']:+.2%} of first surfaces, {r['lookups_saved']:+.2%} of "
              f"lookups; time {r['time']:.3f} +- {r['time_error']:.3f} of {r['seconds']:.2f} s; error {r['error_off']:.3e} -> "
              f"{r['error_on']:.3e}; memory x {r['memory']:.2f}; rays that look for edges: {r['edge_rays']:.1%} of all",
              flush=True)
    claims = Claims()
    claims.check("samples can move to crossings without harm (relative error of the picture, within 15 %)",
                 ", ".join(f"{r['error_on'] / r['error_off']:.3f}" for r in rows),
                 all(abs(r["error_on"] / r["error_off"] - 1) < 0.15 for r in rows))
    claims.check("sharing eye rays saves less than 2 % of the rays, and of the lookups in media",
                 ", ".join(f"{r['rays_saved']:.2%} and {r['lookups_saved']:.2%}" for r in rows),
                 all(max(r["rays_saved"], r["lookups_saved"]) < 0.02 for r in rows))
    claims.check("no scene becomes faster by 3 % or more, beyond twice the standard error",
                 ", ".join(f"{r['time']:.3f} +- {r['time_error']:.3f}" for r in rows),
                 all(r["time"] + 2 * r["time_error"] > 0.97 for r in rows))
    write_csv(output.with_suffix(".csv"), list(rows[0]), [list(r.values()) for r in rows])
    draw(rows, output)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, run))
