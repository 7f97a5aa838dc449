"""Layers of a picture as Blender's render passes: its own where it has them (depth, normal, position), else by our names."""
import numpy as np

from .exr import read_exr

# Blender's pass, its switch in the view layer, its channels and kind, and our channels.
FEATURES = [("Depth", "use_pass_z", "Z", "VALUE", ["Depth.Z"]),
            ("Normal", "use_pass_normal", "XYZ", "VECTOR", ["N.X", "N.Y", "N.Z"]),
            ("Position", "use_pass_position", "XYZ", "VECTOR", ["P.X", "P.Y", "P.Z"])]


def wants_features(view_layer):
    return any(True for _ in wanted(view_layer))


def wanted(view_layer):
    return (feature for feature in FEATURES if getattr(view_layer, feature[1]))


def colour_layers(planes):
    """Names of the layers with R, G, B besides the picture itself, but for variances and those of features."""
    names = sorted(name[:-2] for name in planes if name.endswith(".R"))
    return [name for name in names if "Variance" not in name and "." not in name]


def register(engine, scene, view_layer):
    engine.register_pass(scene, view_layer, "Combined", 4, "RGBA", "COLOR")
    for name, _, channels, kind, _ in wanted(view_layer):
        engine.register_pass(scene, view_layer, name, len(channels), channels, kind)
    for name in scene.mote.layers.split():
        engine.register_pass(scene, view_layer, name, 3, "RGB", "COLOR")


def show(engine, path, size, begin, view_layer):
    """Puts the picture and its layers into Blender; returns the layers' names."""
    planes = read_exr(path)
    x, y = begin
    cut = lambda names: np.stack([planes[n][y:y + size[1], x:x + size[0]] for n in names], axis=2)[::-1]
    layers = colour_layers(planes)
    for name in layers:
        engine.add_pass(name, 3, "RGB", layer=view_layer.name)
    features = [f for f in wanted(view_layer) if f[4][0] in planes]
    for name, _, channels, _, _ in features:
        engine.add_pass(name, len(channels), channels, layer=view_layer.name)
    result = engine.begin_result(0, 0, *size)
    made = result.layers[0].passes
    picture = cut("RGB")
    fill(made["Combined"], np.concatenate([picture, np.ones_like(picture[..., :1])], axis=2))
    for name in layers:
        fill(made[name], cut([f"{name}.{c}" for c in "RGB"]))
    for name, _, _, _, ours in features:
        fill(made[name], np.nan_to_num(cut(ours), nan=1e10, posinf=1e10) if name == "Depth" else cut(ours))
    engine.end_result(result)
    return layers


def fill(render_pass, values):
    """Blender 3 takes pixels as rows of channels, 4.5 a flat array."""
    rows = np.ascontiguousarray(values, np.float32).reshape(-1, values.shape[2])
    try:
        render_pass.rect.foreach_set(rows)
    except (TypeError, ValueError, RuntimeError):
        render_pass.rect.foreach_set(rows.ravel())
