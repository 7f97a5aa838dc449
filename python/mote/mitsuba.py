"""mote's integrators in Mitsuba 3: `import mote.mitsuba` registers them, `mi.render` returns mote's picture.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import mote.mitsuba
    scene = mi.load_file("scene.xml", integrator="mote_vpl")   # or mi.load_dict({..., "integrator": {"type": "mote_vpl"}})
    picture = mi.render(scene, spp=16)                         # 16 passes; the layers: scene.integrator().layers

What is rendered is the scene as it was loaded, from Mitsuba's parser, which keeps all parameters; changes by
mi.traverse() are not seen. It is written as XML (export()) and rendered by the `mote` command (MOTE_COMMAND of the
environment, or `mote` on the path), so the bits are those of the command on that file. What mote lacks is an error
in its words. `path` and `volpath` are called mote_path and mote_volpath here. Nothing is differentiated.
"""
import os
import re
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import mitsuba as mi

TYPES = ("mote_bdpt", "mote_epipolar", "mote_layers", "mote_micro_rendering", "mote_path", "mote_photon_map",
         "mote_ray_bundles", "mote_ray_lights", "mote_single_scattering", "mote_upbp", "mote_volpath", "mote_vpl", "mote_vpl_ray_bundles", "mote_vsl")
RENAMED = {"mote_path": "path", "mote_volpath": "volpath"}  # Mitsuba has its own of these names
PATHS = ("filename",)
# Objects that integrators of mote hold and Mitsuba has no word for. Its parser sees each as an integrator
# `mote_compensation`, ... whose type in mote is a text of this name; export() turns them back.
PARTS = ("compensation", "visibility", "selection")
PART_TYPE = "mote_type"
_PART_TAG = re.compile(rf"<(/?)({'|'.join(PARTS)})\b([^<>]*?)(/?)>")


def _tag_for_mitsuba(match):
    closing, part, attributes, empty = match.groups()
    if closing:
        return "</integrator>"
    kind = re.search(r"""\btype\s*=\s*(["'])(.*?)\1""", attributes)
    if not kind:
        return match.group(0)
    name = "" if re.search(r"\bname\s*=", attributes) else f' name="{part}"'
    return (f'<integrator type="mote_{part}"{name}{attributes[:kind.start()]}{attributes[kind.end():]}>'
            f'<string name="{PART_TYPE}" value="{kind.group(2)}"/>' + ("</integrator>" if empty else ""))


def _text_for_mitsuba(text):
    """A scene file with the parts of our integrators as Mitsuba's parser takes them, line by line as it was."""
    return _PART_TAG.sub(_tag_for_mitsuba, text)


def _dict_for_mitsuba(value, part=None):
    """The same of a dictionary: {"type": "mote_vpl", "compensation": {"type": "approximate", ...}}."""
    if not isinstance(value, dict):
        return value
    ours = part or value.get("type") in TYPES
    def part_of(key):
        return key if key in PARTS else part  # the compensation `media` of a compensation
    result = {key: _dict_for_mitsuba(inner, part_of(key) if ours and isinstance(inner, dict) else None)
              for key, inner in value.items()}
    if part:
        result.update({"type": f"mote_{part}", PART_TYPE: value.get("type", "")})
    return result


def _parsed(parse, source, parameters):
    """The scene as text, as the parser has it."""
    config = mi.parser.ParserConfig(mi.variant())
    return mi.parser.write_string(parse(config, source, **parameters))


def _remember(scene, parse, source, folder, parameters):
    """Leaves with the scene's integrator, if it is one of ours, its XML and the folder of its file names."""
    if isinstance(scene, mi.Scene) and hasattr(scene.integrator(), "source"):
        scene.integrator().source = (_parsed(parse, source, parameters), Path(folder).absolute())
    return scene


