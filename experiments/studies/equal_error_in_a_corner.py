#!/usr/bin/python3
"""Screen-space against exact compensation at equal error, in a corner whose light is known by quadrature (corner.py).

Both are given the same passes of virtual point lights. The error is the relative RMSE (measure.py) of the layer
`compensation_surface` against the quadrature, with all the noise there is.
Exact compensation has no bias, so its error falls with the root of its passes; what it takes to come down to that of screen
space follows from its variance. Its time is what the render spends on it alone; that of screen space is the whole of `mote ssbc`,
which reads and writes EXR files. Processor time. 1368 light paths leave 1024 virtual point lights. About 3 minutes.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
import numpy as np
from claims import Claims
from corner import picture, reflected, transported
from measure import series_error
from renders import compensation, luminance, main, mean_and_error, write_csv
from exr import read_exr

SCENE = Path(__file__).resolve().parent.parent / "figures" / "scenes" / "corner.xml"
LAYER = "compensation_surface"
STEPS = 3
FEW = "exact compensation joins its vertices to all virtual point lights, of which there are 48; screen space needs none"


def quadrature(mote, quick, settings):
    """Limit of exact compensation by quadrature; kept beside the renders."""
    name = f"quadrature_{settings['resx']}_{settings['bound']}.npy"
    if not (mote.folder / name).is_file():
        n, count = (12, 512) if quick else (24, 1024)
        light = transported(reflected(n, count), settings["bound"], 3 * n, count)
        np.save(mote.folder / name, picture(light, settings["resx"], settings["resy"]))
    return np.load(mote.folder / name)


def screen_space(mote, render, name):
    """The layer that `mote ssbc` adds to a render, and the seconds it took."""
    path, _, seconds = mote.ssbc(mote.folder / f"{render}.exr", name, "--steps", STEPS)
    return read_exr(path)[LAYER], seconds


def measure(mote, paths, settings, truth, passes, seeds):
    """Squared errors after `passes`, and seconds, of exact and screen-space compensation, over seeds."""
    errors, seconds, sums = {"exact": [], "screen space": []}, {"exact": [], "screen space": []}, []
    settings = {**settings, "paths": paths}
    for seed in seeds:
        exact = mote.render(SCENE, f"exact_{paths}", {**settings, **compensation("exact")}, passes, seed=seed)
        mote.render(SCENE, f"bounded_{paths}", settings, passes, seed=seed, auxiliary=True)
        found, took = screen_space(mote, f"bounded_{paths}_{seed}", f"ssbc_{paths}_{seed}")
        took_exact = exact.value("compensation_thread_seconds")
        for name, picture_of, time in (("exact", exact[LAYER], took_exact), ("screen space", found, took)):
            errors[name].append(series_error([picture_of], [truth])["squared_error"])
            seconds[name].append(time)
        sums.append(luminance(exact[LAYER]).mean() / luminance(truth).mean() - 1)
    return errors, seconds, mean_and_error(sums), luminance(found).mean() / luminance(truth).mean()


def study(mote, quick, output):
    claims, rows = Claims(), []
    scale = 1 if quick else 2
    settings = {"resx": 128 * scale, "resy": 96 * scale, "bound": 4}
    truth = quadrature(mote, quick, settings)
    passes, seeds = (4, range(1, 4)) if quick else (8, range(1, 7))
    for paths in ([1368] if quick else [64, 1368]):
        errors, seconds, (bias, spread), share = measure(mote, paths, settings, truth, passes, seeds)
        of = {name: np.mean(values) for name, values in errors.items()}
        relative = {name: value ** 0.5 for name, value in of.items()}
        equal = np.mean(seconds["exact"]) * of["exact"] / of["screen space"]
        ratio = equal / np.mean(seconds["screen space"])
        print(f"{paths} light paths, {passes} passes: exact {relative['exact']:.1%} in {np.mean(seconds['exact']):.2f} s, "
              f"screen space {relative['screen space']:.1%} in {np.mean(seconds['screen space']):.2f} s; to that error "
              f"exact compensation takes {equal:.0f} s")
        claims.check(f"{paths} light paths: exact compensation has the mean of the quadrature", f"{bias:+.2%} +- {spread:.2%}",
                     abs(bias) < 4 * spread + (0.02 if quick else 0.005))
        # In quick pictures what `mote ssbc` takes to start and to read is most of its time.
        claims.check(f"{paths} light paths: screen space takes at most a {'30th' if quick else 'hundredth'} of the time to the same error",
                     f"1 / {ratio:.0f}", ratio >= (30 if quick else 100), FEW if paths == 64 else None)
        rows.append([paths, passes, relative["exact"], float(np.mean(seconds["exact"])), relative["screen space"],
                     float(np.mean(seconds["screen space"])), float(ratio), float(share)])
        print(f"              {share:.1%} of the light is brought back")
    write_csv(output.with_suffix(".csv"), ["light_paths", "passes", "error_exact", "seconds_exact", "error_screen_space",
                                           "seconds_screen_space", "ratio", "share_brought_back"], rows)
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, study))
