"""Surface nodes of patches under a white sky of radiance 1, and the radiance that each must have."""
import bpy

BLACK, GREY, WHITE = (0, 0, 0, 1), (0.4, 0.4, 0.4, 1), (0.8, 0.8, 0.8, 1)


def surface(name, make):
    """A material whose surface is what make(tree) returns."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(make(tree).outputs[0], output.inputs["Surface"])
    return made


def diffuse(colour):
    return lambda tree: node(tree, "ShaderNodeBsdfDiffuse", Color=colour)


def emission(strength):
    return lambda tree: node(tree, "ShaderNodeEmission", Color=(1, 1, 1, 1), Strength=strength)


def clear(colour):
    return lambda tree: node(tree, "ShaderNodeBsdfTransparent", Color=colour)


def node(tree, kind, **inputs):
    made = tree.nodes.new(kind)
    for name, value in inputs.items():
        made.inputs[name].default_value = value
    return made


def mix(factor, first, second):
    def make(tree):
        made = tree.nodes.new("ShaderNodeMixShader")
        made.inputs[0].default_value = factor
        for socket, part in zip((made.inputs[1], made.inputs[2]), (first, second)):
            tree.links.new(part(tree).outputs[0], socket)
        return made
    return make


def total(first, second):
    def make(tree):
        made = tree.nodes.new("ShaderNodeAddShader")
        for socket, part in zip(made.inputs, (first, second)):
            tree.links.new(part(tree).outputs[0], socket)
        return made
    return make


def mirror(tree):
    made = node(tree, "ShaderNodeBsdfGlossy", Color=WHITE, Roughness=0.0)
    made.distribution = "GGX"
    return made


def held(tree):
    """A colour and a factor that come out of nodes of their own, the shader through a reroute."""
    made, value, colour = diffuse(BLACK)(tree), tree.nodes.new("ShaderNodeRGB"), tree.nodes.new("NodeReroute")
    value.outputs[0].default_value = GREY
    tree.links.new(value.outputs[0], made.inputs["Color"])
    tree.links.new(made.outputs[0], colour.inputs[0])
    return colour


PATCHES = [("diffuse", diffuse(WHITE), 0.8),
           ("colour of a node", held, 0.4),
           ("mirror", mirror, 0.8),
           ("mix", mix(0.25, diffuse(WHITE), diffuse(BLACK)), 0.6),
           ("mix in a mix", mix(0.5, diffuse(GREY), mix(0.25, diffuse(WHITE), diffuse(BLACK))), 0.5),
           ("mix with transparent first", mix(0.75, clear((1, 1, 1, 1)), diffuse(WHITE)), 0.25 + 0.75 * 0.8),
           ("mix with transparent second", mix(0.25, diffuse(WHITE), clear((1, 1, 1, 1))), 0.25 + 0.75 * 0.8),
           ("mix with emission", mix(0.25, diffuse(WHITE), emission(2.0)), 0.75 * 0.8 + 0.25 * 2),
           ("add of emission", total(diffuse(GREY), emission(0.3)), 0.7),
           ("grey transparent", clear((0.5, 0.5, 0.5, 1)), 0.5)]
