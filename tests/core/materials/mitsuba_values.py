#!/usr/bin/env python3
"""Writes mitsuba_values.txt: what BSDFs of Mitsuba 3 say for pairs of directions. mitsuba_values_test.cpp evaluates ours.

    tests/core/materials/mitsuba_values.py > tests/core/materials/mitsuba_values.txt     (made with Mitsuba 3.9.1)

A line `bsdf` holds an XML element. Each line after it: the view and the light direction (local), u and v, r or p for
radiance or power, then f (without the cosine) for red, green and blue, and the density of the light direction.
"""
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
mi.set_log_level(mi.LogLevel.Error)


def rgb(name, *value):
    return f'<rgb name="{name}" value="{", ".join(str(v) for v in value)}"/>'


def numbers(**values):
    return "".join(f'<float name="{name}" value="{value}"/>' for name, value in values.items())


def word(name, value):
    return f'<string name="{name}" value="{value}"/>'


def board(name, a, b):
    return f'<texture type="checkerboard" name="{name}">{numbers(color0=a, color1=b)}</texture>'


def rough_plastics():
    for kind in ("beckmann", "ggx"):
        for alpha in (0.01, 0.1, 0.4, 1.0):
            yield "roughplastic", word("distribution", kind) + numbers(alpha=alpha) + rgb("diffuse_reflectance", 0.9, 0.5, 0.1)
    yield "roughplastic", ('<boolean name="nonlinear" value="true"/>' + numbers(alpha=0.3, int_ior=1.9)
                           + word("distribution", "ggx")
                           + rgb("diffuse_reflectance", 0.9, 0.4, 0.2) + rgb("specular_reflectance", 0.2, 0.6, 1.0))
    yield "roughplastic", numbers(alpha=0.5, int_ior=1.0, ext_ior=1.333) + rgb("diffuse_reflectance", 0.8, 0.4, 0.2)
    for flag in ("false", "true"):
        yield "plastic", f'<boolean name="nonlinear" value="{flag}"/>' + rgb("diffuse_reflectance", 0.9, 0.4, 0.1)


def textured():
    ggx = word("distribution", "ggx")
    yield "roughconductor", word("material", "Cu") + ggx + board("alpha", 0.1, 0.5)
    yield "roughconductor", word("material", "Al") + ggx + board("alpha_u", 0.2, 0.4) + numbers(alpha_v=0.6)
    yield "roughconductor", word("material", "Al") + ggx + rgb("alpha", 0.1, 0.3, 0.5)
    yield "roughdielectric", ggx + board("alpha", 0.2, 0.6)
    yield "roughdielectric", ggx + numbers(alpha_u=0.3) + board("alpha_v", 0.2, 0.6) + word("int_ior", "diamond")


def metals():
    folder = Path(mi.__file__).parent / "data" / "ior"
    for name in ["none"] + sorted(path.name[: -len(".eta.spd")] for path in folder.glob("*.eta.spd")):
        yield "roughconductor", word("material", name) + word("distribution", "ggx") + numbers(alpha=0.3)


def principled():
    red = rgb("base_color", 0.8, 0.3, 0.1)
    yield "principled", ""
    for roughness in (0.0, 0.1, 1.0):
        yield "principled", red + numbers(roughness=roughness)
    yield "principled", red + numbers(metallic=1.0, roughness=0.3)
    yield "principled", red + numbers(metallic=0.4, roughness=0.4, anisotropic=0.8)
    yield "principled", red + numbers(specular=0.9, spec_tint=0.7, roughness=0.3)
    yield "principled", red + numbers(eta=1.8, spec_tint=1.0, metallic=0.3, roughness=0.4)
    yield "principled", red + numbers(eta=0.7, spec_tint=0.6, metallic=0.3, roughness=0.4)
    yield "principled", red + numbers(sheen=0.8)
    yield "principled", red + numbers(sheen=1.0, sheen_tint=0.7, metallic=0.2)
    yield "principled", red + numbers(flatness=0.6, roughness=0.8)
    yield "principled", red + numbers(clearcoat=1.0, clearcoat_gloss=0.2)
    yield "principled", red + numbers(clearcoat=0.7, clearcoat_gloss=1.0, metallic=0.9)
    yield "principled", red + numbers(spec_trans=1.0, roughness=0.4)
    yield "principled", red + numbers(spec_trans=1.0, roughness=0.3, eta=1.7, anisotropic=1.0)
    yield "principled", red + numbers(spec_trans=0.6, roughness=0.5, specular=0.0)
    yield "principled", red + numbers(spec_trans=0.5, eta=1.0, roughness=0.7)
    yield "principled", red + numbers(spec_trans=0.7, eta=0.75, roughness=0.5, spec_tint=0.5)
    everything = dict(roughness=0.45, anisotropic=0.5, metallic=0.3, spec_trans=0.4, spec_tint=0.6, sheen=0.5,
                      sheen_tint=0.4, flatness=0.3, clearcoat=0.8, clearcoat_gloss=0.5, specular=0.7)
    yield "principled", red + numbers(**everything)
    yield "principled", red + numbers(**everything, diffuse_reflectance_sampling_rate=0.3,
                                      main_specular_sampling_rate=2.0, clearcoat_sampling_rate=1.5)
    yield "principled", rgb("base_color", 0, 0, 0) + numbers(**everything)
    boards = {name: board(name, 0.5 * value, value) for name, value in everything.items() if name != "specular"}
    yield "principled", red + "".join(boards.values())
    for name in boards:
        yield "principled", red + boards[name] + numbers(**{k: v for k, v in everything.items() if k != name})


