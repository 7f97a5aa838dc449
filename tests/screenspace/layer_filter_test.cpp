// Layers filtered in image space: what must stay, what must not leak, what must not be biased.
#include "screenspace/layer_filter/layer_filter.h"

#include <tbb/global_control.h>

#include <cstring>

#include "core/math/random.h"
#include "screenspace/layer_filter/shrinkage.h"
#include "tests/screenspace/layer_filter_views.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

/// As if all of it were noise: every detail is taken away, and what is left shows the kernels alone.
const LayerFilterSettings no_details{4, 1e9f};

FilteredLayer smooth_all(const FilterView& view, LayerKind kind) {
    const std::vector<Rgb> variance(view.truth.size(), Rgb(1.0f));
    return filter_layer(view.features, {view.truth, variance, kind}, no_details);
}

/// The largest difference relative to the largest value, over pixels that see one surface, or all of them.
float largest_error(const FilterView& view, const std::vector<Rgb>& result, bool all = false) {
    float largest = 0.0f, scale = 0.0f;
    for (std::size_t i = 0; i < result.size(); ++i) {
        if (!all && view.features.kind[i] != PixelKind::single) continue;
        const Rgb d = glm::abs(result[i] - view.truth[i]);
        largest = std::max(largest, max_component(d)), scale = std::max(scale, max_component(view.truth[i]));
    }
    return largest / scale;
}

/// Features that have forgotten how surfaces lie: the error to plant.
FilterFeatures without_normals(FilterFeatures f) {
    for (std::size_t i = 0; i < f.pixels(); ++i) {
        f.normal[i] = f.shading_normal[i] = Vec3(0, 0, -1), f.position[i].z = 4.0f;
        if (f.kind[i] == PixelKind::mixed) f.kind[i] = PixelKind::single;
    }
    f.mixed.clear(), f.samples.clear();
    return f;
}

/// Stack of `times` copies of the view, one below the other, each on a plane of its own.
FilterView repeated(const FilterView& view, int times) {
    const FilterFeatures& f = view.features;
    FilterView tall{FilterFeatures(f.width, f.height * times, f.samples_per_pixel), {}};
    FilterFeatures& t = tall.features;
    for (std::size_t i = 0; i < t.pixels(); ++i) {
        const std::size_t j = i % f.pixels();
        t.kind[i] = f.kind[j], t.normal[i] = f.normal[j], t.shading_normal[i] = f.shading_normal[j];
        t.position[i] = f.position[j] + f.normal[j] * float(i / f.pixels());
        t.distance[i] = f.distance[j], t.transmittance[i] = f.transmittance[j], t.frame[i] = f.frame[j];
        t.reflected[i] = f.reflected[j], t.scattering[i] = f.scattering[j];
        tall.truth.push_back(view.truth[j]);
    }
    return tall;
}

Seen see_gradient(const Vec3& d) {
    Seen seen = see_wall(d);
    seen.light = Rgb(2.0f, 1.5f, 1.0f) + Rgb(0.3f, -0.2f, 0.1f) * seen.sample.position.x +
                 Rgb(0.2f) * seen.sample.position.y;
    return seen;
}

/// Fog of extinction 0.4 and albedo 0.9 up to a surface.
void fill_with_fog(Seen& seen) {
    const float t = std::exp(-0.4f * seen.sample.distance);
    seen.sample.transmittance = t, seen.sample.scattering = Rgb(0.9f * (1.0f - t));
}

}  // namespace

TEST_CASE("A filtered layer is nowhere negative where the layer is not", "[layer_filter]") {
    for (const auto& see : {see_wall, see_corner, see_step})
        for (const LayerKind kind : {LayerKind::surface, LayerKind::volume}) {
            FilterView view = make_view(40, 30, kind, see);
            if (kind == LayerKind::volume)
                std::fill(view.features.scattering.begin(), view.features.scattering.end(), Rgb(0.5f));
            // At the border regression extrapolates light that rises ever faster from zero.
            for (std::size_t i = 0; i < view.truth.size(); ++i) {
                const float x = std::max(0.0f, float(i % 40) - 3.0f);
                view.truth[i] = Rgb(x * x * x * x);
            }
            for (const Rgb& c : smooth_all(view, kind).mean) {
                REQUIRE(c.x >= 0.0f);
                REQUIRE(c.y >= 0.0f);
                REQUIRE(c.z >= 0.0f);
            }
        }
}

