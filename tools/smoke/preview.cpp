#include "tools/smoke/preview.h"

#include "core/formats/pictures/image_file.h"

namespace mote::tools {

namespace {

/// The share of light that reaches each cell of one slice from straight above.
std::vector<float> light_from_above(const GridSize& size, const std::vector<float>& density, int k,
                                    float cell, float extinction) {
    std::vector<float> light(std::size_t(size.x) * std::size_t(size.y));
    for (int i = 0; i < size.x; ++i) {
        float depth = 0.0f;
        for (int j = size.y - 1; j >= 0; --j) {
            light[std::size_t(j) * std::size_t(size.x) + std::size_t(i)] = std::exp(-depth);
            depth += density[size.index(i, j, k)] * cell * extinction;
        }
    }
    return light;
}

}  // namespace

void write_preview(const std::string& path, const GridSize& size, const std::vector<float>& density,
                   float cell, float extinction) {
    const std::size_t pixels = std::size_t(size.x) * std::size_t(size.y);
    std::vector<float> picture(pixels, 0.0f), transmittance(pixels, 1.0f);
    for (int k = size.z - 1; k >= 0; --k) {  // from the viewer at +z backwards
        const std::vector<float> light = light_from_above(size, density, k, cell, extinction);
        for (int j = 0; j < size.y; ++j)
            for (int i = 0; i < size.x; ++i) {
                const std::size_t p = std::size_t(j) * std::size_t(size.x) + std::size_t(i);
                const float passed = std::exp(-density[size.index(i, j, k)] * cell * extinction);
                picture[p] += transmittance[p] * (1.0f - passed) * (0.15f + 0.85f * light[p]);
                transmittance[p] *= passed;
            }
    }
    std::vector<core::Rgb> rows(pixels);  // from the top
    for (int j = 0; j < size.y; ++j)
        for (int i = 0; i < size.x; ++i)
            rows[std::size_t(size.y - 1 - j) * std::size_t(size.x) + std::size_t(i)] =
                core::Rgb(picture[std::size_t(j) * std::size_t(size.x) + std::size_t(i)]);
    core::write_png(path, size.x, size.y, rows);
}

}  // namespace mote::tools
