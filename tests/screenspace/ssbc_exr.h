// A test picture as the channels of an EXR file.
#pragma once

#include <sstream>

#include "core/film/image_channels.h"
#include "tests/screenspace/ssbc_room.h"

namespace mote::tests {

/// worldToCamera of a pinhole camera: x right, y up, z forward, for row vectors.
inline std::string world_to_camera_of(const Pinhole& c) {
    const core::Vec3d f = glm::normalize(c.target - c.eye), r = glm::normalize(glm::cross(f, c.up)),
                      u = glm::cross(r, f);
    std::ostringstream text;
    text.precision(9);
    for (int axis = 0; axis < 3; ++axis) text << r[axis] << ' ' << u[axis] << ' ' << f[axis] << " 0 ";
    text << -glm::dot(r, c.eye) << ' ' << -glm::dot(u, c.eye) << ' ' << -glm::dot(f, c.eye) << " 1";
    return text.str();
}

/// With layers P, N, Albedo, direct, indirect_bounded and emission; the beauty is their sum.
inline core::ImageChannels exr_of(const TestPicture& picture, const Pinhole& camera) {
    core::ImageChannels image;
    image.width = camera.width, image.height = camera.height;
    const auto add = [&](const std::string& name, const std::vector<core::Vec3>& values) {
        for (int c = 0; c < 3; ++c) {
            std::vector<float> plane(values.size());
            for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = values[i][c];
            image.add(name + "." + "XYZ"[c], std::move(plane));
        }
    };
    const std::size_t n = picture.light.size();
    std::vector<core::Rgb> beauty = picture.light, direct = beauty, indirect = beauty;
    const std::vector<core::Rgb> emission(n, core::Rgb(0.5f));
    for (std::size_t i = 0; i < n; ++i) beauty[i] += emission[i], direct[i] *= 0.75f, indirect[i] *= 0.25f;
    image.add_rgb("", beauty), image.add_rgb("direct", direct), image.add_rgb("indirect_bounded", indirect);
    image.add_rgb("emission", emission), image.add_rgb("Albedo", picture.surfaces.reflectance);
    add("P", picture.surfaces.position), add("N", picture.surfaces.normal);
    image.metadata["worldToCamera"] = world_to_camera_of(camera);
    return image;
}

}  // namespace mote::tests
