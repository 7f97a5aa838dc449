"""Media of the exported scene: homogeneous ones in their meshes, VDB grids as Blender's volume objects.

sigma_s = albedo * density and sigma_a = (1 - albedo) * density are a Volume Scatter and a Volume Absorption of the same
density and colour. Cycles tracks through grids without bias; homogeneous media are analytic. A grid's boundary in our scenes may be
smaller than the grid: it is cut there.
"""
import bpy
import numpy as np
from mathutils import Matrix
from nodes import Nodes


def scattering(nodes, albedo, density, phase):
    g = float(phase.get("g", 0.0)) if phase is not None and phase.type == "hg" else 0.0
    scatter = nodes.add("ShaderNodeVolumeScatter", inputs={"Color": albedo, "Density": density, "Anisotropy": g})
    absorb = nodes.add("ShaderNodeVolumeAbsorption", inputs={"Color": albedo, "Density": density})
    return nodes.add("ShaderNodeAddShader", inputs=(scatter, absorb))


def new_material(name, job):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.cycles.volume_sampling = job["volume_sampling"]
    return material, Nodes(material.node_tree)


def check(medium, notes):
    phase = medium.child("phase")
    if phase is not None and phase.type not in ("isotropic", "hg"):
        notes.append(f"phase function '{phase.type}' became isotropic")
    if medium.child("volume", "albedo") is not None:
        notes.append("an albedo that varies is left out")


def homogeneous(medium, job, notes):
    """The material of a mesh that holds it; its extinction must have no colour."""
    check(medium, notes)
    scale = float(medium.get("scale", 1.0))
    extinction = np.array(medium.rgb("sigma_t")) * scale
    if np.ptp(extinction) > 0:
        notes.append("an extinction with a colour became its mean")
    material, nodes = new_material("medium", job)
    nodes.output("ShaderNodeOutputMaterial", Volume=scattering(nodes, medium.rgb("albedo", 0.75), extinction.mean(),
                                                              medium.child("phase")))
    return material


def grid(medium, boundary, vdb, job, notes):
    """A volume object of the VDB file, which is zero outside of the boundary's box."""
    file, name, matrix = vdb
    check(medium, notes)
    volume = bpy.data.volumes.new("grid")
    volume.filepath = file
    volume.grids.load()
    volume.render.precision, volume.render.clipping = "FULL", 0.0
    volume.render.space = "WORLD"  # in object space the density grows as the object is scaled down
    made = bpy.data.objects.new("grid", volume)
    made.matrix_world = Matrix(matrix)
    bpy.context.scene.collection.objects.link(made)
    material, nodes = new_material("grid", job)
    material.cycles.volume_interpolation = "LINEAR"
    density = nodes.math("MULTIPLY", nodes.add("ShaderNodeAttribute", "Fac", attribute_name=name),
                         float(medium.get("scale", 1.0)))
    if job["cut_grids"]:
        density = nodes.math("MULTIPLY", density, inside_of_box(nodes, boundary))
    nodes.output("ShaderNodeOutputMaterial", Volume=scattering(nodes, medium.rgb("albedo", 0.75), density,
                                                              medium.child("phase")))
    volume.materials.append(material)


def inside_of_box(nodes, boundary):
    """1 where the position lies in the box of the boundary, whose sides follow the axes; else 0."""
    low, high = boundary.positions.min(axis=0), boundary.positions.max(axis=0)
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    position = nodes.add("ShaderNodeNewGeometry", "Position")
    away = nodes.add("ShaderNodeVectorMath", inputs=(position, tuple(centre)), operation="SUBTRACT")
    away = nodes.add("ShaderNodeVectorMath", inputs=(away, tuple(half)), operation="DIVIDE")
    away = nodes.add("ShaderNodeVectorMath", inputs=(away,), operation="ABSOLUTE")
    largest = nodes.add("ShaderNodeSeparateXYZ", inputs=(away,)).node.outputs
    return nodes.math("LESS_THAN", nodes.math("MAXIMUM", nodes.math("MAXIMUM", largest[0], largest[1]), largest[2]), 1.0)