TEST_CASE("A layer without noise stays what it is, to the bit", "[layer_filter]") {
    for (const auto& see : {see_wall, see_corner, see_step})
        for (const LayerKind kind : {LayerKind::surface, LayerKind::volume}) {
            FilterView view = make_view(40, 30, kind, see);
            for (std::size_t i = 0; i < view.truth.size(); ++i) view.truth[i] = Rgb(float(i % 7), 1.0f, 0.3f);
            const std::vector<Rgb> none(view.truth.size(), Rgb(0.0f));
            const auto result = filter_layer(view.features, {view.truth, none, kind}, {});
            CHECK(result.mean == view.truth);
            CHECK(*std::max_element(result.variance.begin(), result.variance.end()) == 0.0f);
        }
}

TEST_CASE("Irradiance that is linear on a slanted wall is kept up to its border", "[layer_filter]") {
    const FilterView view = make_view(70, 50, LayerKind::surface, see_gradient);
    // A slope loses the fraction 1e-5 / 0.06 of itself in a level where taps spread least, at the border, and
    // twice at a corner of the picture: 4 levels of slopes below one in a step of 16 pixels.
    CHECK(largest_error(view, smooth_all(view, LayerKind::surface).mean) < 1e-3f);
}

TEST_CASE("Nothing leaks around a corner or over a step", "[layer_filter]") {
    for (const auto& see : {see_corner, see_step}) {
        const FilterView view = make_view(64, 40, LayerKind::surface, see);
        const auto result = smooth_all(view, LayerKind::surface).mean;
        CHECK(largest_error(view, result) < 1e-5f);        // rounding
        CHECK(largest_error(view, result, true) < 1e-5f);  // put together from the same samples as the truth
        FilterView planted = view;
        planted.features = without_normals(view.features);
        CHECK(largest_error(planted, smooth_all(planted, LayerKind::surface).mean) > 0.1f);
    }
}

TEST_CASE("A pixel at an edge is put together where it is noisy, and left alone where it is not",
          "[layer_filter]") {
    const auto two_lights = [](const Vec3& d) {
        Seen seen = see_step(d + Vec3(0.005f, 0, 0));  // the edge lies within pixels
        seen.light = d.x < -0.005f ? Rgb(1.0f) : Rgb(3.0f);
        return seen;
    };
    FilterView view = make_view(64, 40, LayerKind::surface, two_lights);
    REQUIRE(view.features.mixed.size() == 40);
    const auto squared = [&](const std::vector<Rgb>& values) {
        double sum = 0.0;
        for (const std::uint32_t i : view.features.mixed)
            sum += double(average((values[i] - view.truth[i]) * (values[i] - view.truth[i])));
        return sum;
    };
    const NoisyLayer noisy = add_noise(view.truth, 4.0f, 8, 2);
    const auto result = filter_layer(view.features, noisy.with(LayerKind::surface), {});
    CHECK(squared(result.mean) < squared(noisy.mean) / 10.0);
    // Something that no neighbour has, and hardly any noise.
    for (const std::uint32_t i : view.features.mixed) view.truth[i] += Rgb(0.3f);
    const NoisyLayer clear = add_noise(view.truth, 1e-4f, 8, 2);
    const auto kept = filter_layer(view.features, clear.with(LayerKind::surface), {});
    CHECK(squared(kept.mean) < 40.0 * sqr(1e-3));
}

TEST_CASE("Media before a slanted wall are smoothed, before a step they are not", "[layer_filter]") {
    const auto before_wall = [](const Vec3& d) {
        Seen seen = see_gradient(d);
        fill_with_fog(seen), seen.light = Rgb(1.0f + 0.5f * d.x / d.z);
        return seen;
    };
    FilterView wall = make_view(64, 40, LayerKind::volume, before_wall);
    const NoisyLayer noisy = add_noise(wall.truth, 0.1f, 16, 1);
    const auto left = filter_layer(wall.features, noisy.with(LayerKind::volume), {}).variance;
    CHECK(left[20 * 64 + 32] < 0.02f * 0.01f / 16.0f);
    // Modulation and light vary within a pixel, and their product's mean is not the product of means: by the
    // covariance over a pixel, 1/12 of the slopes across it, below 1e-5 here.
    CHECK(largest_error(wall, smooth_all(wall, LayerKind::volume).mean) < 1e-3f);

    const auto before_step = [](const Vec3& d) {
        Seen seen = see_step(d);
        seen.sample.distance *= d.x < 0.0f ? 0.3f : 1.0f, seen.sample.position *= d.x < 0.0f ? 0.3f : 1.0f;
        fill_with_fog(seen), seen.light = Rgb(d.x < 0.0f ? 1.0f : 3.0f);
        return seen;
    };
    const FilterView step = make_view(64, 40, LayerKind::volume, before_step);
    CHECK(largest_error(step, smooth_all(step, LayerKind::volume).mean) < 1e-4f);
}

