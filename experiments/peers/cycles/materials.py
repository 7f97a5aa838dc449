"""Surfaces of the exported scene as nodes of Cycles. What has no counterpart is said, never left out in silence.

Equal: diffuse, twosided, null, checkerboards, emission of one side. Near: conductors (Schlick's Fresnel around the value
at normal incidence), plastics (the albedo for every direction of view), glass (Cycles' own BSDF).
"""
import bpy
import numpy as np
from nodes import Nodes
from rough_interface import RoughInterface

INDEX = {"bk7": 1.5046, "air": 1.000277, "water": 1.3330, "polypropylene": 1.49}


class Materials:
    """One material for each BSDF and emitter; `notes` says what is not the same."""

    def __init__(self, notes):
        self.notes, self.made = notes, {}

    def of(self, shape):
        bsdf, emitter = shape.child("bsdf"), shape.child("emitter")
        radiance = tuple(emitter.rgb("radiance")) if emitter is not None else None
        key = (id(bsdf) if bsdf is not None else None, radiance)
        if key not in self.made:
            self.made[key] = self.make(bsdf, radiance)
        return self.made[key]

    def make(self, bsdf, radiance):
        material = bpy.data.materials.new(bsdf.id if bsdf is not None else "surface")
        material.use_nodes = True
        nodes = Nodes(material.node_tree)
        shader = self.surface(nodes, bsdf) if bsdf is not None else diffuse(nodes, [0.5] * 3)
        if radiance:
            shader = nodes.add("ShaderNodeAddShader", inputs=(shader, one_sided(nodes, radiance)))
        nodes.output("ShaderNodeOutputMaterial", Surface=shader)
        return material

    def surface(self, nodes, bsdf):
        while bsdf.type in ("twosided", "mask"):
            bsdf = bsdf.child("bsdf")
        kinds = {"diffuse": self.lambert, "conductor": conductor, "roughconductor": conductor, "plastic": plastic,
                 "roughplastic": plastic, "dielectric": glass, "roughdielectric": glass}
        if bsdf.type not in kinds:
            self.notes.append(f"bsdf '{bsdf.type}' {bsdf.id!r}: a grey diffuse stands in its place")
            return diffuse(nodes, [0.5] * 3)
        for texture in bsdf.all("texture"):
            if bsdf.type != "diffuse" or texture.type != "checkerboard":
                self.notes.append(f"texture '{texture.type}' of {bsdf.id!r} is left out")
        if kinds[bsdf.type] in (conductor, plastic, glass):
            self.notes.append(f"bsdf '{bsdf.type}' {bsdf.id!r} is near, not equal")
        return kinds[bsdf.type](nodes, bsdf)

    def lambert(self, nodes, bsdf):
        texture = bsdf.child("texture")
        if texture is not None and texture.type == "checkerboard":
            return diffuse(nodes, checkerboard(nodes, texture))
        return diffuse(nodes, bsdf.rgb("reflectance", 0.5))


def diffuse(nodes, colour):
    return nodes.add("ShaderNodeBsdfDiffuse", inputs={"Color": colour, "Roughness": 0.0})


def one_sided(nodes, radiance):
    """Area lights shine from the side of their normal alone."""
    front = nodes.math("SUBTRACT", 1.0, nodes.add("ShaderNodeNewGeometry", "Backfacing"))
    return nodes.add("ShaderNodeEmission", inputs={"Color": radiance, "Strength": front})


def checkerboard(nodes, texture):
    """Two fields to a period. Where both are of the same parity Blender takes its second colour, Mitsuba color0."""
    matrix = texture.transforms.get("to_uv", np.eye(4))
    uv = nodes.add("ShaderNodeTexCoord", "UV")
    scaled = nodes.add("ShaderNodeVectorMath", inputs=(uv, (2 * matrix[0, 0], 2 * matrix[1, 1], 0.0)),
                       operation="MULTIPLY")
    return nodes.add("ShaderNodeTexChecker", inputs={"Vector": scaled, "Color1": texture.rgb("color1", 0.2),
                                                     "Color2": texture.rgb("color0", 0.4), "Scale": 1.0})


