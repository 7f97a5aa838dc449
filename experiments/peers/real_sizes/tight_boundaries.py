"""Boundaries of grids for Mitsuba: rays that cross one beside its grid come out black in Mitsuba 3.9.1 (volpath; the sky
around the cloud of scenes/cloud.xml). A cube around a smaller grid is therefore shrunk to the grid's box, outside of
which there is nothing to meet."""
import struct
import xml.etree.ElementTree as ElementTree

import numpy as np
from flat_scene import matrix_of

MARGIN = 1e-4   # of the box's size, beyond it


def grid_box(path):
    """Lowest and highest corner in a .vol file: 'VOL', version, encoding, three sizes, channels, then the box."""
    data = path.read_bytes()[:48]
    if data[:3] != b"VOL":
        raise RuntimeError(f"{path}: no Mitsuba grid")
    return np.array(struct.unpack("<6f", data[24:48])).reshape(2, 3)


def box_of(corners, matrix):
    """The smallest box along the axes around a transformed one."""
    low, high = corners
    points = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    moved = points @ matrix[:3, :3].T + matrix[:3, 3]
    return np.array([moved.min(axis=0), moved.max(axis=0)])


def tighten(folder):
    """Rewrites folder/scene.xml; returns a line for each boundary that changed."""
    path, notes = folder / "scene.xml", []
    tree = ElementTree.parse(path)
    media = {m.get("id"): m for m in tree.getroot().iter("medium") if m.get("type") == "heterogeneous"}
    for shape in tree.getroot().findall("shape"):
        inside = next((r.get("id") for r in shape.findall("ref") if r.get("name") == "interior"), None)
        volume = media[inside].find("volume[@name='sigma_t']") if inside in media else None
        if volume is None or volume.get("type") != "gridvolume" or shape.get("type") != "cube":
            continue
        transform = shape.find("transform")
        boundary = box_of(np.array([[-1.0] * 3, [1.0] * 3]), matrix_of(transform))
        file = folder / volume.find("string[@name='filename']").get("value")
        grid = box_of(grid_box(file), matrix_of(volume.find("transform")))
        tight = np.array([np.maximum(boundary[0], grid[0]), np.minimum(boundary[1], grid[1])])
        if (np.abs(tight - boundary) <= MARGIN * (boundary[1] - boundary[0])).all():
            continue
        half = 0.5 * (tight[1] - tight[0]) * (1 + MARGIN)
        transform.clear()
        transform.set("name", "to_world")
        for tag, values in (("scale", half), ("translate", tight.mean(axis=0))):
            ElementTree.SubElement(transform, tag, dict(zip("xyz", map(repr, map(float, values)))))
        notes.append("the boundary of its medium was shrunk to the box of the grid")
    tree.write(path)
    return notes
