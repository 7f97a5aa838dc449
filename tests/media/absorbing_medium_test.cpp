// Media that only absorb: no distances, nothing decided, one answer from all techniques.
#include "media/homogeneous_medium.h"
#include "tests/media/test_media.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;

namespace {

const Ray ray{Vec3(0.05f, 0.1f, 0.15f), glm::normalize(Vec3(0.8f, 0.7f, 0.6f)), 0.0f, 1.05f};

/// Properties of repeated walks: all pass, none changes its pdfs, all have one value.
struct Walks {
    bool pass = true, pdfs_untouched = true, one_value = true;
};
Walks walks_through(const Medium& medium) {
    Walks result;
    Rng rng(3);
    TrackingCounters counters;
    std::optional<Rgb> first;
    for (int i = 0; i < 1000; ++i) {
        PathWeights walk, connected;
        walk.light = connected.light = Rgb(0.5f), walk.hero = i % 3;
        Rgb emitted(0.0f);
        result.pass &= !medium.sample_collision(ray, walk, emitted, rng, counters);
        medium.connect(ray, connected, rng, counters);
        for (const PathWeights& w : {walk, connected}) {
            result.pdfs_untouched &= w.unidirectional == Rgb(1.0f) && w.light == Rgb(0.5f);
            if (!first) first = w.throughput;
            result.one_value &= w.throughput == *first;
        }
    }
    return result;
}

}  // namespace

TEST_CASE("a homogeneous medium that only absorbs is passed with its transmittance", "[media][absorbing]") {
    const Rgb sigma(0.01f, 1.0f, 4.0f);
    const auto phase = std::make_shared<media::IsotropicPhase>();
    const media::HomogeneousMedium absorbing(sigma, Rgb(0.0f), Rgb(0.0f), phase);
    const Walks walks = walks_through(absorbing);
    CHECK(walks.pass);
    CHECK(walks.pdfs_untouched);
    CHECK(walks.one_value);
    const auto e = tests::spectral_estimates(absorbing, ray, 30, 1);
    for (std::size_t c = 0; c < 3; ++c) {
        const double t = std::exp(-double(sigma[int(c)]) * double(ray.t_max));
        for (const tests::Mean& mean : {e.escape[c], e.connection[c], e.two_techniques[c]})
            CHECK(mean.sigmas_from(t, 1e-6) < 5.0);
    }
    // One that scatters, however little, does need distances.
    CHECK_FALSE(walks_through(media::HomogeneousMedium(sigma, Rgb(0.0f, 0.0f, 0.1f), Rgb(0.0f), phase)).pass);
}

TEST_CASE("a grid that only absorbs is passed with an estimate of its transmittance", "[media][absorbing]") {
    for (const int channels : {1, 3}) {
        const auto m = tests::medium_of(tests::random_grid({12, 9, 14}, channels, 4),
                                        tests::medium_parts(Rgb(0.0f), 1.5f));
        const Walks walks = walks_through(*m);
        CHECK(walks.pass);
        CHECK(walks.pdfs_untouched);
        const Vec3d tau = tests::quadrature_depth(*m, ray, ray.t_max, 20000);
        const auto e = tests::spectral_estimates(*m, ray, 60000, 6);
        CHECK(tests::worst_sigmas(e, tau, Rgb(0.0f), 2e-5) < 5.0);
        CHECK(tests::worst_sigmas(e, 1.05 * tau, Rgb(0.0f), 2e-5) > 5.0);
        CHECK_FALSE(walks_through(*tests::medium_of(tests::random_grid({12, 9, 14}, channels, 4),
                                                    tests::medium_parts(Rgb(0.0f, 0.1f, 0.0f), 1.5f)))
                        .pass);
    }
    // A glowing medium is tracked: light sampling of the glow is weighted against tracking.
    auto glowing = tests::medium_parts(Rgb(0.0f), 1.5f);
    glowing.emission.radiance = std::make_shared<media::ConstantVolume>(Rgb(1.0f));
    CHECK_FALSE(walks_through(*tests::medium_of(tests::random_grid({12, 9, 14}, 1, 4), glowing)).pass);
}
