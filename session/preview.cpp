#include "session/preview.h"

#include <fmt/format.h>
#include <cmath>
#include <map>

#include "core/film/exposure.h"
#include "core/film/tone.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/pictures/png_text.h"

namespace mote::session {

std::string exposure_text(float stops, bool fixed) {
    return fixed ? fmt::format("{:+.2f} stops, fixed", stops)
                 : fmt::format("{:+.2f} stops, adapted to the key value {}", stops, core::key_value);
}

std::string write_preview(const std::string& path, const core::ImageChannels& image,
                          std::optional<float> exposure, std::span<const std::uint8_t> finished) {
    std::vector<core::Rgb> pixels = image.rgb("");
    const float stops = exposure ? *exposure : core::adapted_exposure(pixels);
    for (core::Rgb& pixel : pixels) pixel = core::toned(core::filmic_tone, std::exp2(stops) * pixel);
    for (std::size_t i = 0; i < finished.size(); ++i) {
        const std::size_t x = i % std::size_t(image.width), y = i / std::size_t(image.width);
        if (!finished[i]) pixels[i] = core::Rgb((x / 8 + y / 8) % 2 ? 0.1f : 0.2f);
    }
    const std::string text = exposure_text(stops, exposure.has_value());
    std::map<std::string, std::string> said{{exposure_key, text}, {"Tone", "filmic"}};
    if (const auto denoised = image.metadata.find("denoised"); denoised != image.metadata.end())
        said["Denoised"] = denoised->second;
    core::write_png(path, image.width, image.height, pixels, 0.0f, said);
    return text;
}

}  // namespace mote::session
