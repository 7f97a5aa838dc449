#include <algorithm>
#include <optional>

#include "screenspace/denoising/variance_blend.h"
#include "screenspace/layer_filter/oidn_features.h"
#include "screenspace/layer_filter/view_filter.h"

namespace mote::screenspace {

using namespace core;

namespace {

/// The noisy mean shows more than noise where it does over windows of 11 x 11 pixels, at five standard
/// deviations: at two, one window of forty takes the mean by chance, and walls have specks.
constexpr int blend_radius = 5;
constexpr float blend_deviations = 5.0f;

class OidnFilter final : public ViewFilter {
  public:
    OidnFilter(const FilterFeatures& f, std::shared_ptr<const OidnLibrary> library, FilterQuality features)
        : library_(std::move(library)),
          width_(f.width),
          height_(f.height),
          clean_features_(features == FilterQuality::full) {
        using Feature = OidnLibrary::Feature;
        const auto clean = [&](Feature which, const std::vector<Rgb>& values) {
            return clean_features_ ? without_noise(*library_, which, width_, height_, values) : values;
        };
        reflected_ = clean(Feature::albedo, between_0_and_1(f.reflected));
        scattering_ = clean(Feature::albedo, between_0_and_1(f.scattering));
        normal_ = clean(Feature::normal, f.shading_normal);
        no_normal_.assign(f.pixels(), Rgb(0.0f));
    }

    FilteredLayer filtered(const LayerToFilter& layer, CancelToken cancelled) override {
        FilteredLayer result{{layer.mean.begin(), layer.mean.end()}, {}};
        if (is_zero(layer.variance)) return result;
        cancelled.check();
        std::vector<Rgb> colour = result.mean;
        for (Rgb& c : colour)
            if (!is_finite(c)) c = Rgb(0.0f);
        const bool surface = layer.kind == LayerKind::surface;
        const std::vector<Rgb>& albedo = surface ? reflected_ : scattering_;
        const auto quality = layer.quality == FilterQuality::full ? OidnLibrary::Quality::high
                                                                  : OidnLibrary::Quality::balanced;
        // Normals of surfaces behind a medium mislead.
        const std::vector<Rgb> denoised = by_network(
            {width_, height_, colour, albedo, surface ? normal_ : no_normal_, clean_features_, quality});
        result.mean = mixed_with_mean(width_, height_, denoised, layer);
        return result;
    }
    double full_per_preview() const override { return OidnLibrary::high_per_balanced; }
    void release() override { series_.reset(); }

  private:
    /// Denoised by the network of the picture before where that has the same quality.
    std::vector<Rgb> by_network(const OidnLibrary::Picture& picture) {
        if (!series_ || quality_ != picture.quality) series_.emplace(library_->series(picture));
        quality_ = picture.quality;
        return series_->denoised(picture);
    }

    std::shared_ptr<const OidnLibrary> library_;
    int width_, height_;
    bool clean_features_;
    /// Guides of the library: light that surfaces reflect and media scatter towards the eye, and normals.
    std::vector<Rgb> reflected_, scattering_, normal_, no_normal_;
    std::optional<OidnLibrary::Series> series_;
    OidnLibrary::Quality quality_ = OidnLibrary::Quality::high;
};

}  // namespace

std::vector<Rgb> mixed_with_mean(int width, int height, std::span<const Rgb> denoised,
                                 const LayerToFilter& layer) {
    std::vector<Rgb> result(layer.mean.begin(), layer.mean.end());
    const std::vector<Rgb> mixed = blend_by_variance(width, height, denoised, layer.mean, layer.variance,
                                                     blend_radius, blend_deviations);
    for (std::size_t i = 0; i < mixed.size(); ++i)
        if (is_finite(layer.mean[i]) && is_finite(mixed[i]))
            result[i] = glm::max(mixed[i], glm::min(layer.mean[i], Rgb(0.0f)));
    return result;
}

std::unique_ptr<ViewFilter> make_oidn_filter(const FilterFeatures& features,
                                             std::shared_ptr<const OidnLibrary> library,
                                             FilterQuality quality) {
    return std::make_unique<OidnFilter>(features, std::move(library), quality);
}

}  // namespace mote::screenspace
