#!/usr/bin/python3
"""Scenes with many lights: what choosing them by the receiver buys.

Two scenes are written: a long hall with 10,000 small panels of light, and 1,000 spot lights in fog. Each is rendered
with a number of passes that takes about the processor seconds requested, and held against a long render of the same
program (in the fog by equi-angular sampling, another estimator); with --against PROGRAM also another program, such as
the `mote` of a commit before, is given the same seconds. A long render that is there already is not made again. Prints the
squared relative RMSE (measure.py) and processor seconds, and the ratio of their products.
"""
import argparse
import random
import resource
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "figures"))
import numpy as np
from exr import read_exr
from measure import series_error, use

ROOT = Path(__file__).resolve().parent.parent.parent

HEAD = """<scene version="3.0.0">
<integrator type="{integrator}"/>
<sensor type="perspective"><float name="fov" value="70"/>
<transform name="to_world"><lookat origin="{eye}" target="{target}" up="0, 1, 0"/></transform>
<sampler type="sobol"/>
<film type="hdrfilm"><integer name="width" value="{width}"/><integer name="height" value="{height}"/>
<rfilter type="box"/></film></sensor>
<bsdf type="twosided" id="wall"><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.55, 0.5"/></bsdf></bsdf>
<bsdf type="twosided" id="box"><bsdf type="diffuse"><rgb name="reflectance" value="0.3, 0.4, 0.6"/></bsdf></bsdf>
"""


def rectangle(scale, rotate, at, inside):
    return (f'<shape type="rectangle"><transform name="to_world"><scale x="{scale[0]}" y="{scale[1]}" z="1"/>'
            f'<rotate {rotate[0]}="1" angle="{rotate[1]}"/><translate x="{at[0]}" y="{at[1]}" z="{at[2]}"/></transform>'
            f"{inside}</shape>\n")


def cube(size, at):
    return (f'<shape type="cube"><transform name="to_world"><scale x="{size[0]}" y="{size[1]}" z="{size[2]}"/>'
            f'<translate x="{at[0]}" y="{at[1]}" z="{at[2]}"/></transform><ref id="box"/></shape>\n')


def hall(count, width, height):
    """A hall of 20 x 8 x 100 m: panels of light in rows on both walls and under the ceiling, blocks on the floor."""
    rng = random.Random(1)
    text = HEAD.format(integrator="path", eye="3, 2.5, 2", target="-1, 2.5, 40", width=width, height=height)
    for scale, rotate, at in (((10, 50), ("x", -90), (0, 0, 50)), ((10, 50), ("x", 90), (0, 8, 50)),
                              ((50, 4), ("y", 90), (-10, 4, 50)), ((50, 4), ("y", -90), (10, 4, 50)),
                              ((10, 4), ("y", 180), (0, 4, 100)), ((10, 4), ("y", 0), (0, 4, 0))):
        text += rectangle(scale, rotate, at, '<ref id="wall"/>')
    for _ in range(60):
        size = [rng.uniform(0.3, 1.0), rng.uniform(0.3, 2.0), rng.uniform(0.3, 1.0)]
        text += cube(size, (rng.uniform(-8, 8), size[1], rng.uniform(5, 98)))
    for i in range(count):
        z, power = rng.uniform(0.5, 99.5), 30.0 * 10 ** rng.uniform(0.0, 1.0)
        colour = ", ".join(f"{power * rng.uniform(0.4, 1.0):.3f}" for _ in range(3))
        light = f'<emitter type="area"><rgb name="radiance" value="{colour}"/></emitter>'
        place = i % 3
        if place == 0:
            text += rectangle((0.03, 0.03), ("x", 90), (rng.uniform(-9.5, 9.5), 7.98, z), light)
        else:
            side = 9.98 if place == 1 else -9.98
            text += rectangle((0.03, 0.03), ("y", -90 if place == 1 else 90), (side, rng.uniform(0.5, 7.5), z), light)
    return text + "</scene>\n"


