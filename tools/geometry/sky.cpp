#include "tools/geometry/sky.h"

#include <vector>

#include "core/formats/pictures/image_file.h"

namespace mote::tools {

using core::pi;
using core::Rgb;
using core::Vec3;

Rgb sky_radiance(const Sky& sky, const Vec3& d) {
    const float up = sky.elevation * pi / 180.0f, turn = sky.azimuth * pi / 180.0f;
    const Vec3 sun(std::cos(up) * std::sin(turn), std::sin(up), -std::cos(up) * std::cos(turn));
    const float towards = std::fmax(glm::dot(d, sun), 0.0f);
    const Rgb zenith(0.10f, 0.22f, 0.56f), horizon(0.92f, 0.76f, 0.62f), ground(0.24f, 0.23f, 0.22f);
    const Rgb warm =
        Rgb(1.0f, 0.66f, 0.36f) * std::pow(towards, 6.0f) + Rgb(9.0f, 6.5f, 4.0f) * std::pow(towards, 120.0f);
    if (d.y < 0.0f) return glm::mix(horizon, ground, std::fmin(1.0f, -3.0f * d.y));
    const float rise = std::pow(d.y, 0.36f);
    return glm::mix(horizon, zenith, rise) + warm * (1.0f - 0.6f * rise);
}

void write_sky(const std::filesystem::path& path, const Sky& sky) {
    core::ImageChannels image;
    image.height = sky.height, image.width = 2 * sky.height;
    std::vector<Rgb> pixels;
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column) {
            const float turn = 2.0f * pi * (float(column) + 0.5f) / float(image.width);
            const float polar = pi * (float(row) + 0.5f) / float(image.height);
            pixels.push_back(sky_radiance(
                sky, {std::sin(polar) * std::sin(turn), std::cos(polar), -std::sin(polar) * std::cos(turn)}));
        }
    image.add_rgb("", pixels);
    core::write_exr(path.string(), image, true);
}

}  // namespace mote::tools
