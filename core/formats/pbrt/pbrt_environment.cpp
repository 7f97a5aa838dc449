// Infinite lights with a picture.
#include <cmath>
#include <numbers>

#include "core/film/bitmap.h"
#include "core/formats/conversion/scene_xml.h"
#include "core/formats/pbrt/pbrt_equal_area.h"
#include "core/formats/pbrt/pbrt_lights.h"
#include "core/formats/pictures/image_file.h"

namespace mote::core {
namespace {

/// Bilinear, over the edges of the octahedron.
Rgb lookup(const Bitmap& b, const Vec3d& direction) {
    const glm::dvec2 at = equal_area_square(direction) * double(b.width) - 0.5;
    const int x0 = int(std::floor(at.x)), y0 = int(std::floor(at.y)), n = b.width;
    const auto texel = [&](int x, int y) {
        if (x < 0 || x >= n)
            x = x < 0 ? -1 - x : 2 * n - 1 - x, y = n - 1 - y;  // an edge meets itself reversed
        if (y < 0 || y >= n) y = y < 0 ? -1 - y : 2 * n - 1 - y, x = n - 1 - x;
        return b.pixels[std::size_t(y) * std::size_t(n) + std::size_t(x)];
    };
    const float fx = float(at.x - x0), fy = float(at.y - y0);
    return glm::mix(glm::mix(texel(x0, y0), texel(x0 + 1, y0), fx),
                    glm::mix(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), fx), fy);
}

/// Illuminance of a patch that faces the light's +z, as pbrt computes it: half of what the mapping has.
double illuminance(const Bitmap& b) {
    double sum = 0.0;
    for (int y = 0; y < b.height; ++y)
        for (int x = 0; x < b.width; ++x) {
            const Vec3d w = equal_area_direction({(x + 0.5) / b.width, (y + 0.5) / b.height});
            sum += double(luminance(b.pixels[std::size_t(y) * std::size_t(b.width) + std::size_t(x)])) *
                   std::fmax(w.z, 0.0);
        }
    return sum * 2.0 * std::numbers::pi / double(b.pixels.size());
}

ImageChannels latitude_longitude(const Bitmap& square, const Transform& to_world) {
    const Transform to_light = to_world.inverse();
    ImageChannels image;
    image.width = 2 * square.width, image.height = square.width;
    std::vector<Rgb> pixels;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            // The first and the last row lie at the poles, columns wrap around (see `envmap`).
            const double theta = std::numbers::pi * y / std::max(image.height - 1, 1);
            const double phi = 2.0 * std::numbers::pi * x / image.width;
            const Vec3d d(std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta));
            pixels.push_back(lookup(square, glm::normalize(to_light.vector(d))));
        }
    image.add_rgb("", pixels);
    return image;
}

}  // namespace

void add_pbrt_environment(pugi::xml_node scene, const PbrtObject& light, const Transform& to_world,
                          double exposure, PbrtFiles& files) {
    const PbrtParameter* file = light.find("filename");
    if (light.find("L"))
        throw InputError("an infinite light has a colour 'L' or a picture, not both", light.where);
    const Bitmap square = read_bitmap(files.find(light.text("filename", ""), file->where), false);
    if (square.width != square.height)
        throw InputError(
            "the picture of an infinite light is square, in the equal-area mapping; this one is " +
                std::to_string(square.width) + " x " + std::to_string(square.height),
            file->where);
    double scale = light.number("scale", 1.0) * exposure;
    const double wanted = light.number("illuminance", -1.0), given = illuminance(square);
    if (wanted > 0.0 && given > 0.0) scale *= wanted / given;
    const std::string name = files.new_name("environment", ".exr");
    write_exr(files.path_of(name), latitude_longitude(square, to_world));
    pugi::xml_node emitter = add_object(scene, "emitter", "envmap");
    add_value(emitter, "string", "filename", files.in_xml(name));
    add_float(emitter, "scale", scale);
}

}  // namespace mote::core
