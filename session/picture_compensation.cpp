#include "session/picture_compensation.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "core/objects/error.h"
#include "session/borrowed_arena.h"

namespace mote::session {

using core::ImageChannels, core::InputError, core::Rgb;

float bound_of(const ImageChannels& image) {
    const auto entry = image.metadata.find("bound");
    if (entry == image.metadata.end()) return 0.0f;
    const float bound = std::strtof(entry->second.c_str(), nullptr);
    return bound > 0.0f && std::isfinite(bound) ? bound : 0.0f;
}

bool is_compensated(const ImageChannels& image) {
    return image.find(std::string(compensation_layer) + ".R") != nullptr;
}

void take_out_compensation(ImageChannels& image) {
    const std::vector<Rgb> before = image.rgb(compensation_layer);
    for (std::size_t k = image.names.size(); k-- > 0;) {
        const std::string& name = image.names[k];
        if (const auto c = std::string("RGB").find(name); name.size() == 1 && c != std::string::npos)
            for (std::size_t i = 0; i < before.size(); ++i) image.channels[k][i] -= before[i][int(c)];
        if (!name.starts_with(std::string(compensation_layer) + ".")) continue;
        image.names.erase(image.names.begin() + std::ptrdiff_t(k));
        image.channels.erase(image.channels.begin() + std::ptrdiff_t(k));
    }
}

void add_compensation(ImageChannels& image, const std::vector<Rgb>& compensation) {
    for (int c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < image.names.size(); ++k)
            if (image.names[k] == std::string(1, "RGB"[c]))
                for (std::size_t i = 0; i < compensation.size(); ++i)
                    image.channels[k][i] += compensation[i][c];
    image.add_rgb(compensation_layer, compensation);
}

screenspace::SsbcResult compensate_picture(ImageChannels& image, screenspace::SsbcSettings settings,
                                           const screenspace::SsbcChannels& channels, bool replace) {
    if (settings.bound == 0.0f) settings.bound = bound_of(image);
    if (settings.bound == 0.0f)
        throw InputError("the picture does not say with which bound it was rendered: give one");
    if (is_compensated(image) && !replace)
        throw InputError(std::string("the picture holds a layer '") + compensation_layer + "' already");
    if (replace) take_out_compensation(image);
    screenspace::SsbcResult result = BorrowedArena(0).execute([&] {
        const screenspace::SsbcPicture picture = screenspace::read_ssbc_picture(image, channels);
        return compensate(picture.surfaces, picture.light, picture.hidden, settings);
    });
    add_compensation(image, result.compensation);
    image.metadata["ssbc"] = fmt::format("bound {:.9g}, steps {}", settings.bound, settings.steps);
    return result;
}

}  // namespace mote::session
