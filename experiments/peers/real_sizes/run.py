#!/usr/bin/env python3
"""Peers at real sizes: error against time of mote, Mitsuba 3 and Cycles on the same scenes, with and without
OpenImageDenoise (pyoidn, in the Python that runs this and in MOTE_PYTHON; Cycles has its own).

    experiments/trade/run --peers [SCENE...]           640 x 400, into out/peers/: some four minutes a scene
    experiments/trade/run --peers --quick [SCENE...]   80 x 50, into out/peers_quick/: some three minutes in all
    experiments/trade/run --peers --references         the references alone, where they are missing
    experiments/trade/run --peers --paths [SCENE...]   path tracers alone, ours and Mitsuba's, into out/peers_paths/
    experiments/trade/run --peers --match [SCENE...]   means of the peers against volpath, 64 x 40: a table

Scenes: cornell_box smoke_room fog_grille cloud atrium city; settings.json has their settings. Two references a scene,
NAME_a.exr (or NAME.exr) and NAME_b.exr, are looked for in the folders MOTE_REFERENCES (default out/references) and made
in the first of them by the path tracer where they are missing, with box filter, REFERENCE_TIME seconds each. All pictures
have the size and the pixel filter of the references. A method that was measured is not measured again (--fresh: it is). A
peer that is not installed is left out with a notice.
"""
import argparse
import json
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent
sys.path.append(str(ROOT / "experiments" / "figures"))
import measure  # noqa: E402
from match import match  # noqa: E402
from mote_runs import Mote, beauty_and_variance, filter_of, found_references, make_reference  # noqa: E402
from origin import commit  # noqa: E402
from page import markdown, write_csv, write_page, write_speed  # noqa: E402
from peer_runs import export, pictures, run_peer  # noqa: E402
from plot import svg  # noqa: E402
from times import References, judged  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--paths", action="store_true", help="our path tracer and Mitsuba's alone")
    parser.add_argument("--match", action="store_true")
    parser.add_argument("--references", action="store_true")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--budget", type=float, help="seconds for all pictures of a method (settings.json: 34)")
    parser.add_argument("--mote", default=os.environ.get("MOTE", str(ROOT / "build/release/bin/mote")))
    options = parser.parse_args()
    settings = json.loads((HERE / "settings.json").read_text())
    unknown = [name for name in options.scenes if name not in settings["scenes"]]
    if unknown:
        parser.error(f"no scene {unknown[0]}: there are {' '.join(settings['scenes'])}")
    if options.quick:
        settings.update(settings["quick"])
    if options.paths:
        settings["peers"] = settings["peers"][:1]
        settings["ours"] = [method for method in settings["ours"] if method.get("unbiased")]
    settings["budget"] = options.budget or settings["budget"]
    settings["reference_time"] = float(os.environ.get("REFERENCE_TIME", settings["reference_time"]))
    options.output = ROOT / "out" / ("peers" + "_paths" * options.paths + "_quick" * options.quick)
    folders = os.environ.get("MOTE_REFERENCES", str(ROOT / "out" / "references")).split(os.pathsep)
    options.folders = [options.output / "references"] if options.quick else [Path(f) for f in folders]
    return options, settings


def measured(folder, fresh, setup, action):
    """The log of an earlier run with the same setup, or of this one; None where the program is not installed."""
    file = folder / "log.json"
    if file.is_file() and not fresh:
        log = json.loads(file.read_text())
        if log.get("setup") == setup:
            return log
    log = action(folder)
    if log is not None:
        log["setup"] = setup
        file.write_text(json.dumps(log, indent=1))
    return log


def methods_of(mote, scene, settings, options, output):
    """Of each, one after the other: name, settings as text, program (of a peer, else ""), unbiased, folder, log."""
    budget, exported = settings["budget"], output / "exported"
    setup = [settings[key] for key in ("width", "height", "filter", "threads", "budget")]
    for index, method in enumerate(settings["ours"]):
        method = {"integrator": scene["integrator"], **({} if "integrator" in method else scene), **method,
                  "name": method["name"]}
        folder = output / folder_name(method)
        log = measured(folder, options.fresh, [*setup, method], lambda f: mote.run(method, f, budget, 100 * (index + 1)))
        text = " ".join([method["integrator"]] + [f"{k}={v}" for k, v in method.get("settings", {}).items()])
        yield method["name"], text, "", method.get("unbiased", False), bool({"denoise", "filtered"} & method.keys()), folder, log
    notes = export(mote, scene["integrator"], exported)
    for index, peer in enumerate(settings["peers"]):
        folder, s = output / folder_name(peer), {**settings[peer["program"]], **peer}
        log = measured(folder, options.fresh, [*setup, s],
                       lambda f: run_peer(peer, mote, settings, exported, f, budget, 1000 * (index + 1)))
        if log is None:
            print(f"{peer['name']} is not installed: left out", flush=True)
            continue
        log["notes"] += notes if peer["program"] == "mitsuba" else []
        text = " ".join(f"{k}={v}" for k, v in s.items() if k not in ("name", "program"))
        yield peer["name"], text, peer["program"], not peer["denoise"], peer["denoise"], folder, log


