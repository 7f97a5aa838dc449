// OpenImageDenoise as a filter of layers: with the stand-in (tests/stand_ins), which doubles a colour whose
// features were denoised before.
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/math/random.h"
#include "core/objects/error.h"
#include "screenspace/layer_filter/view_filter.h"
#include "tests/screenspace/layer_filter_views.h"
#include "tests/support/catch.h"
#include "tests/support/environment.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const std::string stand_in = MOTE_BINARY_DIR "/stand_ins";

/// A wall, seen from the front.
FilterView wall() {
    return make_view(24, 16, LayerKind::surface, [](const Vec3& direction) {
        Seen seen = see_plane(direction, Vec3(0, 0, 2), Vec3(0, 0, -1));
        seen.light = Rgb(1.0f, 2.0f, 4.0f);
        return seen;
    });
}

FilteredLayer filtered(const FilterView& view, const std::vector<Rgb>& mean, float variance) {
    const Environment named("MOTE_OIDN", stand_in);
    const auto filter = make_oidn_filter(view.features, std::make_shared<const OidnLibrary>());
    return filter->filtered({mean, std::vector<Rgb>(mean.size(), Rgb(variance)), LayerKind::surface}, {});
}

}  // namespace

TEST_CASE("the library's layer is taken as far as noise explains the difference", "[oidn_filter]") {
    const FilterView view = wall();
    const std::vector<Rgb>& mean = view.truth;
    const auto share = [&](float variance) {  // of what the library adds
        const FilteredLayer result = filtered(view, mean, variance);
        CHECK(result.variance.empty());  // not known
        return (result.mean[200].y - mean[200].y) / mean[200].y;
    };
    CHECK(share(1e6f) == 1.0f);  // twice the layer: noise may be anything
    CHECK(share(0.0f) == 0.0f);
    CHECK(std::fabs(share(1e-8f)) < 1e-4f);  // the mean of the passes stays
    // Eq. (2) of variance_blend.h over 11 x 11 pixels, for a difference that is the same everywhere.
    const float difference = average(mean[200] * mean[200]);
    CHECK(std::fabs(share(0.25f * difference) - 0.25f * (1.0f + 5.0f * std::sqrt(2.0f) / 11.0f)) < 1e-3f);
}

TEST_CASE("rare bright paths do not bring the noisy mean back", "[oidn_filter]") {
    // Passes of which one in twenty is bright, and a denoiser that is right: no window of 11 x 11 pixels, of
    // some two thousand that are apart, may see more than noise.
    constexpr int width = 512, height = 512, passes = 24;
    constexpr float chance = 0.05f;
    const std::size_t pixels = std::size_t(width) * height;
    std::vector<Rgb> mean(pixels), variance(pixels);
    Rng rng(5);
    for (std::size_t p = 0; p < pixels; ++p) {
        float sum = 0.0f, squares = 0.0f;
        for (int pass = 0; pass < passes; ++pass) {
            const float light = rng.next_float() < chance ? 1.0f / chance : 0.0f;
            sum += light, squares += light * light;
        }
        mean[p] = Rgb(sum / passes);
        variance[p] = Rgb((squares - sum * sum / passes) / (passes * (passes - 1)));
    }
    const std::vector<Rgb> right(pixels, Rgb(1.0f));
    CHECK(mixed_with_mean(width, height, right, {mean, variance}) == right);
}

TEST_CASE("light of media is denoised without normals", "[oidn_filter]") {
    const FilterView view = wall();
    const std::vector<Rgb>& mean = view.truth;
    const TemporaryFolder folder;
    const Environment named("MOTE_OIDN", stand_in), log("MOTE_STAND_IN_LOG", folder.file("log"));
    const std::vector<Rgb> variance(mean.size(), Rgb(1e12f));
    const auto runs = [&](LayerKind kind, FilterQuality quality) {
        std::ofstream(folder.file("log"));
        const auto filter = make_oidn_filter(view.features, std::make_shared<const OidnLibrary>());
        const Rgb shown = filter->filtered({mean, variance, kind, quality}, {}).mean[200];
        CHECK(shown.y == Approx((quality == FilterQuality::full ? 2.0f : 4.0f) * mean[200].y));
        std::ifstream file(folder.file("log"));
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    CHECK(runs(LayerKind::surface, FilterQuality::full) == "quality 0\n");
    CHECK(runs(LayerKind::volume, FilterQuality::full) == "quality 0, no normals\n");
    CHECK(runs(LayerKind::volume, FilterQuality::preview) == "quality 5, no normals\n");
}

TEST_CASE("a filtered layer is finite and nowhere negative where the layer is not", "[oidn_filter]") {
    const FilterView view = wall();
    std::vector<Rgb> mean = view.truth;
    mean[5] = Rgb(std::numeric_limits<float>::quiet_NaN());
    mean[7] = Rgb(-1.0f, 0.0f, 1.0f);
    const FilteredLayer result = filtered(view, mean, 1e6f);
    CHECK_FALSE(is_finite(result.mean[5]));  // stays, and is counted elsewhere
    for (std::size_t i = 0; i < mean.size(); ++i) {
        if (i == 5) continue;
        REQUIRE(is_finite(result.mean[i]));
        for (int c = 0; c < 3; ++c) CHECK(result.mean[i][c] >= std::fmin(mean[i][c], 0.0f));
    }
}

TEST_CASE("a library that is switched off is not loaded", "[oidn_filter]") {
    const Environment off("MOTE_OIDN", "off");
    CHECK_THROWS_AS(OidnLibrary(), InputError);
}
