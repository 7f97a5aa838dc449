"""A short way to write Blender's node trees: nodes whose inputs are numbers, colours, or outputs of other nodes."""
import bpy


class Nodes:
    def __init__(self, tree):
        self.tree = tree
        tree.nodes.clear()

    def add(self, kind, output=0, inputs=(), **settings):
        """An output of a new node. `inputs`: by position or by name; `settings`: its properties."""
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for key, value in (inputs.items() if isinstance(inputs, dict) else enumerate(inputs)):
            self.connect(node.inputs[key], value)
        return node.outputs[output] if len(node.outputs) else node

    def connect(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, (list, tuple)) and len(value) == 3 and len(socket.default_value) == 4:
            socket.default_value = (*value, 1.0)
        else:
            socket.default_value = value

    def math(self, operation, *inputs, clamp=False):
        return self.add("ShaderNodeMath", inputs=inputs, operation=operation, use_clamp=clamp)

    def mix_colours(self, weight, first, second):
        return self.add("ShaderNodeMixRGB", inputs=(weight, first, second))

    def scaled(self, colour, factor):
        return self.add("ShaderNodeMixRGB", inputs=(1.0, colour, factor), blend_type="MULTIPLY")

    def output(self, kind, **shaders):
        """The end of the tree: `Surface` or `Volume`."""
        self.add(kind, inputs=shaders)