TEST_CASE("Where a medium ends its layer ends", "[layer_filter]") {
    const auto half_fog = [](const Vec3& d) {
        Seen seen = see_wall(d);
        if (d.x < 0.0f) fill_with_fog(seen);
        seen.light = Rgb(2.0f);
        return seen;
    };
    const FilterView view = make_view(64, 40, LayerKind::volume, half_fog);
    const auto result = smooth_all(view, LayerKind::volume).mean;
    CHECK(largest_error(view, result) < 1e-5f);
    for (int y = 0; y < 40; ++y)
        for (int x = 32; x < 64; ++x) CHECK(result[std::size_t(y * 64 + x)] == Rgb(0.0f));
}

TEST_CASE("The filter is unbiased on both sides of a corner", "[layer_filter]") {
    const FilterView view = make_view(32, 24, LayerKind::surface, see_corner);
    const FilterFeatures planted = without_normals(view.features);
    constexpr int seeds = 60;
    // The mean of each wall, beside the corner, where a leak would be seen.
    const auto z_of = [&](const FilterFeatures& features, int x0, int x1) {
        double sum = 0.0, squares = 0.0;
        for (int seed = 0; seed < seeds; ++seed) {
            const NoisyLayer noisy = add_noise(view.truth, 4.0f, 8, unsigned(seed));
            const auto result = filter_layer(features, noisy.with(LayerKind::surface), {});
            double error = 0.0;
            for (int y = 0; y < 24; ++y)
                for (int x = x0; x < x1; ++x)
                    error += double(
                        average(result.mean[std::size_t(y * 32 + x)] - view.truth[std::size_t(y * 32 + x)]));
            sum += error, squares += error * error;
        }
        const double mean = sum / seeds, variance = (squares / seeds - mean * mean) / (seeds - 1);
        return mean / std::sqrt(variance);
    };
    CHECK(std::abs(z_of(view.features, 8, 16)) < 4.0);
    CHECK(std::abs(z_of(view.features, 16, 24)) < 4.0);
    CHECK(z_of(planted, 8, 16) < -8.0);
    CHECK(z_of(planted, 16, 24) > 8.0);
}

TEST_CASE("What is left of the variance is what repeated renders show", "[layer_filter]") {
    // With all details gone the filter is linear, and the estimate from probes without bias. Their signs
    // depend on the pixel's number alone, so a tall picture of many equal walls, none of which lies in the
    // plane of another, has independent ones: one number a wall, the mean over seeds and pixels of the
    // squared error, smoothed as the estimate is, and that of the estimate.
    constexpr int walls = 64, seeds = 8;
    const auto grey_wall = [](const Vec3& d) {
        Seen seen = see_gradient(d);
        seen.sample.reflected = Rgb(0.5f);  // the noise of all channels is alike: one probe represents them
        return seen;
    };
    const FilterView tall = repeated(make_view(32, 20, LayerKind::surface, grey_wall), walls);
    std::vector<double> error(walls, 0.0), estimate(walls, 0.0);
    for (int seed = 0; seed < seeds; ++seed) {
        const NoisyLayer noisy = add_noise(tall.truth, 4.0f, 8, unsigned(1000 + seed));
        const LayerToFilter layer = noisy.with(LayerKind::surface);
        const auto result = filter_layer(tall.features, layer, no_details);
        std::vector<float> squared;
        for (std::size_t i = 0; i < tall.truth.size(); ++i) {
            const Rgb d = result.mean[i] - tall.truth[i];
            squared.push_back(average(d * d));
        }
        squared = smoothed(FilterPlanes(tall.features, layer), squared, {});
        for (std::size_t i = 0; i < squared.size(); ++i)
            error[i / (32 * 20)] += double(squared[i]), estimate[i / (32 * 20)] += double(result.variance[i]);
    }
    const auto z_of = [&](double factor) {
        double sum = 0.0, squares = 0.0;
        for (std::size_t w = 0; w < walls; ++w) {
            const double difference = error[w] - factor * estimate[w];
            sum += difference, squares += difference * difference;
        }
        const double mean = sum / walls;
        return mean / std::sqrt((squares / walls - mean * mean) / (walls - 1));
    };
    CHECK(std::abs(z_of(1.0)) < 4.0);
    CHECK(z_of(0.5) > 4.0);  // planted: half, and twice, of the estimate
    CHECK(z_of(2.0) < -4.0);
}

