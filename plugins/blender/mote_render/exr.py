"""Reads the pictures that `mote` writes: OpenEXR, scan lines, zip ("The OpenEXR File Layout", openexr.com).

Blender's Python has no OpenEXR module, and its images hold one layer of such a file, not all.
"""
import struct
import zlib
from pathlib import Path

import numpy as np

LINES = 16  # of a block with zip compression
KINDS = {0: "<u4", 1: "<f2", 2: "<f4"}


def read_exr(path):
    """{channel: float32 array [height, width], the top row first}; ValueError where the file is another kind."""
    data = Path(path).read_bytes()
    header, at = read_header(data)
    if header.get("compression") != b"\3":
        raise ValueError(f"{path}: not compressed by zip")
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = read_channels(header["channels"])
    line_size = width * sum(np.dtype(kind).itemsize for _, kind in channels)
    planes = {name: np.empty((height, width), np.float32) for name, _ in channels}
    for offset in struct.unpack_from(f"<{-(-height // LINES)}Q", data, at):
        first, size = struct.unpack_from("<2i", data, offset)
        lines = range(first - y0, min(first - y0 + LINES, height))
        block = data[offset + 8:offset + 8 + size]
        if size < len(lines) * line_size:  # else it could not be made smaller, and was left alone
            block = undo_prediction(zlib.decompress(block))
        where = 0
        for line in lines:
            for name, kind in channels:
                planes[name][line] = np.frombuffer(block, kind, width, where)
                where += np.dtype(kind).itemsize * width
    return planes


def read_header(data):
    """The attributes as bytes, and where the table of offsets begins."""
    header, at = {}, 8
    while data[at]:
        name = data[at:data.index(b"\0", at)].decode()
        at += len(name) + 1
        at = data.index(b"\0", at) + 1  # behind its type
        size, = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return header, at + 1


def read_channels(data):
    channels = []
    while data[0]:
        name, data = data.split(b"\0", 1)
        channels.append((name.decode(), KINDS[struct.unpack_from("<i", data)[0]]))
        data = data[16:]
    return channels


def undo_prediction(data):
    """Bytes are differences from the one before, plus 128; even ones first, then odd ones."""
    steps = np.frombuffer(data, np.uint8).astype(np.int64)
    steps[1:] -= 128
    values = np.cumsum(steps).astype(np.uint8)
    half = (len(values) + 1) // 2
    result = np.empty_like(values)
    result[0::2], result[1::2] = values[:half], values[half:]
    return result.tobytes()
