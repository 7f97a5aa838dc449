#!/usr/bin/env python3
"""An independent witness: Mitsuba 3 renders the same scenes, and both must agree statistically.

Every scene is exported (mote export --to mitsuba3), rendered many times by each program with different seeds, and put
to the test of witness/same_mean.py. Exit code 0: all agree, or Mitsuba is not installed (with a notice); 1: a scene
disagrees, or is too noisy for an error of 3 % (quick: 10 %) to be seen; 2: wrong usage, or mote itself failed.

    experiments/peers/mitsuba.py --install     makes build/mitsuba_env, a virtual environment with Mitsuba
    experiments/peers/mitsuba.py               the witness set, some minutes
    experiments/peers/mitsuba.py --quick       six scenes with few samples, under a minute
    experiments/peers/mitsuba.py SCENE.xml -D density=3

Mitsuba is looked for in the Python that runs this file, in MOTE_MITSUBA_PYTHON, and in build/mitsuba_env.
"""
import argparse
import importlib.util
import os
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ENVIRONMENT = ROOT / "build" / "mitsuba_env"
# This file is called like the module that it looks for: its folder must not be searched.
sys.path[0] = str(HERE / "witness")

# Samples a pixel of one picture: what is noisy gets more.
WITNESS_SET = {"cornell_diffuse": 64, "cornell_glossy": 96, "rough_dielectric": 64, "environment": 64, "fog": 96,
               "chromatic_fog": 96, "camera_in_fog": 96, "smoke": 64, "everything_else": 64,
               "window": 96, "leaves": 96, "bumps": 64, "principled": 64, "rough_materials": 64, "shapes": 128,
               "instances": 96, "projector": 96, "hidden_lights": 96, "volume_texture": 64}
LEFT_OUT_OF_QUICK = ("environment", "chromatic_fog", "everything_else", "window", "leaves", "bumps", "principled",
                     "rough_materials", "shapes", "instances", "projector", "hidden_lights", "volume_texture")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenes", nargs="*", help="scene files, or names of the witness set (default: all of it)")
    parser.add_argument("-D", dest="defines", action="append", default=[], metavar="NAME=VALUE")
    parser.add_argument("--mote", default=os.environ.get("MOTE", str(ROOT / "build/release/bin/mote")))
    parser.add_argument("-o", dest="output", default=str(ROOT / "build/witness_pictures"), help="for pictures")
    parser.add_argument("--pictures", action="store_true", help="write pictures of every scene, not of failures only")
    parser.add_argument("-n", type=int, help="pictures by each program (default: 32, quick: 8)")
    parser.add_argument("--passes", type=int, help="samples a pixel of each picture (default: by scene)")
    parser.add_argument("--variant", default="scalar_rgb", choices=("scalar_rgb", "llvm_ad_rgb"))
    parser.add_argument("--quick", action="store_true", help="six scenes, a twelfth of the samples")
    parser.add_argument("--trade", metavar="DIR", help="measure Mitsuba against the reference of a trade instead")
    parser.add_argument("--timed", metavar="DIR", help="do the job of experiments/trade/run --peers in DIR instead")
    parser.add_argument("--install", action="store_true", help="make build/mitsuba_env, then continue")
    options = parser.parse_args()
    options.n = options.n or (8 if options.quick else 32)
    if options.n < 4:
        parser.error("-n must be at least 4: variances are measured over the pictures")
    return options


def install():
    print(f"installing Mitsuba 3 into {ENVIRONMENT}")
    venv.create(ENVIRONMENT, with_pip=True)
    subprocess.run([ENVIRONMENT / "bin/python", "-m", "pip", "install", "--quiet", "mitsuba>=3.5", "numpy"],
                   check=True)


def become_a_python_with_mitsuba():
    """Replaces this process when another Python has what this one lacks; returns False when none has."""
    if importlib.util.find_spec("mitsuba") and importlib.util.find_spec("numpy"):
        return True
    if os.environ.get("MOTE_WITNESS_SEARCHED"):
        return False
    for python in (os.environ.get("MOTE_MITSUBA_PYTHON"), ENVIRONMENT / "bin/python"):
        if python and os.access(python, os.X_OK):
            os.environ["MOTE_WITNESS_SEARCHED"] = "1"
            rest = [a for a in sys.argv[1:] if a != "--install"]
            os.execv(python, [str(python), str(HERE / "mitsuba.py"), *rest])
    return False


def scene_list(options):
    """(name, file, passes) of every scene requested."""
    share = 3 if options.quick else 1
    default = [name for name in WITNESS_SET if not (options.quick and name in LEFT_OUT_OF_QUICK)]
    for word in options.scenes or default:
        own = word in WITNESS_SET
        path = HERE / "scenes" / f"{word}.xml" if own else Path(word)
        passes = options.passes or max(1, WITNESS_SET.get(word, 64) // share)
        if word == "smoke" and not (ROOT / "scenes/generated/smoke.vdb").exists() and not options.defines:
            print("smoke: left out, there is no scenes/generated/smoke.vdb (scenes/generate makes it)")
            continue
        yield path.stem, path, passes


def judge(name, path, passes, options, folder):
    import renderers
    from report import row, write_pictures
    from same_mean import same_mean

    exported = Path(folder) / name
    renderers.export(options.mote, path, options.defines, exported)
    ours, our_time = renderers.seconds_of(
        lambda: renderers.mote_pictures(options.mote, path, options.defines, passes, options.n, folder))
    scene = renderers.load_mitsuba(exported)
    theirs, their_time = renderers.seconds_of(lambda: renderers.mitsuba_pictures(scene, passes, options.n))
    result = same_mean(ours, theirs, 0.1 if options.quick else 0.03)
    print(row(name, result), flush=True)
    print(f"{name}: {our_time:.0f} s and {their_time:.0f} s", file=sys.stderr)
    good = result.agrees and result.sensitive
    if options.pictures or not good:
        write_pictures(options.output, name, ours, theirs, result)
        print(f"{name}: pictures in {options.output}", file=sys.stderr)
    return good


def main():
    options = arguments()
    try:
        if options.install:
            install()
    except subprocess.CalledProcessError as error:
        print(f"mitsuba.py: the installation failed: {error}", file=sys.stderr)
        return 2
    if not become_a_python_with_mitsuba():
        print("Mitsuba 3 is not installed: the witness is skipped (--install gets it)")
        return 0
    import mitsuba as mi
    from report import HEAD
    from same_mean import self_check

    mi.set_variant(options.variant)
    self_check()
    try:
        if options.timed:
            from timed import write_timed
            return write_timed(options.timed)
        if options.trade:
            from trade import write_peer
            return write_peer(options)
        print(HEAD, flush=True)
        with tempfile.TemporaryDirectory() as folder:
            results = [judge(*scene, options, folder) for scene in scene_list(options)]
    except (RuntimeError, OSError) as error:
        print(f"mitsuba.py: {error}", file=sys.stderr)
        return 2
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