TEST_CASE("Noise falls twentyfold on a wall, and with more passes the picture is the mean",
          "[layer_filter]") {
    FilterView view = make_view(64, 40, LayerKind::surface, see_gradient);
    const auto error = [&](float deviation, bool filtered) {
        const NoisyLayer noisy = add_noise(view.truth, deviation, 8, 5);
        const auto result = filter_layer(view.features, noisy.with(LayerKind::surface), {});
        double sum = 0.0;
        for (std::size_t i = 0; i < view.truth.size(); ++i) {
            const Rgb d = (filtered ? result.mean[i] : noisy.mean[i]) - view.truth[i];
            sum += double(average(d * d));
        }
        return sum;
    };
    CHECK(error(4.0f, true) < error(4.0f, false) / 20.0);
    // A pattern that features do not have: a detail of every size.
    for (std::size_t i = 0; i < view.truth.size(); ++i)
        view.truth[i] *= 1.0f + 0.5f * std::sin(float(i % 64) * float(i % 64) * 0.05f);
    for (const float deviation : {0.3f, 0.03f, 0.003f}) {
        CAPTURE(deviation);
        // At worst as much as noise (k = 2), where energies are known; here they are estimated from 25
        // pixels.
        CHECK(error(deviation, true) < error(deviation, false) * 1.1);
    }
}

TEST_CASE("The filter does not depend on threads", "[layer_filter]") {
    const FilterView view = make_view(100, 37, LayerKind::surface, see_corner);
    const NoisyLayer noisy = add_noise(view.truth, 1.0f, 8, 3);
    const auto with = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return filter_layer(view.features, noisy.with(LayerKind::surface), {});
    };
    const FilteredLayer one = with(1), many = with(4);
    CHECK(std::memcmp(one.mean.data(), many.mean.data(), one.mean.size() * sizeof(Rgb)) == 0);
    CHECK(one.variance == many.variance);
}

TEST_CASE("Outliers that met in one pixel are no detail", "[layer_filter]") {
    // Four passes found rare light in one pixel; otherwise one did in every twentieth: all of the light
    // again.
    constexpr float outlier = 1.0f, chance = 0.05f;
    for (const bool edge : {false, true}) {
        const FilterView view = make_view(60, 50, LayerKind::surface, [&](const Vec3& d) {
            Seen seen = edge ? see_step(d + Vec3(0.005f, 0, 0)) : see_wall(d);  // the edge lies within pixels
            seen.light = Rgb(1.0f);
            return seen;
        });
        REQUIRE(view.features.mixed.empty() != edge);
        const std::size_t dot = edge ? view.features.mixed[view.features.mixed.size() / 2] : 25 * 60 + 30;
        NoisyLayer noisy{view.truth, view.truth};
        Rng rng(5);
        for (std::size_t i = 0; i < view.truth.size(); ++i) {
            const float found = i == dot ? 4.0f : rng.next_float() < chance ? 1.0f : 0.0f;
            noisy.mean[i] *= 1.0f - outlier * chance + outlier * found;
            noisy.variance[i] *= view.truth[i] * (sqr(outlier) * found + 1e-4f);
        }
        const FilteredLayer filtered = filter_layer(view.features, noisy.with(LayerKind::surface), {});
        INFO("edge " << edge << ": " << filtered.mean[dot].y << " of " << noisy.mean[dot].y << ", truth "
                     << view.truth[dot].y);
        // Not discarded: shared with its neighbours. A seventh of it stays, the centre of the kernel.
        CHECK(filtered.mean[dot].y < view.truth[dot].y + 0.16f * (noisy.mean[dot].y - view.truth[dot].y));
        CHECK(filtered.mean[dot].y > 0.85f * view.truth[dot].y);
    }
}

TEST_CASE("Black, damaged and tiny layers are safe", "[layer_filter]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    FilterView view = make_view(20, 15, LayerKind::surface, see_corner);
    NoisyLayer noisy = add_noise(view.truth, 1.0f, 8, 3);
    const auto clean = filter_layer(view.features, noisy.with(LayerKind::surface), {});
    noisy.mean[5].x = nan, noisy.variance[40].y = infinity, view.features.reflected[60] = Rgb(0.0f);
    const auto result = filter_layer(view.features, noisy.with(LayerKind::surface), {});
    for (std::size_t i = 0; i < result.mean.size(); ++i)
        if (i != 5) CHECK(is_finite(result.mean[i]));
    CHECK(result.mean[60] == noisy.mean[60]);
    CHECK(result.mean[40] == noisy.mean[40]);

    const FilterView one = make_view(1, 1, LayerKind::surface, see_wall);
    const std::vector<Rgb> black(1, Rgb(0.0f)), sure(1, Rgb(1.0f));
    CHECK(filter_layer(one.features, {black, sure, LayerKind::surface}, {}).mean == black);
    CHECK(filter_layer(one.features, {black, sure, LayerKind::volume}, {}).mean == black);
    CHECK_THROWS_AS(filter_layer(view.features, {black, sure, LayerKind::surface}, {}),
                    std::invalid_argument);
    CHECK_THROWS_AS(FilterFeatures(0, 1, 1), std::invalid_argument);
    const std::atomic<bool> stop{true};
    CHECK_THROWS_AS(filter_layer(view.features, noisy.with(LayerKind::surface), {}, stop), Cancelled);
}
