#include "screenspace/ssbc/ssbc_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "core/objects/error.h"
#include "screenspace/ssbc/ssbc_camera.h"

namespace mote::screenspace {

using namespace core;

namespace {

std::vector<std::string> layer_names(const ImageChannels& image) {
    std::vector<std::string> names;
    for (const std::string& channel : image.names)
        if (const auto dot = channel.rfind('.'); dot != std::string::npos) {
            const std::string layer = channel.substr(0, dot);
            if (std::find(names.begin(), names.end(), layer) == names.end()) names.push_back(layer);
        }
    return names;
}

/// The three channels of a layer, or nothing.
std::vector<Vec3> layer(const ImageChannels& image, const std::string& name) {
    for (const char* axes : {"XYZ", "RGB", "xyz", "rgb"}) {
        const std::vector<float>* planes[3];
        bool all = true;
        for (int c = 0; c < 3; ++c) all = (planes[c] = image.find(name + "." + axes[c])) != nullptr && all;
        if (!all) continue;
        std::vector<Vec3> values(planes[0]->size());
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = {(*planes[0])[i], (*planes[1])[i], (*planes[2])[i]};
        return values;
    }
    return {};
}

std::vector<Rgb> required_light(const ImageChannels& image, const std::string& name) {
    std::vector<Rgb> values = name.empty() ? image.rgb("") : layer(image, name);
    if (values.empty() && name.empty()) throw InputError("the picture has no channels R, G, B");
    if (values.empty())
        throw InputError("there is no layer '" + printable(name) + "'" +
                         suggestion(name, layer_names(image)));
    return values;
}

/// The name that was chosen, or the first of the names that the picture has, or the last.
std::string first_of(const ImageChannels& image, const std::string& chosen,
                     const std::vector<std::string>& names) {
    if (!chosen.empty()) return chosen;
    for (const std::string& name : names)
        if (!layer(image, name).empty()) return name;
    return names.back();
}

/// Layers of reflected light by the names that this project gives them.
std::vector<std::string> reflected_layers(const ImageChannels& image) {
    std::vector<std::string> found;
    for (const std::string& name : layer_names(image))
        if (name == "direct" || name.starts_with("indirect")) found.push_back(name);
    const bool direct = std::find(found.begin(), found.end(), "direct") != found.end();
    return direct && found.size() > 1 ? found : std::vector<std::string>{};
}

std::optional<RowMatrix> matrix_of(const ImageChannels& image) {
    const auto entry = image.metadata.find("worldToCamera");
    if (entry == image.metadata.end()) return std::nullopt;
    std::istringstream text(entry->second);
    RowMatrix m;
    for (double& v : m)
        if (!(text >> v)) return std::nullopt;
    return m;
}

/// Positions in the world, or in camera space: whichever a pinhole camera fits better than to a pixel.
FittedCamera camera_of(const ImageChannels& image, std::span<const Vec3> position,
                       std::span<const std::uint8_t> shown) {
    const RowMatrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto world = matrix_of(image);
    std::optional<FittedCamera> best;
    if (world) best = fit_camera(image.width, image.height, position, shown, *world);
    const auto at_origin = fit_camera(image.width, image.height, position, shown, identity);
    if (at_origin && (!best || at_origin->error < best->error)) best = at_origin;
    if (best && best->error < 1.0) return *best;
    const std::string misfit =
        best ? fmt::format("positions are {:.3g} pixels off a pinhole camera", best->error)
             : std::string("too few pixels show a surface");
    throw InputError("the camera cannot be found: " + misfit +
                     (world ? " at the attribute worldToCamera and at the origin"
                            : " at the origin, and there is no attribute worldToCamera"));
}

void check_reflectance(const ImageChannels& image, std::span<const Rgb> reflectance) {
    for (std::size_t i = 0; i < reflectance.size(); ++i)
        if (!(min_component(reflectance[i]) >= 0.0f) || !(max_component(reflectance[i]) <= 1.001f))
            throw InputError(fmt::format("the reflectance at pixel ({}, {}) is not between 0 and 1",
                                         i % std::size_t(image.width), i / std::size_t(image.width)));
}

}  // namespace

SsbcPicture read_light(const ImageChannels& image, const SsbcChannels& channels) {
    SsbcPicture picture;
    const bool chosen = !channels.light.empty();
    const std::vector<std::string> layers = chosen ? channels.light : reflected_layers(image);
    picture.light.assign(std::size_t(image.width) * std::size_t(image.height), Rgb(0.0f));
    for (const std::string& name : layers) {
        const std::vector<Rgb> part = required_light(image, name);
        for (std::size_t i = 0; i < part.size(); ++i) picture.light[i] += part[i];
        picture.light_from += (picture.light_from.empty() ? "" : " + ") + printable(name);
    }
    if (!layers.empty()) return picture;
    picture.light = required_light(image, ""), picture.light_from = "R, G, B";
    if (const std::vector<Rgb> emission = layer(image, "emission"); !emission.empty()) {
        for (std::size_t i = 0; i < emission.size(); ++i) picture.light[i] -= emission[i];
        picture.light_from += " - emission";
    }
    return picture;
}

std::vector<Rgb> read_hidden_light(const ImageChannels& image, std::size_t side) {
    return required_light(image, "hidden_light_" + hidden_side_name(side));
}

SsbcPicture read_ssbc_picture(const ImageChannels& image, const SsbcChannels& channels) {
    const std::string position_name = first_of(image, channels.position, {"Center.P", "P"}),
                      normal_name = first_of(image, channels.normal, {"Center.N", "N"}),
                      reflectance_name = first_of(image, channels.reflectance,
                                                  {"Center.DiffuseAlbedo", "DiffuseAlbedo", "Albedo"});
    const std::vector<Vec3> position = layer(image, position_name), normal = layer(image, normal_name),
                            reflectance = layer(image, reflectance_name);
    std::string missing, first;
    const auto need = [&](const std::vector<Vec3>& values, const std::string& name, const char* what) {
        if (!values.empty()) return;
        if (missing.empty()) first = name;
        missing += (missing.empty() ? "" : ", ") + ("'" + printable(name) + "' (" + what + ")");
    };
    need(position, position_name, "position"), need(normal, normal_name, "normal");
    need(reflectance, reflectance_name, "diffuse reflectance");
    if (!missing.empty())
        throw InputError("the picture lacks " + missing + suggestion(first, layer_names(image)) +
                         "; mote render writes them with --auxiliary");
    check_reflectance(image, reflectance);

    SsbcPicture picture = read_light(image, channels);
    picture.surfaces = SsbcSurfaces(image.width, image.height);
    std::vector<std::uint8_t> shown(position.size(), 0);
    for (std::size_t i = 0; i < shown.size(); ++i)
        shown[i] = is_finite(position[i]) && is_finite(normal[i]) && glm::length(normal[i]) > 0.0f;
    // One pixel has no other to take light from, and no camera can be found from it.
    if (std::count(shown.begin(), shown.end(), 1) < 2) return picture;
    const FittedCamera camera = camera_of(image, position, shown);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        if (!shown[i]) continue;
        const Vec3d to_viewer = camera.eye - Vec3d(position[i]);
        const double distance = glm::length(to_viewer), depth = -glm::dot(to_viewer, camera.forward);
        const double facing =
            std::abs(glm::dot(Vec3d(normal[i]), to_viewer)) / (distance * glm::length(normal[i]));
        // The solid angle of a pixel is its area on the film times cosine over squared distance there.
        const double across_view = camera.pixel_area * depth * depth * depth / distance;
        picture.surfaces.set(i, position[i], normal[i], Vec3(to_viewer),
                             float(across_view / std::max(facing, 1e-4)),
                             glm::min(reflectance[i], Rgb(1.0f)));
    }
    return picture;
}

}  // namespace mote::screenspace
