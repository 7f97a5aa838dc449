// Kernels of mote_upbp over passes and numbers of light paths: what shrinks is their measure, by the
// dimension of each (Knaus and Zwicker 2011).
#include <array>
#include <cmath>

#include "integrators/upbp/merge_schedule.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::integrators;

namespace {

constexpr std::array dimensions{2, 3, 2, 1};  ///< by Merge

double measure(const MergeSettings& m, std::size_t technique) {
    return std::pow(m.radius[technique], dimensions[technique]);
}

}  // namespace

TEST_CASE("kernels shrink by their dimension", "[upbp][schedule]") {
    UpbpSettings settings;
    settings.radius = 0.02, settings.alpha = 0.6;
    const MergeSettings first = merges_of_pass(settings, 0, 5.0, 100, 100, true);
    for (std::size_t t = 0; t < merge_count; ++t) {
        INFO("technique " << t);
        CHECK(first.radius[t] == Approx(0.1));
        CHECK(first.light_subpaths[t] == 100.0);
        double expected = 1.0;
        for (std::uint32_t pass = 1; pass <= 40; ++pass) {
            expected *= (pass + settings.alpha) / (pass + 1.0);
            const MergeSettings now = merges_of_pass(settings, pass, 5.0, 100, 100, true);
            CHECK(measure(now, t) / measure(first, t) == Approx(expected).epsilon(1e-9));
        }
        // A query then finds as many of a million light paths as of ten thousand; of beams, as of a hundred.
        const MergeSettings many = merges_of_pass(settings, 0, 5.0, 1000000, 1000000, true);
        const double paths = dimensions[t] == 1 ? 500.0 : 1e6, few = dimensions[t] == 1 ? 100.0 : 1e4;
        CHECK(many.light_subpaths[t] == paths);
        CHECK(measure(many, t) * paths == Approx(measure(first, t) * few).epsilon(1e-9));
    }
    // A trial's larger kernels find as many of its fewer light paths.
    const MergeSettings picture = merges_of_pass(settings, 3, 5.0, 64000, 64000, true);
    const MergeSettings trial = merges_of_pass(settings, 3, 5.0, 64000, 8000, true);
    for (std::size_t t = 0; t < merge_count; ++t) {
        CHECK(trial.light_subpaths[t] == (dimensions[t] == 1 ? 500.0 : 8000.0));
        CHECK(measure(trial, t) * trial.light_subpaths[t] ==
              Approx(measure(picture, t) * picture.light_subpaths[t]).epsilon(1e-9));
    }
    const MergeSettings nothing = merges_of_pass(settings, 0, 5.0, 100, 100, false);
    for (std::size_t t = 0; t < merge_count; ++t) CHECK(nothing.uses(Merge(t)) == (t == 0));
    CHECK(merges_of_pass(settings, 0, 0.0, 100, 100, true).radius[0] == Approx(0.02));
}
