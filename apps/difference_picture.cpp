#include "apps/difference_picture.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "apps/subcommands.h"
#include "core/film/exposure.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/pictures/png_text.h"
#include "core/objects/error.h"
#include "session/preview.h"

namespace mote::apps {

namespace {

using core::Rgb;

constexpr int gap = 4;  ///< pixels between the pictures

double luminance_of(const Rgb& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

Rgb difference_colour(double difference) {
    const auto d = float(difference);
    return d > 0.0f ? Rgb(d, 0.35f * d, 0.0f) : Rgb(0.0f, -0.35f * d, -d);
}

}  // namespace

double amplification(const std::string& text) {
    const std::string number = text.starts_with("x") ? text.substr(1) : text;
    char* end = nullptr;
    const double factor = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !(factor > 0.0) || !std::isfinite(factor))
        throw UsageError("--difference " + core::printable(text) + ": expected a factor such as x4");
    return factor;
}

std::string write_difference(const std::string& path, const core::Bitmap& image,
                             const core::Bitmap& reference, double factor) {
    const int width = 3 * image.width + 2 * gap;
    std::vector<Rgb> pixels(std::size_t(width) * std::size_t(image.height), Rgb(1.0f));
    const float stops = core::adapted_exposure(reference.pixels), scale = std::exp2(stops);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::size_t from = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
            Rgb* to = &pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
            const Rgb a = scale * image.pixels[from], r = scale * reference.pixels[from];
            to[0] = a, to[image.width + gap] = r;
            to[2 * (image.width + gap)] = difference_colour(factor * (luminance_of(a) - luminance_of(r)));
        }
    const std::string meaning = fmt::format(
        "image, reference, and their difference in luminance times {:g}: red too bright, blue too dark",
        factor);
    core::write_png(path, width, image.height, pixels, 0.0f,
                    {{exposure_key, exposure_text(stops, false)}, {"Description", meaning}});
    return meaning;
}

}  // namespace mote::apps