def glossy(nodes, bsdf, colour):
    """Blender squares its roughness; Mitsuba's default is Beckmann."""
    alpha = float(bsdf.get("alpha", 0.1)) if bsdf.type.startswith("rough") else 0.0
    kind = {"ggx": "GGX", "beckmann": "BECKMANN"}[bsdf.get("distribution", "beckmann")] if alpha else "GGX"  # of roughness 0
    return nodes.add("ShaderNodeBsdfGlossy", inputs={"Color": colour, "Roughness": alpha**0.5}, distribution=kind)


def conductor(nodes, bsdf):
    """R = s (R0 + (1 - R0) (1 - cos)^5) with the cosine of the surface, not of the facet; R0 of eta and k, s specular_reflectance."""
    eta, k, scale = (np.array(bsdf.rgb(name, value)) for name, value in (("eta", 0.0), ("k", 1.0), ("specular_reflectance", 1.0)))
    normal = ((eta - 1)**2 + k**2) / ((eta + 1)**2 + k**2) * scale
    facing = nodes.add("ShaderNodeLayerWeight", "Facing", inputs={"Blend": 0.5})
    return glossy(nodes, bsdf, nodes.mix_colours(nodes.math("POWER", facing, 5.0), normal.tolist(), scale.tolist()))


def plastic(nodes, bsdf):
    """A glossy coat over a diffuse base, each with the albedo of Mitsuba's for every direction of view:

    coat(o) = R(o), base(o) = rho T(o) T_mean / (eta^2 (1 - F_in)), rho F_in in place of F_in where `nonlinear`.
    The base also depends on the direction of the light there, by T(i) / T_mean, and the coat's Fresnel on the facet.
    """
    eta, rho = ratio(bsdf, INDEX["polypropylene"]), np.array(bsdf.rgb("diffuse_reflectance", 0.5))
    alpha = float(bsdf.get("alpha", 0.1)) if bsdf.type.startswith("rough") else 0.0
    table = RoughInterface(eta, alpha, bsdf.get("distribution", "beckmann"))
    below = rho * table.inside if bsdf.get("nonlinear", False) else np.full(3, table.inside)
    base = rho * table.mean_transmittance / eta**2 / (1 - below)
    coat = glossy(nodes, bsdf, by_cosine(nodes, table.cosines, table.coat_share))
    colour = nodes.scaled(base.tolist(), by_cosine(nodes, table.cosines, table.transmittance))
    return nodes.add("ShaderNodeAddShader", inputs=(diffuse(nodes, colour), coat))


def by_cosine(nodes, cosines, values):
    """A grey that follows the cosine between the normal and the direction of view; at most 32 values."""
    cosine = nodes.math("SUBTRACT", 1.0, nodes.add("ShaderNodeLayerWeight", "Facing", inputs={"Blend": 0.5}))
    made = nodes.add("ShaderNodeValToRGB", inputs=(cosine,))
    ramp = made.node.color_ramp
    ramp.interpolation = "LINEAR"
    while len(ramp.elements) < len(cosines):
        ramp.elements.new(0.5)
    for element, cosine, value in zip(ramp.elements, cosines, values):
        element.position, element.color = float(cosine), (float(value),) * 3 + (1.0,)
    return made


def glass(nodes, bsdf):
    alpha = float(bsdf.get("alpha", 0.1)) if bsdf.type.startswith("rough") else 0.0
    kind = "GGX" if not alpha or bsdf.get("distribution") == "ggx" else "BECKMANN"
    return nodes.add("ShaderNodeBsdfGlass", inputs={"Color": [1.0] * 3, "Roughness": alpha**0.5,
                                                    "IOR": ratio(bsdf, 1.5046)}, distribution=kind)


def ratio(bsdf, default):
    """Ratio of the indices of refraction, inside over outside."""
    index = lambda value: INDEX[value] if isinstance(value, str) else float(value)
    return index(bsdf.get("int_ior", default)) / index(bsdf.get("ext_ior", INDEX["air"]))

