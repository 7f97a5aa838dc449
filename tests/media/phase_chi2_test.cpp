// Every phase function samples directions with the density it claims, by the chi-square test of all
// directions; and the test finds planted errors.
#include <set>

#include "core/scene/phase_function.h"
#include "core/scene/reverse_density.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"
#include "tests/support/registered_cases.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;
using core::Category, core::Vec3;

namespace {

using PhasePtr = std::shared_ptr<const core::PhaseFunction>;

struct PhaseCase {
    std::string type, name;
    PhasePtr phase;
    double cap = 2.0;  ///< 1 - cos of the cap around the lobe that the cells cover
};

/// The cap holds about 95 % of the samples; the lobe is (1 - |g|)^2 wide in 1 - cos.
PhaseCase henyey_greenstein(double g) {
    const double width = 1.0 - std::fabs(g);
    return {"hg", "hg_" + std::to_string(g),
            make_registered<core::PhaseFunction>(registry(), Category::phase, "hg", {{"g", g}}),
            std::min(2.0, 200.0 * width * width)};
}

std::vector<PhaseCase> phase_cases() {
    std::vector<PhaseCase> cases{
        {"isotropic", "isotropic",
         make_registered<core::PhaseFunction>(registry(), Category::phase, "isotropic")}};
    for (const double g : {-0.99, -0.9, -0.3, 0.0, 1e-3, 0.6, 0.9, 0.99}) {
        cases.push_back(henyey_greenstein(g));
        // The cap resolves the lobe, the sphere its tail.
        if (cases.back().cap < 2.0) cases.push_back(cases.back()), cases.back().cap = 2.0;
    }
    return cases;
}

const std::vector<Vec3> viewers = {Vec3(0, 0, 1), glm::normalize(Vec3(0.3f, -0.5f, 0.7f)),
                                   glm::normalize(Vec3(-1.0f, 2.0f, -3.0f))};

Chi2Options options(const PhaseCase& c, std::size_t view, std::size_t tests) {
    Chi2Options o;
    o.name = "phase_" + c.name;
    o.seed = core::hash_keys(0x7068617365ull, view, std::uint64_t(1000.0 * c.cap));
    o.tests = int(tests);
    o.frame = core::Frame(c.phase->mean_cosine() < 0.0f ? viewers[view] : -viewers[view]);
    o.cap = c.cap;
    o.subdivisions = 2;
    if (c.cap == 2.0 && std::fabs(c.phase->mean_cosine()) > 0.95f) o.cos_cells = 64, o.phi_cells = 16;
    return o;
}

DirectionSampler sampler_of(const PhasePtr& phase, const Vec3& wo) {
    return [=](core::Rng& rng) -> std::optional<Vec3> { return phase->sample(wo, rng.next_vec2()).wi; };
}
DirectionDensity density_of(const PhasePtr& phase, const Vec3& wo, double factor = 1.0) {
    return [=](const Vec3& wi) { return factor * double(phase->pdf_solid_angle(wo, wi)); };
}
/// Density of the samples by reverse_pdf_solid_angle() [1/sr], for a path that comes from wi and continues to
/// wo.
DirectionDensity reverse_density(const PhasePtr& phase, const Vec3& wo) {
    return [=](const Vec3& wi) {
        core::ScatteringVertex vertex;
        vertex.phase = phase.get(), vertex.wo = wi;
        return double(core::reverse_pdf_solid_angle(vertex, wo, core::TransportMode::radiance));
    };
}

std::set<std::string> tested_types() {
    std::set<std::string> types;
    for (const PhaseCase& c : phase_cases()) types.insert(c.type);
    return types;
}

/// As strict as within the family of all cases, and without a table.
Chi2Options planted_options(const PhaseCase& c) {
    Chi2Options o = options(c, 1, phase_cases().size() * viewers.size());
    o.write_table = false;
    return o;
}

}  // namespace

TEST_CASE("phase functions sample what they claim by a chi-square test", "[media][phase][chi2]") {
    const std::vector<PhaseCase> cases = phase_cases();
    for (const PhaseCase& c : cases)
        for (std::size_t v = 0; v < viewers.size(); ++v) {
            const Chi2Result result =
                chi2_test(sampler_of(c.phase, viewers[v]), density_of(c.phase, viewers[v]),
                          options(c, v, cases.size() * viewers.size()));
            INFO(result.message);
            CHECK(result.passed);
            const Chi2Result reverse =
                chi2_test(sampler_of(c.phase, viewers[v]), reverse_density(c.phase, viewers[v]),
                          options(c, v, cases.size() * viewers.size()));
            INFO(reverse.message);
            CHECK(reverse.passed);
            if (c.cap == 2.0) CHECK(result.integral == Approx(1.0).epsilon(1e-3));
            // They are normalised and sampled in proportion to their value.
            core::Rng rng(v);
            const core::PhaseSample s = c.phase->sample(viewers[v], rng.next_vec2());
            CHECK(s.pdf_solid_angle == c.phase->pdf_solid_angle(viewers[v], s.wi));
            CHECK(s.weight.x * s.pdf_solid_angle == Approx(c.phase->eval(viewers[v], s.wi).x).epsilon(1e-5));
        }
}

TEST_CASE("every registered phase function has a chi-square case", "[media][phase][chi2][coverage]") {
    for (const std::string& complaint : untested_types(registry(), Category::phase, tested_types()))
        FAIL_CHECK(complaint);
    core::Registry larger = registry();
    larger.add({Category::phase, "rayleigh", "", {}, ""}, [](const core::Properties&) { return nullptr; });
    CHECK(untested_types(larger, Category::phase, tested_types()) ==
          std::vector<std::string>{"no chi² case for phase 'rayleigh'"});
}

TEST_CASE("planted errors of phase functions are caught", "[media][phase][chi2][planted]") {
    const Vec3 wo = viewers[1];
    for (const double g : {-0.9, 0.6, 0.99}) {
        const PhaseCase c = henyey_greenstein(g);
        const Chi2Options o = planted_options(c);
        INFO(c.name);
        const auto sampler = sampler_of(c.phase, wo);
        CHECK(chi2_test(sampler, density_of(c.phase, wo), o).passed);
        // A density off by three per cent.
        CHECK_FALSE(chi2_test(sampler, density_of(c.phase, wo, 0.97), o).passed);
        CHECK_FALSE(chi2_test(sampler, density_of(c.phase, wo, 1.03), o).passed);
        // Forward for backward.
        CHECK_FALSE(chi2_test(sampler_of(c.phase, -wo), density_of(c.phase, wo), o).passed);
        // Another asymmetry: by five per cent of what is left to one.
        const PhaseCase wrong = henyey_greenstein(g + std::copysign(0.05 * (1.0 - std::fabs(g)), g));
        Chi2Options many = o;
        many.samples = 1000000;
        CHECK(chi2_test(sampler, density_of(c.phase, wo), many).passed);
        CHECK_FALSE(chi2_test(sampler_of(wrong.phase, wo), density_of(c.phase, wo), many).passed);
    }
    // The smallest asymmetry worth the name, taken for none.
    const PhaseCase even = henyey_greenstein(0.0), slight = henyey_greenstein(0.02);
    Chi2Options o = planted_options(even);
    o.samples = 1500000;
    CHECK_FALSE(chi2_test(sampler_of(slight.phase, wo), density_of(even.phase, wo), o).passed);
}