def thin():
    blue = rgb("base_color", 0.2, 0.4, 0.9)
    yield "principledthin", ""
    for roughness in (0.0, 0.2, 1.0):
        yield "principledthin", blue + numbers(spec_trans=1.0, roughness=roughness)
    yield "principledthin", blue + numbers(spec_trans=0.7, roughness=0.3, eta=1.2, spec_tint=0.8)
    yield "principledthin", blue + numbers(spec_trans=0.7, roughness=0.6, eta=0.8, spec_tint=0.5)
    yield "principledthin", blue + numbers(diff_trans=1.2, sheen=0.7, roughness=0.7)
    yield "principledthin", blue + numbers(diff_trans=2.0)
    yield "principledthin", blue + numbers(diff_trans=0.4, flatness=0.8, sheen=0.5, sheen_tint=1.0)
    everything = dict(roughness=0.4, anisotropic=0.6, spec_trans=0.5, eta=1.6, spec_tint=0.4, sheen=0.6,
                      sheen_tint=0.5, flatness=0.4, diff_trans=0.8)
    yield "principledthin", blue + numbers(**everything)
    yield "principledthin", blue + numbers(**everything, diffuse_reflectance_sampling_rate=0.3,
                                           specular_reflectance_sampling_rate=2.0,
                                           specular_transmittance_sampling_rate=0.7,
                                           diffuse_transmittance_sampling_rate=1.6)
    for name, value in everything.items():
        rest = {k: v for k, v in everything.items() if k != name}
        yield "principledthin", blue + board(name, 0.7 * value, value) + numbers(**rest)


def direction(cosine, phi):
    r = np.sqrt(1 - cosine * cosine)
    return [float(r * np.cos(phi)), float(r * np.sin(phi)), float(cosine)]


def write(bsdf_type, inside, pairs, rng):
    xml = f'<bsdf type="{bsdf_type}">{inside}</bsdf>'
    bsdf = mi.load_string(xml.replace("<bsdf ", '<bsdf version="3.0.0" '))
    print("bsdf", xml)
    views = (1.0, 0.8, 0.45, 0.15, 0.02, -0.7, -0.2)
    for i in range(pairs):
        view = direction(views[i % len(views)] if i > 0 else 0.999, 6.2831853 * rng.random())
        si = dr.zeros(mi.SurfaceInteraction3f)
        si.wi = mi.Vector3f(view)
        si.uv = mi.Point2f(*(round(float(x), 3) for x in rng.random(2)))
        # "principledthin" has no modes there, though it is not reciprocal: its values are those of radiance.
        radiance = bsdf_type == "principledthin" or rng.random() < 0.5
        mode = mi.TransportMode.Radiance if radiance else mi.TransportMode.Importance
        context = mi.BSDFContext(mode)
        light = direction(2 * rng.random() - 1, 6.2831853 * rng.random())
        if rng.random() < 0.6:  # inside a lobe
            sample, weight = bsdf.sample(context, si, rng.random(), mi.Point2f(rng.random(), rng.random()))
            if sample.pdf > 0 and max(weight) > 0:
                light = [float(x) for x in sample.wo]
        light = [float(np.float32(x)) for x in light]
        value, pdf = bsdf.eval(context, si, mi.Vector3f(light)), bsdf.pdf(context, si, mi.Vector3f(light))
        f = [float(x) / abs(light[2]) for x in value]
        print(*(f"{float(x):.9g}" for x in view + light), *(f"{x:.3f}" for x in si.uv),
              "r" if mode == mi.TransportMode.Radiance else "p", *(f"{x:.6g}" for x in [*f, float(pdf)]))


def main():
    rng = np.random.default_rng(7)
    for part, pairs in ((rough_plastics, 21), (textured, 14), (metals, 2), (principled, 21), (thin, 21)):
        for bsdf_type, inside in part():
            write(bsdf_type, inside, pairs, rng)


main()
