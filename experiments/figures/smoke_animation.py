#!/usr/bin/python3
"""Forty-eight frames of rising smoke and a lamp that goes round it, and what an interruption leaves of them.

One `mote render` with a parameter that runs (-D t=0.25:7.5:352.75), a grid a frame (smoke.####.vdb, by mote_smoke), `mote_layers` with
its filter. The same sequence is made again, killed three times and resumed: no bit may differ. A contact sheet and an
animated picture are plotted. A full run takes about 12 minutes on two cores, --quick half a minute.

    experiments/figures/smoke_animation.py [--quick] [--redraw] [--output FOLDER] [--bin FOLDER]
"""
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from claims import Claims
from exr import read_exr
from panels import Canvas, show
from PIL import Image
from renders import luminance, main, write_csv

SCENE = Path(__file__).resolve().parent / "scenes" / "rising_smoke.xml"
FIRST_STEP = 24  # of the simulation: there is smoke in the first frame


def grids(mote, frames):
    for i in range(frames):
        file = mote.folder / f"smoke.{i:04}.vdb"
        if not file.is_file():
            subprocess.run([mote.program.parent / "mote_smoke", "-o", file, "--size", "36", "64", "36", "--cell", "0.0333",
                            "--steps", str(FIRST_STEP + i), "--open", "--source", "0.5", "0.1", "0.5", "--seed", "3"],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)


def command(mote, frames, size, passes, folder, *more):
    folder.mkdir(exist_ok=True)
    # Angles that are not whole: frames are counted from 0 then.
    return [mote.program, "render", SCENE, "-D", f"t=0.25:{360 / frames:g}:{360.25 - 360 / frames:g}", "-D", f"smoke={mote.folder.resolve()}/smoke.####.vdb",
            "-D", f"resx={size[0]}", "-D", f"resy={size[1]}", "--passes", str(passes), "--quiet", "-o", folder / "####.exr", *more]


def kill(run, how, seconds):
    """Lets the command run so long, and ends it. Returns whether it was still there."""
    try:
        run.wait(seconds)
        return False
    except subprocess.TimeoutExpired:
        run.send_signal(how)
        run.wait()
        return True


def interrupted(mote, frames, size, passes, seconds):
    """The sequence made in four attempts. Returns how many of three kills met it at work; with --redraw, of the last run."""
    folder, record = mote.folder / "resumed", mote.folder / "kills.txt"
    if mote.redraw and record.is_file():
        return int(record.read_text())
    kills = 0
    for i, how in enumerate((signal.SIGKILL, signal.SIGINT, signal.SIGKILL)):
        more = ["--resume"] * (i > 0) + ["--checkpoint-every", "0"]
        kills += kill(subprocess.Popen(command(mote, frames, size, passes, folder, *more)), how, seconds * (0.2 + 0.03 * i))
    subprocess.run(command(mote, frames, size, passes, folder, "--resume"), check=True)
    record.write_text(f"{kills}\n")
    return kills


def animate(pictures, exposure, path):
    """Writes the GIF, each frame with a palette of its own: one of a dark frame would darken all. Returns the largest relative
    difference of a frame's mean brightness."""
    frames = [(255 * np.clip(p * exposure, 0, 1) ** (1 / 2.2)).astype(np.uint8) for p in pictures]
    small = [Image.fromarray(f).quantize(128, dither=Image.Dither.NONE) for f in frames]
    small[0].save(path, save_all=True, append_images=small[1:], duration=1000 // 24, loop=0, optimize=True)
    gif, differences = Image.open(path), []
    for i, frame in enumerate(frames):
        gif.seek(i)
        differences.append(abs(np.asarray(gif.convert("RGB"), float).mean() / frame.mean() - 1))
    return max(differences)


def figure(mote, quick, output):
    frames, size, passes = (6, (64, 48), 8) if quick else (48, (320, 240), 20)
    claims = Claims()
    grids(mote, frames)
    whole = mote.folder / "whole"
    begin = time.monotonic()
    if not (mote.redraw and whole.is_dir()):
        subprocess.run(command(mote, frames, size, passes, whole), check=True)
    seconds = time.monotonic() - begin
    files = sorted(whole.glob("*.exr"))
    kills = interrupted(mote, frames, size, passes, seconds)
    pictures = [read_exr(f)[""] for f in files]
    again = [read_exr(mote.folder / "resumed" / f.name)[""] for f in files]
    different = sum(not np.array_equal(a, b) for a, b in zip(pictures, again))
    claims.check(f"killed three times and resumed, {frames} frames have the same bits",
                 f"{different} frames differ after {kills} kills", different == 0 and kills == 3)
    exposure = 0.9 / np.quantile(luminance(np.array(pictures)), 0.995)
    columns = 3 if quick else 8
    width, height = 1280 // columns, 1280 // columns * size[1] // size[0]
    canvas = Canvas(1280, height * ((frames + columns - 1) // columns))
    for i, picture in enumerate(pictures):
        show(canvas.panel(i % columns * width, i // columns * height, width - 2, height - 2), picture, exposure)
    canvas.save(output.with_suffix(".png"))
    difference = animate(pictures, exposure, output.with_suffix(".gif"))
    claims.check("frames of the animated picture are as bright as the renders", f"{100 * difference:.2f} % off at most", difference < 0.03)
    megabytes = output.with_suffix(".gif").stat().st_size / 1e6
    claims.check("the animated picture has less than 3 MB", f"{megabytes:.2f} MB", megabytes < 3)
    write_csv(output.with_suffix(".csv"), ["frame", "mean_luminance"], [[i, float(luminance(p).mean())] for i, p in enumerate(pictures)])
    return claims.exit_code()


if __name__ == "__main__":
    sys.exit(main(__file__, __doc__, figure))