def spots(count, width, height):
    """1,000 spot lights hanging over a square of 60 x 60 m in fog, pointing down and aside."""
    rng = random.Random(2)
    text = HEAD.format(integrator="volpath", eye="0, 5, -33", target="0, 3, 0", width=width, height=height)
    text += rectangle((30, 30), ("x", -90), (0, 0, 0), '<ref id="wall"/>')
    for _ in range(60):
        size = [rng.uniform(0.3, 1.0), rng.uniform(0.5, 2.5), rng.uniform(0.3, 1.0)]
        text += cube(size, (rng.uniform(-28, 28), size[1], rng.uniform(-26, 28)))
    for _ in range(count):
        x, z, y = rng.uniform(-29, 29), rng.uniform(-29, 29), rng.uniform(5, 8)
        colour = ", ".join(f"{rng.uniform(2, 12):.3f}" for _ in range(3))
        text += (f'<emitter type="spot"><rgb name="intensity" value="{colour}"/><float name="cutoff_angle" value="25"/>'
                 f'<transform name="to_world"><lookat origin="{x}, {y}, {z}" target="{x + rng.uniform(-2, 2)}, 0, '
                 f'{z + rng.uniform(-2, 2)}" up="0, 0, 1"/></transform></emitter>\n')
    text += ('<shape type="cube"><transform name="to_world"><scale x="31" y="6" z="36"/><translate x="0" y="5.99" z="0"/>'
             '</transform><bsdf type="null"/><ref name="interior" id="fog"/></shape>\n')
    fog = ('<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="0.03"/><rgb name="albedo" value="0.8"/>'
           '</medium>\n')
    return (text + "</scene>\n").replace("<shape", fog + "<shape", 1)


def picture_of(file):
    """Without lights that are seen: there is nothing to choose."""
    layers = read_exr(file)
    return layers[""] - layers.get("emission", 0.0)


def render(program, scene, output, passes, seed, *more):
    """The picture, and seconds of the processor."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "render", scene, "-o", output, "--passes", str(passes), "--seed", str(seed), "--quiet",
                    *more], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return picture_of(output), after.ru_utime - before.ru_utime


def relative_error(picture, reference):
    return series_error([picture], [reference])["squared_error"]


def measure(program, scene, output, seconds, seeds, reference):
    """Passes, processor seconds of them without loading, and squared relative RMSE, means over the seeds."""
    _, load = render(program, scene, output, 1, 1)
    _, some = render(program, scene, output, 9, 1)
    passes = max(1, round(seconds / max((some - load) / 8, 1e-3)))
    errors, times = [], []
    for seed in range(11, 11 + seeds):
        picture, time = render(program, scene, output, passes, seed)
        errors.append(relative_error(picture, reference))
        times.append(time - load + (some - load) / 8)
    return passes, float(np.mean(times)), float(np.mean(errors))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin", help="folder of mote")
    parser.add_argument("--against", type=Path, help="another mote, given the same seconds")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "out/many_lights")
    parser.add_argument("--seconds", type=float, default=10.0, help="of the processor, for each picture")
    parser.add_argument("--seeds", type=int, default=3, help="pictures of each program")
    parser.add_argument("--quick", action="store_true", help="few lights, small pictures, half a second")
    parser.add_argument("--only", choices=["hall", "spots"], help="one of the two scenes")
    parser.add_argument("--csv", type=Path, help="also write the numbers there")
    options = parser.parse_args()
    use(options.bin)
    share, seconds = (20, 0.5) if options.quick else (1, options.seconds)
    size = (64, 40) if options.quick else (320, 200)
    options.output.mkdir(parents=True, exist_ok=True)
    programs = {"mote": options.bin / "mote"} | ({"against": options.against} if options.against else {})
    lines = ["scene,lights,program,passes,processor_seconds,squared_relative_rmse,square_times_seconds"]
    for name, text, lights, passes, better in (
            ("hall", hall(10000 // share, *size), 10000 // share, 600, []),
            ("spots", spots(1000 // share, *size), 1000 // share, 1500, ["-D", "integrator.equiangular=true"])):
        if options.only not in (None, name):
            continue
        scene = options.output / f"{name}.xml"
        scene.write_text(text)
        long = options.output / f"{name}_reference.exr"
        if not long.exists():
            render(programs["mote"], scene, long, 64 if options.quick else passes, 1, *better)
        reference = picture_of(long)
        products = {}
        for label, program in programs.items():
            passes, time, error = measure(program, scene, options.output / f"{name}_{label}.exr", seconds, options.seeds,
                                          reference)
            products[label] = error * time
            lines.append(f"{name},{lights},{label},{passes},{time:.2f},{error:.6f},{products[label]:.5f}")
            print(lines[-1], flush=True)
        if "against" in products:
            print(f"{name}: squared error x time is {products['against'] / products['mote']:.1f} times less than the other's")
    if options.csv:
        options.csv.write_text("# Script: experiments/studies/many_lights.py\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
