// Fields of guided paths: mixtures from samples of known ones, leaves, parallax, and samples that teach
// little.
#include "lights/guiding/guiding_field.h"

#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/objects/memory_error.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::lights;

namespace {

Vec3 direction(Rng& rng) { return glm::normalize(square_to_sphere(rng.next_vec2())); }

/// Uniform directions at one place, weighted by the radiance of a mixture.
std::vector<GuidingSample> samples_of(const VmfMixture& m, int count, std::uint64_t seed) {
    Rng rng(seed);
    std::vector<GuidingSample> samples;
    for (int i = 0; i < count; ++i) {
        const Vec3 w = direction(rng);
        samples.push_back({Vec3(0.0f), w, m.pdf_solid_angle(w) / inv_four_pi, 0.0f});
    }
    return samples;
}

VmfMixture three_lobes() {
    VmfMixture m = even_mixture();
    for (int k = 3; k < VmfMixture::capacity; ++k) m.set(k, {}, 0.0f);
    m.set(0, {{0, 0, 1}, 12.0f}, 0.5f);
    m.set(1, {glm::normalize(Vec3(1, 1, -0.2f)), 40.0f}, 0.3f);
    m.set(2, {glm::normalize(Vec3(-1, 0.4f, -1)), 5.0f}, 0.2f);
    return m;
}

/// Kullback-Leibler divergence of q from p, by samples of p.
double divergence(const VmfMixture& p, const VmfMixture& q) {
    Rng rng(99);
    double sum = 0.0;
    const int count = 40000;
    for (int i = 0; i < count; ++i) {
        const float u = rng.next_float();
        const Vec3 w = p.sample(u, rng.next_vec2());
        sum += std::log(double(p.pdf_solid_angle(w)) / double(q.pdf_solid_angle(w)));
    }
    return sum / count;
}

/// Samples on the floor of a square of edge `size` lit by a point at height `size` above its middle.
std::vector<GuidingSample> lit_floor(float size, int count, std::uint64_t seed,
                                     const Vec3& offset = Vec3(0.0f)) {
    Rng rng(seed);
    std::vector<GuidingSample> samples;
    for (int i = 0; i < count; ++i) {
        const Vec3 x = size * Vec3(rng.next_float() - 0.5f, rng.next_float() - 0.5f, 0.0f);
        const Vec3 to = Vec3(0.0f, 0.0f, size) - x;
        samples.push_back({offset + x, glm::normalize(to), 1.0f, 1.0f / glm::length(to)});
    }
    return samples;
}

GuidingField field(double leaf_samples = 4000.0, double bytes = 4e6) {
    return GuidingField({leaf_samples, bytes}, MemoryBudget(1e9));
}

}  // namespace

TEST_CASE("A mixture is learned from samples of it", "[guiding]") {
    MixtureFit fit(Vec3(0.0f));
    for (int batch = 0; batch < 6; ++batch) fit.add(samples_of(three_lobes(), 20000, std::uint64_t(batch)));
    const double learned = divergence(three_lobes(), fit.at(Vec3(0.0f)));
    CAPTURE(learned, divergence(three_lobes(), even_mixture()));
    CHECK(learned < 0.03);
    CHECK(divergence(three_lobes(), even_mixture()) > 0.5);  // where it began
}

TEST_CASE("Fits depend on weights up to a factor only", "[guiding]") {
    auto samples = samples_of(three_lobes(), 5000, 3);
    MixtureFit fit(Vec3(0.0f)), dim(Vec3(0.0f));
    fit.add(samples);
    for (GuidingSample& s : samples) s.weight *= 1e-20f;
    dim.add(samples);
    CHECK(divergence(fit.at(Vec3(0.0f)), dim.at(Vec3(0.0f))) == Approx(0.0).margin(1e-4));
}

TEST_CASE("One sample, however bright, leaves a wide mixture", "[guiding]") {
    MixtureFit fit(Vec3(0.0f));
    fit.add(samples_of(three_lobes(), 2000, 4));
    const Vec3 firefly = glm::normalize(Vec3(0.3f, -1.0f, 0.1f));
    const GuidingSample bright{Vec3(0.0f), firefly, 1e9f, 0.0f};
    fit.add({&bright, 1});
    const VmfMixture m = fit.at(Vec3(0.0f));
    for (int k = 0; k < VmfMixture::capacity; ++k)
        if (glm::dot(m.lobe(k).mean, firefly) > 0.9f) CHECK(m.kappa[k] < 10.0f);
    Rng rng(5);
    for (int i = 0; i < 200; ++i) CHECK(m.pdf_solid_angle(direction(rng)) > 1e-5f);
}

TEST_CASE("A caustic that appeared once in training is forgotten", "[guiding]") {
    // A path a million times as bright as all others: it draws at most its lobes, which later passes bring
    // back to where light is; directions keep their density meanwhile.
    MixtureFit fit(Vec3(0.0f)), calm(Vec3(0.0f));
    const Vec3 firefly = glm::normalize(Vec3(0.3f, -1.0f, 0.1f));
    auto samples = samples_of(three_lobes(), 4000, 4);
    calm.add(samples);
    double light = 0.0;
    for (const GuidingSample& s : samples) light += double(s.weight);
    samples.push_back({Vec3(0.0f), firefly, float(1e6 * light), 0.0f});
    fit.add(samples);
    for (const GuidingSample& s : samples) CHECK(fit.at(Vec3(0.0f)).pdf_solid_angle(s.direction) > 1e-4f);
    for (int pass = 0; pass < 30; ++pass) {  // each halves what was learned before
        fit.scale(0.5), calm.scale(0.5);
        const auto later = samples_of(three_lobes(), 4000, std::uint64_t(10 + pass));
        fit.add(later), calm.add(later);
    }
    const double locked = divergence(three_lobes(), fit.at(Vec3(0.0f)));
    CAPTURE(locked, divergence(three_lobes(), calm.at(Vec3(0.0f))));
    CHECK(locked < 0.1);
}

