"""Reads the pictures of `mote`: OpenEXR, scan lines, zip ("The OpenEXR File Layout", openexr.com)."""
import struct
import zlib
from pathlib import Path

import numpy as np

LINES = 16  # of a block with zip compression


def read_exr(path):
    """Its layers, by name: arrays of height * width * 3. The beauty is ''."""
    data = Path(path).read_bytes()
    header, at = read_header(data)
    if header["compression"] != b"\3":
        raise ValueError(f"{path}: not compressed by zip")
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = read_channels(header["channels"])
    bytes_per_line = width * sum(kind.itemsize for _, kind in channels)
    planes = {name: np.empty((height, width)) for name, _ in channels}
    for offset in struct.unpack_from(f"<{-(-height // LINES)}Q", data, at):
        first, size = struct.unpack_from("<2i", data, offset)
        lines = range(first - y0, min(first - y0 + LINES, height))
        block = data[offset + 8:offset + 8 + size]
        if size < len(lines) * bytes_per_line:  # else it could not be made smaller, and was left alone
            block = undo_prediction(zlib.decompress(block))
        where = 0
        for line in lines:
            for name, kind in channels:
                planes[name][line] = np.frombuffer(block, kind, width, where)
                where += kind.itemsize * width
    layers = {name.rpartition(".")[0] for name in planes if name.rpartition(".")[2] == "R"}
    return {layer: np.stack([planes[f"{layer}.{c}" if layer else c] for c in "RGB"], axis=2) for layer in layers}


def read_header(data):
    """The attributes as bytes, and where the table of offsets begins."""
    text = lambda at: data[at:data.index(b"\0", at)].decode()
    header, at = {}, 8
    while data[at]:
        name = text(at)
        at += len(name) + 1
        at += len(text(at)) + 1  # its type
        size, = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return header, at + 1


def read_channels(data):
    channels = []
    while data[0]:
        name, data = data.split(b"\0", 1)
        kind, = struct.unpack_from("<i", data)
        channels.append((name.decode(), np.dtype({0: "<u4", 1: "<f2", 2: "<f4"}[kind])))
        data = data[16:]
    return channels


def undo_prediction(data):
    """Bytes are stored as differences, the even ones before the odd ones."""
    sums = np.frombuffer(data, np.uint8).astype(np.int64)
    sums[1:] -= 128
    sums = (np.cumsum(sums) & 255).astype(np.uint8)
    half = (len(sums) + 1) // 2
    result = np.empty_like(sums)
    result[0::2], result[1::2] = sums[:half], sums[half:]
    return result.tobytes()
