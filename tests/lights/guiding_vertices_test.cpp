// Vertices of guided paths: reflected radiance is learned where it is, and the choice among candidates keeps
// the mean whatever was learned.
#include <cmath>

#include "core/math/random.h"
#include "core/objects/memory_error.h"
#include "lights/guiding/choose_scattering.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::lights;

namespace {

/// Expects radiance that falls with z, in media, and `surface` on surfaces.
class Slope final : public ScatteringGuide {
  public:
    explicit Slope(float surface) : surface_(surface) {}
    void find(const ScatteringVertex&, VmfMixture& lobes) const override { lobes.empty = true; }
    ExpectedRadiance expected(const Vec3& p, bool on_surface) const override {
        const float mean = on_surface ? surface_ : std::exp(-p.z);
        return {2.0f * mean, mean, 0.5f * mean, true};
    }

  private:
    float surface_;
};

std::vector<ScatteringPoint> line_of_points(int count) {
    std::vector<ScatteringPoint> points;
    for (int i = 0; i < count; ++i)
        points.push_back({Vec3(0.0f, 0.0f, float(i)), Rgb(0.1f + 0.02f * float(i), 0.1f, 0.05f)});
    return points;
}

/// Something that paths find at a place.
double found_behind(std::size_t index) { return 1.0 + 3.0 * double(index % 3); }

/// Mean and standard error of weight * found / probability over many choices.
struct ChoiceEstimate {
    double mean = 0.0, error = 0.0;
    bool agrees_with(double exact) const { return std::fabs(mean - exact) < 4.5 * error; }
};
template <typename ProbabilityOf>
ChoiceEstimate estimate_by_choice(std::span<const ScatteringPoint> points, const Rgb& behind,
                                  const ScatteringGuide& guide, const ProbabilityOf& probability_of) {
    Rng rng(11);
    const int count = 40000;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < count; ++i) {
        const ScatteringChoice c =
            choose_scattering(points, behind, Vec3(0.0f, 0.0f, 9.0f), guide, rng.next_float());
        const Rgb weight = c.index < points.size() ? points[c.index].weight : behind;
        const double x = double(average(weight)) * found_behind(c.index) / double(probability_of(c));
        sum += x, squares += x * x;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

}  // namespace

TEST_CASE("The choice of a vertex keeps the mean; a probability that is not divided out does not",
          "[guiding]") {
    const auto points = line_of_points(6);
    const Rgb behind(0.3f, 0.2f, 0.1f);
    double exact = double(average(behind)) * found_behind(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        exact += double(average(points[i].weight)) * found_behind(i);
    for (const float surface : {0.0f, 0.3f, 100.0f}) {
        CAPTURE(surface);
        const Slope guide(surface);
        const auto divided = [](const ScatteringChoice& c) { return c.probability; };
        CHECK(estimate_by_choice(points, behind, guide, divided).agrees_with(exact));
        // Planted: the probability of extinction alone.
        const auto by_extinction = [](const ScatteringChoice& c) { return c.by_extinction; };
        CHECK_FALSE(estimate_by_choice(points, behind, guide, by_extinction).agrees_with(exact));
    }
}

TEST_CASE("Vertices are chosen by what is expected there, and some by extinction", "[guiding]") {
    const auto points = line_of_points(4);
    Rng rng(3);
    int surface = 0;
    const int count = 20000;
    const Rgb behind(0.2f);
    for (int i = 0; i < count; ++i)
        surface += choose_scattering(points, behind, Vec3(0.0f), Slope(0.0f), rng.next_float()).index ==
                   points.size();
    double weights = double(average(behind));
    for (const ScatteringPoint& p : points) weights += double(average(p.weight));
    // Black surfaces: the defensive share of their weight alone, d w / sum w.
    const double p = double(extinction_share) * double(average(behind)) / weights;
    CHECK(std::fabs(surface - count * p) < 4.5 * std::sqrt(count * p * (1.0 - p)));
}

TEST_CASE("A choice without places, with one, and with nothing known", "[guiding]") {
    const Slope guide(1.0f);
    CHECK(choose_scattering({}, Rgb(0.0f), Vec3(0.0f), guide, 0.5f).probability == 0.0f);
    const ScatteringChoice surface = choose_scattering({}, Rgb(0.5f), Vec3(0.0f), guide, one_minus_epsilon);
    CHECK(surface.index == 0);
    CHECK(surface.probability == Approx(1.0f));
    CHECK(surface.expected == Approx(0.5f));
    const auto points = line_of_points(3);
    for (const float u : {0.0f, 0.5f, one_minus_epsilon}) {
        const ScatteringChoice c = choose_scattering(points, Rgb(0.0f), Vec3(0.0f), no_guide(), u);
        CHECK(c.index < points.size());
        CHECK(c.probability == Approx(c.by_extinction));
        CHECK_FALSE(c.known);
    }
    const ScatteringPoint dark{Vec3(0.0f), Rgb(0.0f)};
    CHECK(choose_scattering({&dark, 1}, Rgb(0.0f), Vec3(0.0f), guide, 0.5f).probability == 0.0f);
}

TEST_CASE("Reflected radiance is learned where it is", "[guiding]") {
    ReflectedField field(100.0, 1e6, MemoryBudget(1e9));
    CHECK_FALSE(field.at(Vec3(0.0f)).known);
    Rng rng(5);
    for (int batch = 0; batch < 4; ++batch) {
        std::vector<ReflectedSample> samples;  // a shaft of light: 8 or nothing, half each, where x < 0.3
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p(rng.next_float(), rng.next_float(), rng.next_float());
            const float light = rng.next_float() < 0.5f ? 8.0f : 0.0f;
            samples.push_back({p, p.x < 0.3f ? light : 0.1f, p.x < 0.3f ? 0.25f * light : 0.1f});
        }
        if (batch > 0) field.scale(0.5);
        field.add(samples);
    }
    CHECK(field.leaves().size() > 100);
    const ExpectedRadiance lit = field.at({0.1f, 0.5f, 0.5f}), dark = field.at({0.8f, 0.5f, 0.5f});
    CHECK(lit.known);
    CHECK(lit.mean == Approx(4.0f).epsilon(0.5));  // five standard errors of a leaf of a hundred
    CHECK(lit.root_square == Approx(std::sqrt(32.0f)).epsilon(0.3));
    CHECK(lit.indirect == Approx(0.25f * lit.mean));
    CHECK(dark.mean == Approx(0.1f));
    CHECK(dark.root_square == Approx(0.1f));
}

TEST_CASE("What is no radiance is refused, and memory is bounded", "[guiding]") {
    for (const float radiance : {infinity, -1.0f, std::nanf("")}) {
        ReflectedField field(100.0, 1e6, MemoryBudget(1e9));
        std::vector<ReflectedSample> bad{{Vec3(0.0f), radiance, 0.0f}};
        CHECK_THROWS_AS(field.add(bad), std::invalid_argument);
        bad = {{Vec3(0.0f), 0.0f, radiance}};
        CHECK_THROWS_AS(field.add(bad), std::invalid_argument);
    }
    CHECK_THROWS_AS(ReflectedField(100.0, 1e9, MemoryBudget(1e6)), OutOfMemory);
    ReflectedField small(10.0, 1e4, MemoryBudget(1e9));
    Rng rng(6);
    std::vector<ReflectedSample> samples;
    for (int i = 0; i < 20000; ++i)
        samples.push_back({Vec3(rng.next_float(), rng.next_float(), 0.0f), 1.0f, 1.0f});
    small.add(samples);
    CHECK(small.leaves().size() <= std::size_t(1e4) / sizeof(ReflectedMoments));
    CHECK(small.leaves().size() > 10);
}