TEST_CASE("Nothing learned is an empty mixture, and directions without light teach nothing", "[guiding]") {
    GuidingField f = field();
    CHECK(f.at(Vec3(1.0f)).empty);
    std::vector<GuidingSample> none;
    f.add(none);
    CHECK(f.leaves().empty());
    auto dark = lit_floor(1.0f, 100, 1);
    for (GuidingSample& s : dark) s.weight = 0.0f;
    f.add(dark);
    CHECK(f.at(Vec3(0.0f)).empty);
    std::vector<GuidingSample> one{{Vec3(0.0f), {0, 0, 1}, 2.0f, 0.5f}};
    f.add(one);
    REQUIRE_FALSE(f.at(Vec3(0.0f)).empty);
    CHECK(std::isfinite(f.at(Vec3(0.0f)).pdf_solid_angle({0, 0, 1})));
}

TEST_CASE("Weights that are no radiance are refused", "[guiding]") {
    for (const float weight : {infinity, -1.0f, std::nanf("")}) {
        GuidingField f = field();
        std::vector<GuidingSample> bad{{Vec3(0.0f), {0, 0, 1}, weight, 0.0f}};
        CHECK_THROWS_AS(f.add(bad), std::invalid_argument);
    }
}

TEST_CASE("A near light is seen by parallax from anywhere in a leaf", "[guiding]") {
    for (const float size : {1e-3f, 1.0f, 1e5f}) {
        GuidingField f = field(1e9);  // a single leaf
        for (std::uint64_t batch = 0; batch < 4; ++batch) {
            auto samples = lit_floor(size, 4000, batch);
            f.add(samples);
        }
        REQUIRE(f.leaves().size() == 1);
        for (const Vec3& place : {Vec3(0.4f, 0.4f, 0), Vec3(-0.5f, 0, 0), Vec3(0.0f)}) {
            const Vec3 to = glm::normalize(Vec3(0, 0, 1) - place);
            INFO("size " << size);
            CHECK(f.at(size * place).pdf_solid_angle(to) >
                  100.0f);  // without parallax 3 and less in the corner
        }
    }
}

TEST_CASE("Leaves are split, keep what was learned, and stay within their memory", "[guiding]") {
    GuidingField f = field(500.0);
    auto samples = lit_floor(1.0f, 20000, 1);
    double light = 0.0, count = 0.0;
    f.add(samples);
    for (const MixtureFit& leaf : f.leaves()) light += leaf.light(), count += leaf.samples();
    CHECK(f.leaves().size() > 30);
    CHECK(light == Approx(20000.0).epsilon(1e-4));
    CHECK(count == Approx(20000.0));
    auto more = lit_floor(1.0f, 20000, 2);
    f.add(more);
    light = 0.0;
    for (const MixtureFit& leaf : f.leaves()) light += leaf.light();
    CHECK(light == Approx(40000.0).epsilon(1e-4));  // halves add up to what their leaf had
    // A leaf is found where its samples lie.
    Rng rng(3);
    for (int i = 0; i < 100; ++i) {
        const Vec3 x(rng.next_float() - 0.5f, rng.next_float() - 0.5f, 0.0f);
        CHECK(glm::distance(f.leaves()[f.leaf_of(x)].pivot(), x) < 0.4f);
    }

    GuidingField small = field(10.0, 20 * 1024.0);
    auto again = lit_floor(1.0f, 20000, 1);
    small.add(again);
    CHECK(small.leaves().size() * sizeof(MixtureFit) <= 20 * 1024);
    CHECK(small.leaves().size() > 10);
    CHECK_THROWS_AS(field(8000.0, 1e10), OutOfMemory);
}

TEST_CASE("Samples at one place, and far from the origin, are no trouble", "[guiding]") {
    GuidingField f = field(100.0);
    std::vector<GuidingSample> same(5000, {Vec3(1e5f, 2.0f, 3.0f), {0, 0, 1}, 1.0f, 0.0f});
    f.add(same);
    CHECK(f.leaves().size() == 1);
    const VmfMixture m = f.at({1e5f, 2.0f, 3.0f});
    CHECK(m.pdf_solid_angle({0, 0, 1}) > 1e3f);  // a delta light is a narrow lobe
    CHECK(std::isfinite(m.pdf_solid_angle({0, 0, 1})));
    auto far = lit_floor(10.0f, 5000, 1, Vec3(1e5f));
    f.add(far);
    CHECK(f.leaves().size() > 10);
}

TEST_CASE("The order of threads does not matter to a field", "[guiding]") {
    const auto learn = [] {
        GuidingField f = field(300.0);
        for (std::uint64_t batch = 0; batch < 3; ++batch) {
            auto samples = lit_floor(1.0f, 10000, batch);
            f.add(samples);
        }
        return f;
    };
    const GuidingField a = learn(), b = learn();
    REQUIRE(a.leaves().size() == b.leaves().size());
    for (std::size_t i = 0; i < a.leaves().size(); ++i)
        for (int k = 0; k < VmfMixture::capacity; ++k)
            CHECK(a.leaves()[i].mixture().kappa[k] == b.leaves()[i].mixture().kappa[k]);
}
