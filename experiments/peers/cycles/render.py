"""Builds a scene in Cycles (`bpy`) and renders it again and again, each picture with its own seed.

    python experiments/peers/cycles/render.py JOB.json

The job: folder (of the exported scene), vdb, output, threads, seed, budget (real_sizes/doubling.py), cut_grids and
volume_sampling (media.py), filter: box or gaussian, denoise: by OpenImageDenoise with prefiltered albedo and normals,
guiding: on surfaces and in volumes.
Writes output/N.exr (linear, float) and output/log.json. No view transform, clamping, adaptive sampling, light threshold or
blur; as many bounces as the scene allows, up to Cycles' most; the light tree; media without bias.
"""
import json
import resource
import sys
import time
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "real_sizes")]
from build import build  # noqa: E402
from doubling import next_passes  # noqa: E402
from flat_scene import read_flat_scene  # noqa: E402

BOUNCES = 1024  # the most that Cycles allows


def bounces(folder):
    """Those of the scene's max_depth: a path of depth 2 is light that is reflected once, Cycles' bounce 0."""
    depth = read_flat_scene(folder / "scene.xml").child("integrator").get("max_depth", -1)
    return BOUNCES if depth < 0 else min(max(depth - 2, 0), BOUNCES)


def configure(job):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles, render = scene.cycles, scene.render
    cycles.device, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", job["denoise"], False
    cycles.denoising_input_passes, cycles.denoising_prefilter = "RGB_ALBEDO_NORMAL", "ACCURATE"
    cycles.use_guiding = cycles.use_surface_guiding = cycles.use_volume_guiding = job["guiding"]
    cycles.use_light_tree, cycles.volume_biased = True, False
    cycles.time_limit, cycles.use_auto_tile = 0.0, False
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "volume_bounces",
                 "transparent_max_bounces"):
        setattr(cycles, name, BOUNCES)
    cycles.max_bounces = bounces(Path(job["folder"]))
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.pixel_filter_type = {"box": "BOX", "gaussian": "BLACKMAN_HARRIS"}[job["filter"]]
    # Mitsuba's Gaussian, within 0.3 % at an edge; that of Cycles ends at two standard deviations.
    cycles.filter_width = 3.55
    render.threads_mode, render.threads = "FIXED", job["threads"]
    render.film_transparent, render.use_compositing, render.use_sequencer = False, False, False
    render.use_persistent_data = True  # the scene is loaded once
    image = render.image_settings
    image.file_format, image.color_depth, image.exr_codec, image.color_mode = "OPEN_EXR", "32", "ZIP", "RGB"
    scene.view_settings.view_transform = "Raw"


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def picture(job, index, samples, seed):
    """One render: samples, seed, seconds on the wall and of the processors, and the file."""
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.seed = samples, seed
    path = Path(job["output"]) / f"{index}.exr"
    scene.render.filepath = str(path)
    started, wall, cpu = time.time(), time.monotonic(), processor_seconds()
    bpy.ops.render.render(write_still=True)
    return {"passes": samples, "seed": seed, "started": started, "wall_s": time.monotonic() - wall, "cpu_s": processor_seconds() - cpu,
            "file": path.name}


def main():
    job = json.loads(Path(sys.argv[1]).read_text())
    start = time.monotonic()
    notes = build(job, Path(job["folder"]))
    configure(job)
    built = time.monotonic() - start
    # The first picture loads the scene and builds its BVH: a small one of one sample, not counted.
    bpy.context.scene.render.resolution_percentage = 10
    warm_up = picture(job, "warm_up", 1, 12345)
    bpy.context.scene.render.resolution_percentage = 100
    log = {"version": bpy.app.version_string, "notes": notes, "build_s": built + warm_up["wall_s"], "runs": []}
    samples = next_passes([], job["budget"])
    while samples:
        log["runs"].append(picture(job, len(log["runs"]), samples, job["seed"] + len(log["runs"])))
        samples = next_passes(log["runs"], job["budget"])
    (Path(job["output"]) / "log.json").write_text(json.dumps(log, indent=1))


main()