def load_file(path, parallel=True, optimize=True, **parameters):
    """mi.load_file, whose scenes mote can render; <compensation>, <visibility> and <selection> of the file are known."""
    folder = Path(path).absolute().parent
    text = Path(path).read_text() if Path(path).is_file() else ""
    if _PART_TAG.search(text):
        mi.file_resolver().prepend(str(folder))
        text = _text_for_mitsuba(text)
        try:
            scene = mi.load_string(text, parallel=parallel, optimize=optimize, **parameters)
        except RuntimeError as error:
            raise RuntimeError(f"{path}: {error}") from None
        return _remember(scene, mi.parser.parse_string, text, folder, parameters)
    scene = _load_file(str(path), parallel=parallel, optimize=optimize, **parameters)
    return _remember(scene, mi.parser.parse_file, str(path), Path(path).parent, parameters)


def load_dict(dictionary, *arguments, **named):
    """mi.load_dict, whose scenes mote can render; integrators of mote may hold their compensation, visibility, selection."""
    dictionary = _dict_for_mitsuba(dictionary)
    return _remember(_load_dict(dictionary, *arguments, **named), mi.parser.parse_dict, dictionary, ".", {})


def export(scene, path):
    """Writes a scene of mi.load_file or mi.load_dict as XML for `mote render`; file names in it are absolute."""
    source = getattr(scene.integrator(), "source", None)
    if source is None:
        raise RuntimeError("mote renders scenes that mi.load_file or mi.load_dict has loaded after 'import "
                           "mote.mitsuba', with one of mote's integrators")
    text, folder = source
    root = ElementTree.fromstring(text)
    for element in root.iter("string"):
        if element.get("name") in PATHS:
            element.set("value", str(_resolved(element.get("value"), folder)))
    for element in list(root.iter("integrator")):
        kind = element.get("type")
        element.set("type", RENAMED.get(kind, kind))
        if kind.removeprefix("mote_") in PARTS:
            text = next(e for e in element if e.get("name") == PART_TYPE)
            element.remove(text)
            element.tag = kind.removeprefix("mote_")
            element.set("type", text.get("value"))
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _resolved(name, folder):
    if (folder / name).exists():
        return folder / name
    return Path(str(mi.file_resolver().resolve(name))).absolute()


def _channels(path):
    """The layers of an EXR file: {name: array of (height, width, channels)}, "" for the picture."""
    return {"" if name == "<root>" else name: bitmap for name, bitmap in mi.Bitmap(str(path)).split()}


def _make(kind):
    """The class of one type, for the variant that is set now: mi.Integrator itself cannot be inherited from."""
    class MoteIntegrator(mi.SamplingIntegrator):
        def __init__(self, props):
            super().__init__(props)
            for name in props.keys():  # Mitsuba refuses what was not queried; mote does so itself
                props[name]
            self.layers, self.source = {}, None

        def to_string(self):
            return f"{kind}[by the mote command]"

        def render(self, scene, sensor=0, seed=0, spp=0, develop=True, evaluate=True):
            """One picture; a pass is one sample. `layers` has its layers afterwards, as Bitmaps."""
            if not (sensor == 0 if isinstance(sensor, int) else sensor is scene.sensors()[0]):
                raise RuntimeError("mote renders the scene's first sensor")
            with tempfile.TemporaryDirectory(prefix="mote_") as folder:
                file, picture = Path(folder) / "scene.xml", Path(folder) / "picture.exr"
                export(scene, file)
                command = [os.environ.get("MOTE_COMMAND", "mote"), "render", str(file), "-o", str(picture), "--quiet",
                           "--seed", str(int(seed))] + (["--passes", str(int(spp))] if spp else [])
                done = subprocess.run(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
                if done.returncode != 0:
                    raise RuntimeError(done.stderr.strip().replace(str(file), "the exported scene"))
                self.layers = _channels(picture)
            return mi.TensorXf(self.layers[""])

    return lambda props: MoteIntegrator(props)


def _register(*_):
    if mi.variant() is not None:
        for kind in TYPES + tuple(f"mote_{part}" for part in PARTS):
            mi.register_integrator(kind, _make(kind))


if mi.variant() is None:
    raise ImportError("mote.mitsuba: choose one of Mitsuba's variants first (mi.set_variant)")
_load_file, _load_dict = mi.load_file, mi.load_dict
mi.load_file, mi.load_dict = load_file, load_dict
_register()
if hasattr(mi.detail, "add_variant_callback"):
    mi.detail.add_variant_callback(_register)
