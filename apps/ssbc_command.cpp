// mote ssbc: screen-space bias compensation of a finished picture.
#include "apps/ssbc_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "apps/command.h"
#include "apps/options.h"
#include "apps/picture_file.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "core/scene/scene.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "session/output_files.h"
#include "session/picture_compensation.h"
#include "session/reference_metadata.h"

namespace mote::apps {

namespace {

using core::ImageChannels, core::InputError, core::Rgb;
using screenspace::SsbcPicture, screenspace::SsbcResult;

float bound_of(const ImageChannels& image, const SsbcArguments& a) {
    const float bound = a.bound > 0.0f ? a.bound : session::bound_of(image);
    if (bound > 0.0f) return bound;
    throw InputError("the picture does not say with which bound it was rendered: give --bound", {a.input, 0});
}

/// The scene with a film of the picture's size: a picture may have been rendered with another than the file
/// says.
SceneArguments with_film_of(const ImageChannels& image, SceneArguments scene) {
    const std::string size[] = {fmt::format("film.width={}", image.width),
                                fmt::format("film.height={}", image.height)};
    scene.defines.insert(scene.defines.begin(), std::begin(size), std::end(size));
    return scene;
}

void check_scene(const ImageChannels& image, const core::Scene& scene, const SsbcArguments& a) {
    const NamedFile output{"the result", a.output};
    check_outputs(std::span(&output, 1), scene_inputs(scene.parts().input_files));
    if (scene.film().width != image.width || scene.film().height != image.height)
        throw InputError(fmt::format("the scene's film has {} x {} pixels, the picture {} x {}",
                                     scene.film().width, scene.film().height, image.width, image.height));
    const auto camera = image.metadata.find("worldToCamera");
    if (camera != image.metadata.end() && !same_camera(camera->second, world_to_camera(scene.camera())))
        std::fputs(
            "mote: warning: the scene's camera is not the one that the picture names (worldToCamera)\n",
            stderr);
}

SsbcPicture read(ImageChannels& image, const SsbcArguments& a) {
    if (a.replace)
        take_out_compensation(image);
    else if (is_compensated(image))
        throw InputError(std::string("the picture holds a layer '") + compensation_layer +
                             "' already (--replace takes it out)",
                         {a.input, 0});
    try {
        if (a.layers > 1 && a.scene.scene.empty())
            throw InputError("several layers need --scene: a picture holds no surfaces behind others");
        if (a.scene.scene.empty()) return read_ssbc_picture(image, a.channels);
        SsbcPicture picture = read_light(image, a.channels);
        const LoadedScene loaded = load(with_film_of(image, a.scene));
        const core::Scene& scene = loaded.scene();
        check_scene(image, scene, a);
        const auto buffers =
            screenspace::make_g_buffers(scene, scene.camera(), image.width, image.height, a.layers);
        picture.surfaces = ssbc_surfaces(buffers[0]);
        for (auto& side : screenspace::hidden_sides(buffers))
            picture.hidden.push_back(
                {std::move(side), screenspace::read_hidden_light(image, picture.hidden.size())});
        return picture;
    } catch (const InputError& error) {
        if (!error.where().file.empty()) throw;
        throw InputError(error.what(), {a.input, 0});
    }
}

Rgb mean(std::span<const Rgb> pixels) {
    core::Vec3d sum(0.0);
    for (const Rgb& p : pixels) sum += core::Vec3d(p);
    return Rgb(sum / double(pixels.size()));
}

void report(const SsbcPicture& picture, const SsbcResult& result, float bound, double seconds) {
    const auto& counts = result.counts;
    const auto triple = [](const Rgb& c) { return fmt::format("{:.5g} {:.5g} {:.5g}", c.x, c.y, c.z); };
    const double receivers = std::max(1.0, double(counts.receivers));
    std::string text =
        fmt::format("light      {}, mean {}\n", picture.light_from, triple(mean(picture.light)));
    text += fmt::format("added      mean {}\n", triple(mean(result.compensation)));
    text += fmt::format("bound      {:.6g} /m^2, radius {:.6g} m\n", bound, 1.0f / std::sqrt(bound));
    text += fmt::format("gathered   {} times, {:.1f} samples each, {:.3f} s\n", counts.receivers,
                        double(counts.samples) / receivers, seconds);
    std::fputs(text.c_str(), stdout);
    if (result.non_finite > 0)
        std::fprintf(stderr, "mote: warning: the light of %llu pixels is not finite; they send none\n",
                     static_cast<unsigned long long>(result.non_finite));
    if (counts.receivers == 0)
        std::fputs("mote: warning: no pixel shows a surface with diffuse reflectance\n", stderr);
}

int ssbc_command(const SsbcArguments& a) {
    const NamedFile output{"the result", a.output};
    check_outputs(std::span(&output, 1),
                  std::vector<NamedFile>{{"the picture", a.input}, {"the scene", a.scene.scene}});
    ImageChannels image = core::read_exr(a.input);
    const float bound = bound_of(image, a);
    const SsbcPicture picture = read(image, a);
    screenspace::SsbcSettings settings = a.settings;
    settings.bound = bound, settings.hierarchical = !a.flat;
    const auto begin = std::chrono::steady_clock::now();
    const SsbcResult result = compensate(picture.surfaces, picture.light, picture.hidden, settings);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    add_compensation(image, result.compensation);
    for (const char* written_anyway : {"pixelAspectRatio", "screenWindowWidth"})
        image.metadata.erase(written_anyway);
    image.metadata["ssbc"] = fmt::format("bound {:.9g}, steps {}", bound, settings.steps);
    if (a.layers > 1) image.metadata["ssbc"] += fmt::format(", layers {}", a.layers);
    if (const std::uint64_t clamped = core::write_exr(a.output, image, a.half))
        std::fputs(("mote: warning: " + clamped_text(clamped) + "\n").c_str(), stderr);
    report(picture, result, bound, seconds);
    return exit_ok;
}

}  // namespace

void add_ssbc(CLI::App& app, SsbcArguments& a, std::function<int()>& action) {
    CLI::App& command = *app.add_subcommand(
        "ssbc", "Add what a bound on the geometry term took from a picture, found in the picture itself");
    auto& s = a.settings;
    command.add_option("IN", a.input, "An EXR with positions, normals, reflectance and worldToCamera")
        ->required();
    command.add_option("-o,--output", a.output, "The EXR file to write")->required();
    command.add_option("--bound", a.bound, "The bound in 1/m^2 (default: as the picture says)")
        ->check(number_above_0());
    command.add_option("--steps", s.steps, "How often light is carried on (default: 2)")
        ->check(whole_number(1, 100));
    command.add_option("--scene", a.scene.scene,
                       "Take surfaces and camera from this scene, not from channels");
    add_repeatable(command, "-D,--define", a.scene.defines, "Set a $parameter of that scene (repeatable)")
        ->type_name("NAME=VALUE");
    command
        .add_option("--layers", a.layers,
                    "Surfaces along each ray: with --scene, for pictures that hold hidden light (default: 1)")
        ->check(whole_number(1, 16));
    command.add_flag("--replace", a.replace, "Take out the compensation that the picture holds");
    add_repeatable(command, "--light", a.channels.light,
                   "A layer of reflected light (repeatable; default: see docs/methods/compensation.md)");
    command.add_option("--position", a.channels.position, "The layer of positions (default: Center.P or P)");
    command.add_option("--normal", a.channels.normal, "The layer of normals (default: Center.N or N)");
    command.add_option("--albedo", a.channels.reflectance,
                       "The layer of diffuse reflectance (default: that of Center, DiffuseAlbedo or Albedo)");
    command.add_option("--levels", s.refinement.levels, "Levels of the pyramid that are summed (default: 6)")
        ->check(whole_number(1, 32));
    command
        .add_option("--angle", s.refinement.projected_angle,
                    "Refine what appears larger, in sr (default: 0.08)")
        ->check(number_from_0());
    command
        .add_option("--discontinuity-angle", s.refinement.discontinuity_projected_angle,
                    "The same where surfaces meet (default: 0.04)")
        ->check(number_from_0());
    command.add_flag("--flat", a.flat, "Sum over all pixels: exact, and slow");
    command.add_flag("--half-resolution", s.half_resolution, "Gather at one pixel of four");
    command
        .add_option("--blur", s.blur,
                    "Standard deviation of an edge-preserving blur, in pixels (default: none)")
        ->check(number_between(0.0, 100.0));
    add_half(command, a.half);
    command.callback([&a, &action] { action = [&a] { return ssbc_command(a); }; });
}

}  // namespace mote::apps