def folder_name(method):
    return method["name"].replace(" ", "_").replace(",", "").replace("+", "and")


def scene_page(name, scene, settings, options):
    """Measures one scene and writes its CSV, SVG and table; what write_page needs of it."""
    output = options.output / name
    sizes = [f"resx={settings['width']}", f"resy={settings['height']}", "film.rfilter=box"]
    mote = Mote(options.mote, ROOT / "scenes" / f"{name}.xml", sizes, settings["threads"])
    files = found_references(options.folders, name)
    files = [file or make_reference(mote, options.folders[0] / f"{name}_{letter}.exr", scene, settings["reference_time"])
             for file, letter in zip(files, "ab")]
    if options.references:
        return None
    (a, va), (b, vb) = map(beauty_and_variance, files)
    filters = {filter_of(file) for file in files}
    if b.shape != a.shape or len(filters) > 1:
        raise RuntimeError(f"{files[0]} and {files[1]} differ in size or pixel filter")
    # Size and filter of all images are those of the references.
    settings = {**settings, "height": a.shape[0], "width": a.shape[1], "filter": filters.pop()}
    settings["cycles"] = {**settings["cycles"], "filter": settings["filter"]}
    mote.sizes = [f"resx={settings['width']}", f"resy={settings['height']}", f"film.rfilter={settings['filter']}"]
    references, methods, notes = References([a, b], [va, vb]), [], []
    model = {}  # program: what its pictures differ by without denoiser
    for method, text, program, unbiased, denoised, folder, log in methods_of(mote, scene, settings, options, output):
        systematic = judged(references, log["runs"], list(pictures(folder, log)))
        if program and unbiased and systematic[0] > 3 * systematic[1]:
            model[program] = systematic
        methods.append({"name": method, "settings": text, "peer": program != "", "unbiased": unbiased, "runs": log["runs"],
                        "version": log["version"], "build_s": log["build_s"], "systematic": systematic,
                        "model": model.get(program, (0.0, 0.0)),
                        "denoised": denoised})
        notes += [f"{method}: {note}" for note in log["notes"]]
        last = log["runs"][-1]
        print(f"{name}: {method}: {last['passes']} passes, {last['wall_s']:.1f} s, error {100 * last['error']:.2f} ± "
              f"{100 * last['error_se']:.2f} %, bias {100 * last['bias']:+.2f} ± {100 * last['bias_se']:.2f} %, mean "
              f"{100 * last['mean']:+.2f} ± {100 * last['mean_se']:.2f} %", flush=True)
    if references.broken:
        notes.append(f"{references.broken} pixels are left out: one reference is a thousand times brighter there than the other "
                     "is anywhere")
    notes.append(f"noise of each reference: {100 * references.noise():.2f} %")
    notes.append(f"{settings['width']} x {settings['height']} pixels, {settings['filter']} filter")
    facts = {**facts_of(settings, options), "References": " ".join(f"{f.name} ({f.stat().st_size} bytes)" for f in files)}
    write_csv(output / "peers.csv", facts, name, methods)
    drawing = svg(f"{scene['name']}, {settings['width']} x {settings['height']}",
                  [(m["name"], m["runs"], not m["denoised"]) for m in methods])
    (output / "peers.svg").write_text(drawing, encoding="utf-8")
    (output / "peers.md").write_text(markdown(methods), encoding="utf-8")
    print(markdown(methods), flush=True)
    return scene["name"], drawing, methods, notes


def facts_of(settings, options):
    return {"Script": "experiments/peers/real_sizes/run.py", "Commit": commit(),
            "Run": "quick" if options.quick else "full",
            "Seconds": f"{settings['budget']} for all pictures of a method, {settings['threads']} threads"}


def main():
    options, settings = arguments()
    measure.use(Path(options.mote).parent)
    if not os.access(options.mote, os.X_OK):
        print(f"no {options.mote}: build it first (./quickstart does)", file=sys.stderr)
        return 2
    pages = []
    try:
        if options.match:
            return match(options.mote, options.scenes or settings["scenes"], settings, ROOT / "out" / "peers_match")
        for name in options.scenes or settings["scenes"]:
            page = scene_page(name, settings["scenes"][name], settings, options)
            pages += [page] if page else []
        if pages:
            write_page(options.output / "peers.html", facts_of(settings, options), pages)
            print(write_speed(options.output, facts_of(settings, options), [(p[0], p[2]) for p in pages]))
            print(options.output / "peers.html")
    except (RuntimeError, OSError) as error:
        print(f"run.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
