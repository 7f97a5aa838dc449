#!/usr/bin/env python3
"""Compares the frames of animated pictures with those of the sheet that the same script drew.

docs/gallery/NAME.gif has the frames of docs/gallery/NAME.png, row by row. A palette that was taken from one frame makes others too
dark or too bright.

    tests/pages/check_gifs.py ROOT
"""
import sys

import numpy as np
from PIL import Image
from pages import run

TOLERANCE = 0.1  # of a frame's mean brightness; panels are scaled and have a margin
MARGIN = 4       # pixels


def columns_of(sheet, frame, count):
    """Columns of the sheet that hold so many frames of this form, or None."""
    for columns in range(1, count + 1):
        width = sheet[0] / columns
        height = width * frame[1] / frame[0]
        if abs(height * -(-count // columns) - sheet[1]) < columns:
            return columns, round(width), round(height)
    return None


def check_gif(path):
    if not path.with_suffix(".png").is_file():
        return [f"{path.name}: there is no {path.stem}.png with its frames"]
    gif, sheet = Image.open(path), Image.open(path.with_suffix(".png")).convert("RGB")
    layout = columns_of(sheet.size, gif.size, gif.n_frames)
    if not layout:
        return [f"{path.name}: {gif.n_frames} frames of {gif.size} do not fill the sheet of {sheet.size}"]
    columns, width, height = layout
    pixels, offences = np.asarray(sheet, float), []
    for i in range(gif.n_frames):
        gif.seek(i)
        x, y = i % columns * width, i // columns * height
        expected = pixels[y + MARGIN:y + height - MARGIN, x + MARGIN:x + width - MARGIN].mean()
        found = np.asarray(gif.convert("RGB"), float).mean()
        if abs(found - expected) > TOLERANCE * expected:
            offences.append(f"{path.name}: frame {i} has a mean of {found:.0f}, the sheet {expected:.0f} of 255")
    return offences


def check(root):
    return [o for path in sorted((root / "docs" / "gallery").glob("*.gif")) for o in check_gif(path)]


if __name__ == "__main__":
    sys.exit(run(check, sys.argv[1], "frames of animated pictures are as bright as those of their sheets"))
