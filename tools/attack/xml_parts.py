"""Elements of the scene language as text, placed by unit and offset."""


def number(value):
    return f"{value:.9g}"


def triple(values):
    return ", ".join(number(v) for v in values)


def rgb(name, values):
    return f'<rgb name="{name}" value="{triple(values)}"/>'


def real(name, value):
    return f'<float name="{name}" value="{number(value)}"/>'


def xyz(values):
    return " ".join(f'{axis}="{number(v)}"' for axis, v in zip("xyz", values))


class Placement:
    """From canonical lengths to those of the scene: times `unit`, then moved by `offset` along (1, 0.7, -0.4)."""

    def __init__(self, axes):
        self.unit = axes.unit
        self.offset = tuple(axes.unit * axes.offset * d for d in (1.0, 0.7, -0.4))

    def point(self, p):
        return tuple(self.unit * c + o for c, o in zip(p, self.offset))

    def transform(self, scale=(1, 1, 1), rotate="", translate=(0, 0, 0)):
        """to_world of a shape: `rotate` is an element or empty."""
        moved = f"<translate {xyz(self.offset)}/>" if any(self.offset) else ""
        unit = f'<scale value="{number(self.unit)}"/>' if self.unit != 1.0 else ""
        return (f'<transform name="to_world"><scale {xyz(scale)}/>{rotate}<translate {xyz(translate)}/>{unit}{moved}'
                "</transform>")

    def look(self, origin, target, up=(0, 1, 0), scale=""):
        where = f'origin="{triple(self.point(origin))}" target="{triple(self.point(target))}" up="{triple(up)}"'
        return f'<transform name="to_world">{scale}<lookat {where}/></transform>'


def shape(kind, inside, name=""):
    return f'<shape type="{kind}"{name}>{inside}</shape>'


def diffuse(values):
    return f'<bsdf type="twosided"><bsdf type="diffuse">{rgb("reflectance", values)}</bsdf></bsdf>'


NULL = '<bsdf type="null"/>'
