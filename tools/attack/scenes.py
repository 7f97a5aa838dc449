"""A random scene: number n of a seed is always the same file.

write_scene() writes it with its grids, meshes and pictures into a folder of its own; hostile_scene() does the same for a
given file.
"""
import re
from dataclasses import dataclass, field
from pathlib import Path

from axes import dice, sample_axes
from lights import LightWriter
from media import MediaWriter
from registry import parameter_at_end
from shapes import ShapeWriter
from xml_parts import NULL, Placement, number, real, shape


@dataclass
class Scene:
    name: str
    path: Path
    facts: dict
    define: dict = field(default_factory=dict)  # what -D sets
    watched: tuple = ()  # integrators whose parameters differ: they are watched, and their means not compared


ORIGINS = {"outside": (0, 0.2, 6), "inside": (0.3, 0.1, 1.6), "in_wall": (2, 0, 0.5), "on_boundary": (0.2, -0.3, 1.2),
           "along_wall": (-2, 0.1, 1.9)}


def sensor(axes, place, media, end):
    origin = ORIGINS[axes.camera]
    if axes.camera == "outside" and axes.shell == "closed":
        origin = (0, 0.2, 1.7)
    target = (-2, 0.1, 0) if axes.camera == "along_wall" else (0.05, 0.0, -0.1)
    scale = f'<scale x="{number(2 * place.unit)}" y="{number(2 * place.unit)}"/>' if axes.sensor == "orthographic" else ""
    inside = real("near_clip", 1e-3 * place.unit) + real("far_clip", 1e3 * place.unit) + place.look(origin, target, scale=scale)
    if axes.sensor != "orthographic":
        inside += real("fov", 45)
    if axes.sensor == "thinlens":
        inside += real("aperture_radius", 0.05 * place.unit) + real("focus_distance", 5 * place.unit)
    if axes.media == "sensor":
        inside += media.medium("homogeneous", "", (2, 2, 2), (0, 0, 0))
    category, kind, element = end or ("", "", "")
    sampler = f'<sampler type="{kind}">{element}</sampler>' if category == "sampler" else '<sampler type="sobol"/>'
    rfilter = f'<rfilter type="{kind}">{element}</rfilter>' if category == "rfilter" else '<rfilter type="box"/>'
    width, height = axes.film
    return (f'<sensor type="{axes.sensor}">{inside}{sampler}<film type="hdrfilm"><integer name="width" value="{width}"/>'
            f'<integer name="height" value="{height}"/>{rfilter}</film></sensor>')


def integrators(methods, registry, max_depth, end=None):
    """One element of each type; the program renders by the one that it is called with."""
    category, kind, element = end or ("", "", "")
    blocks = []
    for name in registry.names("integrator"):
        inside = methods[name].xml
        if max_depth > 0 and methods[name].takes_depth and registry.has_parameter(name, "max_depth"):
            inside += f'<integer name="max_depth" value="{max_depth}"/>'
        if category == "integrator" and kind == name:
            parameter = re.search(r'name="(\w+)"', element)[1]
            inside = re.sub(rf'<\w+ name="{parameter}" value="[^"]*"/>', "", inside) + element
        if category in ("selection", "compensation", "visibility") and name == "mote_vpl":
            inside = f'<integer name="paths" value="32"/><{category} name="{category}" type="{kind}">{element}</{category}>'
        blocks.append(f'<integrator type="{name}">{inside}</integrator>')
    return blocks


def things_at_ends(end, place):
    """The object that holds the parameter, where it is one of the scene's."""
    category, kind, element = end or ("", "", "")
    ball = place.transform((0.5, 0.5, 0.5), "", (-0.7, -0.5, 0.6))
    if category == "bsdf":
        nested = "" if 'name="material"' in element else element
        return [shape("sphere", ball + f'<bsdf type="{kind}">{nested}</bsdf>')]
    if category == "medium":
        return [shape("sphere", ball + NULL + f'<medium type="{kind}" name="interior">{element}</medium>')]
    if category == "phase":
        medium = f'<medium type="homogeneous" name="interior"><phase type="{kind}">{element}</phase></medium>'
        return [shape("sphere", ball + NULL + medium)]
    if category == "emitter":
        emitter = f'<emitter type="{kind}">{element}</emitter>'
        return [shape("sphere", ball + emitter) if kind == "area" else emitter]
    return []


def write_scene(seed, n, folder, methods, registry):
    """Scene n of the seed, as folder/scene_<n>/scene.xml."""
    folder = Path(folder) / f"scene_{n}"
    folder.mkdir(parents=True, exist_ok=True)
    rng = dice(seed, n)
    axes = sample_axes(rng)
    end = parameter_at_end(registry, dice(seed, f"{n} end")) if axes.end else None
    place = Placement(axes)
    media = MediaWriter(dice(seed, f"{n} media"), axes, place, folder, registry)
    shapes = ShapeWriter(dice(seed, f"{n} shapes"), axes, place, folder, registry)
    lights = LightWriter(dice(seed, f"{n} lights"), axes, place, folder)
    lines = [*integrators(methods, registry, axes.max_depth, end), sensor(axes, place, media, end), *shapes.all(),
             *media.all(), *lights.all(), *things_at_ends(end, place)]
    path = folder / "scene.xml"
    text = '<scene version="3.0.0">\n' + "\n".join(line for line in lines if line) + "\n</scene>\n"
    path.write_text(text)
    watched = {"integrator": (end[1],), "selection": ("mote_vpl",), "compensation": ("mote_vpl",),
               "visibility": ("mote_vpl",)}.get(end[0], ()) if end else ()
    return Scene(str(n), path, {**axes.facts(), "seed": seed, "end": " ".join(end) if end else "", **contents(text)}, watched=watched)


def hostile_scene(source, folder, methods, registry):
    """A given file with the settings of all integrators; what it names is found beside the original."""
    folder = Path(folder) / source.stem
    folder.mkdir(parents=True, exist_ok=True)
    text = re.sub(r'<integrator type="[^"]*"\s*/>', "", source.read_text())
    blocks = "\n".join([f'<path value="{source.parent.resolve()}"/>', *integrators(methods, registry, -1)])
    path = folder / "scene.xml"
    path.write_text(re.sub(r"(<scene[^>]*>)", lambda m: m[1] + "\n" + blocks, text, count=1))
    return Scene(source.stem, path, {"file": source.stem, **contents(text)})


def contents(text):
    """Facts of scenes with media that vary, with surfaces that are not diffuse, or mirror light, and with a lamp twice at one place."""
    lamps = [line for line in text.splitlines() if line.startswith("<shape") and '<emitter type="area"' in line]
    kinds = set(re.findall(r'<bsdf type="(\w+)"', text)) - {"diffuse", "twosided", "null", "mask", "bumpmap", "normalmap"}
    glass = {"dielectric", "conductor", "plastic"}
    return {"glass": "yes" if kinds & glass else "no", "grids": "yes" if 'type="heterogeneous"' in text else "no", "lobes": "yes" if kinds else "no",
            "lamps": "coincide" if len(set(lamps)) < len(lamps) else "apart"}
