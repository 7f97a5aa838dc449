#include "session/coarse_preview.h"

#include <algorithm>
#include <cmath>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"

namespace mote::session {

namespace {

constexpr double min_seconds = 20.0, max_share = 0.1, max_load_seconds = 1.0;
constexpr std::size_t min_pixels = std::size_t(1) << 18;

/// Cancels where the caller's observer does, and reports nothing.
class Cancelling : public RenderObserver {
  public:
    explicit Cancelling(RenderObserver& of) : of_(of) {}
    bool cancelled() override { return of_.cancelled(); }

  private:
    RenderObserver& of_;
};

/// The pixels between whose centres a pixel of the larger film is, and how far it is on the way.
struct Between {
    int first, second;
    float way;
    Between(int at, int of, int size) {
        const double x = std::clamp((at + 0.5) * size / of - 0.5, 0.0, double(size - 1));
        first = int(x), second = std::min(first + 1, size - 1), way = float(x - first);
    }
};

}  // namespace

bool coarse_preview_pays(const LoadedScene& scene, const RenderSettings& settings) {
    const core::FilmSettings& film = scene.scene().film();
    return settings.stop.seconds && *settings.stop.seconds >= min_seconds && !settings.range &&
           !settings.begin_with && !settings.resume && scene.load_seconds() <= max_load_seconds &&
           std::size_t(film.width) * std::size_t(film.height) >= min_pixels;
}

std::optional<core::ImageChannels> coarse_preview(const LoadedScene& scene, const RenderSettings& settings,
                                                  RenderObserver& observer) {
    const core::FilmSettings& film = scene.scene().film();
    RenderSettings coarse;
    coarse.seed = settings.seed, coarse.threads = settings.threads, coarse.memory = settings.memory;
    coarse.stop.passes = 1;
    if (settings.stop.seconds) coarse.stop.seconds = max_share * *settings.stop.seconds;
    try {
        Cancelling cancelling(observer);
        const Rendered rendered =
            render(scene.reloaded(at_size(scene.changes(), (film.width + 1) / 2, (film.height + 1) / 2)),
                   coarse, cancelling);
        const bool whole =
            !rendered.interrupted && rendered.finished_pixels.empty() && rendered.missing_layers.empty();
        if (!whole || rendered.image.names.empty()) return std::nullopt;
        return enlarged(rendered.image, film.width, film.height);
    } catch (const core::InputError&) {  // the render itself will say so
    } catch (const core::OutOfMemory&) {
    }
    return std::nullopt;
}

core::ImageChannels enlarged(const core::ImageChannels& image, int width, int height) {
    const std::vector<core::Rgb> small = image.rgb("");
    std::vector<core::Rgb> large;
    large.reserve(std::size_t(width) * std::size_t(height));
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            const Between x(i, width, image.width), y(j, height, image.height);
            const auto row = [&](int v) {
                const auto at = [&](int u) {
                    return small[std::size_t(v) * std::size_t(image.width) + std::size_t(u)];
                };
                return glm::mix(at(x.first), at(x.second), x.way);
            };
            large.push_back(glm::mix(row(y.first), row(y.second), y.way));
        }
    core::ImageChannels result;
    result.width = width, result.height = height;
    result.add_rgb("", large);
    return result;
}

}  // namespace mote::session
