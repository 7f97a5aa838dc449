"""Media: homogeneous ones inside of meshes, and the grids of volume objects from their .vdb files.

Volume Scatter has sigma_s = density * colour alone, Volume Absorption sigma_a = density * (1 - colour). The principled
volume has sigma_s = density * colour, sigma_a = density * (1 - colour) * (1 - sqrt(absorption colour)) (as Cycles' source
has it), and emits strength * colour [W/(m^3 sr)], which is sigma_a Le here.
"""
import bpy
from mathutils import Matrix, Vector

from .export_textures import constant, source_of
from .scene_xml import add, add_matrix, add_value


def add_homogeneous(export, where, name, node):
    sigma_s, sigma_a, emission, g = coefficients(export, where, node)
    medium = add(export.root, "medium", "homogeneous", sigma_s=sigma_s, sigma_a=sigma_a)
    medium.set("id", name)
    add_phase_and_light(export, where, medium, sigma_a, emission, g)


def add_phase_and_light(export, where, medium, sigma_a, emission, g):
    if g:
        add(medium, "phase", "hg", g=g)
    if any(emission):
        if not all(a > 0 for a, e in zip(sigma_a, emission) if e > 0):
            return export.note(f"{where}: emission where nothing absorbs is left out")
        add_value(medium, "Le", [e / a if e > 0 else 0.0 for e, a in zip(emission, sigma_a)])


def coefficients(export, where, node):
    """sigma_s, sigma_a [1/m], emission [W/(m^3 sr)], and the mean cosine g of the node tree below a Volume socket."""
    none = [0.0] * 3
    if node is None or node.type not in ("VOLUME_SCATTER", "VOLUME_ABSORPTION", "PRINCIPLED_VOLUME", "ADD_SHADER",
                                         "EMISSION"):
        export.note(f"{where}: the volume's node '{node.name if node else 'none'}' is left out")
        return none, none, none, 0.0
    if node.type == "ADD_SHADER":
        return added(export, where, node)
    value = lambda name: constant(export, where, node.inputs[name])
    if node.type == "EMISSION":
        return none, none, [value("Strength") * c for c in value("Color")], 0.0
    density, colour = value("Density"), value("Color")
    if node.type == "VOLUME_ABSORPTION":
        return none, [density * max(1 - c, 0) for c in colour], none, 0.0
    scattered = [density * c for c in colour]
    if node.type == "VOLUME_SCATTER":
        if getattr(node, "phase", "HENYEY_GREENSTEIN") != "HENYEY_GREENSTEIN":
            export.note(f"{where}: the phase function of '{node.name}' is Henyey and Greenstein's")
        return scattered, none, none, value("Anisotropy")
    if value("Blackbody Intensity") > 0:
        export.note(f"{where}: black-body emission is left out")
    absorbed = [density * max(1 - c, 0) * max(1 - max(a, 0)**0.5, 0) for c, a in zip(colour, value("Absorption Color"))]
    return scattered, absorbed, [value("Emission Strength") * c for c in value("Emission Color")], value("Anisotropy")


def added(export, where, node):
    """The sum of two; a mean cosine weighted by their scattering."""
    a, b = (coefficients(export, where, source_of(i)) for i in node.inputs[:2])
    weights = sum(a[0]), sum(b[0])
    if all(weights) and a[3] != b[3]:
        export.note(f"{where}: two phase functions became one of their mean cosine")
    g = (weights[0] * a[3] + weights[1] * b[3]) / max(sum(weights), 1e-30)
    return (*([x + y for x, y in zip(p, q)] for p, q in zip(a[:3], b[:3])), g)


def add_grid(export, obj, matrix, _materials):
    """A volume object: its box, a null boundary, around a grid times the coefficients of a density of 1."""
    volume, where = obj.data, f"volume '{obj.name}'"
    volume.grids.load()
    path = bpy.path.abspath(volume.grids.frame_filepath or volume.filepath)
    name = "density" if "density" in volume.grids.keys() else next(iter(volume.grids.keys()), None)
    if name is None or not path:
        return export.note(f"{where}: no .vdb file with a grid; left out")
    node = grid_node(volume)
    sigma_s, sigma_a, emission, g = coefficients(export, where, node) if node else ([1.0] * 3, [0.0] * 3, [0.0] * 3, 0.0)
    extinction = [s + a for s, a in zip(sigma_s, sigma_a)]
    mean = sum(extinction) / 3
    if max(extinction) - min(extinction) > 1e-6 * mean:
        export.note(f"{where}: an extinction with a colour became its mean")
    if mean <= 0:
        return export.note(f"{where}: without extinction; left out")
    if any(emission):
        export.note(f"{where}: its emission follows the density")
    mean, sigma_a = mean * density_of(volume, matrix), [a * density_of(volume, matrix) for a in sigma_a]
    sigma_s, emission = ([v * density_of(volume, matrix) for v in values] for values in (sigma_s, emission))
    cube = add(export.root, "shape", "cube")
    add_matrix(cube, matrix @ box_matrix(obj, volume.grids[name]))
    add(cube, "bsdf", "null")
    medium = add(cube, "medium", "heterogeneous", "interior", scale=mean,
                 albedo=[min(s / mean, 1.0) for s in sigma_s])
    add_matrix(add(medium, "volume", "vdbvolume", "sigma_t", filename=path, grid=name), matrix)
    add_phase_and_light(export, where, medium, sigma_a, emission, g)


def density_of(volume, matrix):
    """Densities of the space of an object are less where it is larger: Cycles takes its scale along (1, 1, 1)."""
    if volume.render.space != "OBJECT":
        return 1.0
    return 1 / max((matrix.to_3x3() @ Vector((1, 1, 1)).normalized()).length, 1e-9)


def grid_node(volume):
    material = volume.materials[0] if volume.materials else None
    if material is None or not material.use_nodes:
        return None
    output = material.node_tree.get_output_node("CYCLES") or material.node_tree.get_output_node("ALL")
    return source_of(output.inputs["Volume"]) if output else None


def box_matrix(obj, grid):
    """Takes [-1, 1]^3 to the object's bounding box and half a voxel more, which trilinear values reach out of it."""
    corners = [Vector(c) for c in obj.bound_box]
    voxel = Vector(sum(abs(grid.matrix_object[row][column]) for column in range(3)) for row in range(3))
    low, high = (Vector(f(c[i] for c in corners) for i in range(3)) for f in (min, max))
    half = 0.505 * (high - low + voxel)
    return Matrix.Translation((low + high) / 2) @ Matrix.Diagonal((*half, 1))
