#!/usr/bin/env python3
"""Hash of the pixels of an EXR file in scan lines, every channel, whatever its metadata: equal bits have equal hashes, if one
program has written both files.

  tools/pixel_hash.py PICTURE.exr...
"""
import hashlib
import struct
import sys

LINES_OF_CHUNK = (1, 1, 1, 16, 32, 16, 32, 32, 32, 256)  # by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB


def pixel_hash(path):
    """SHA-1 of the chunks, which hold line number, size and compressed values, and no offset that the header could move."""
    with open(path, "rb") as file:
        data = file.read()
    magic, version = struct.unpack_from("<II", data)
    if magic != 20000630 or version & 0x1200:  # tiles, several parts
        raise ValueError(f"{path}: not an EXR file in scan lines")
    attributes, at = {}, 8
    while data[at]:
        name, kind = data[at:at + 512].split(b"\0", 2)[:2]
        start = at + len(name) + len(kind) + 2
        size, = struct.unpack_from("<I", data, start)
        attributes[name] = data[start + 4:start + 4 + size]
        at = start + 4 + size
    _, first, _, last = struct.unpack("<4i", attributes[b"dataWindow"])
    lines = LINES_OF_CHUNK[attributes[b"compression"][0]]
    chunks = -(-(last - first + 1) // lines)
    return hashlib.sha1(data[at + 1 + 8 * chunks:]).hexdigest()


if __name__ == "__main__":
    for picture in sys.argv[1:]:
        print(pixel_hash(picture), picture)
