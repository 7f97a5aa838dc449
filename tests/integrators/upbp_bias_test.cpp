// Merges in media find the light of single scattering in the limit of a small kernel, and miss it by the
// square of the radius: every technique alone, without noise by a quadrature over its kernel.
#include <fmt/format.h>

#include <array>
#include <fstream>

#include "tests/integrators/kernel_slices.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string fog(const std::string& sigma_t, double g) {
    return fmt::format(R"(<medium type="homogeneous" id="air"><rgb name="sigma_t" value="{}"/>
        <rgb name="albedo" value="0.9, 0.8, 0.7"/><phase type="hg"><float name="g" value="{}"/></phase></medium>)",
                       sigma_t, g);
}
/// A hill of smoke that fades to nothing at all sides of [-2, 2]^3. The kernels of these tests lie between
/// the same voxel centres: across them the density has edges, and bias another order until the radius is
/// smaller than a voxel. Transmittances are marched, so that there is no noise.
std::string hill(const std::string& path, const Rgb& sigma_t, double g) {
    constexpr std::int32_t n = 8;
    std::ofstream file(path, std::ios::binary);
    const auto write = [&](auto value) { file.write(reinterpret_cast<const char*>(&value), sizeof value); };
    file.write("VOL\3", 4);
    for (const std::int32_t v : {1, n, n, n, 3}) write(v);
    for (const float v : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f}) write(v);
    const auto along = [](int i) { return float(sqr(std::cos(pi * (float(i) - 3.5f) / 7.0f))); };
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                for (int c = 0; c < 3; ++c) write(along(x) * along(y) * along(z) * sigma_t[c]);
    return fmt::format(R"(<medium type="heterogeneous" id="air">
        <string name="transmittance" value="ray_marching"/><float name="marching_tolerance" value="1e-6"/>
        <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="4"/></transform></volume>
        <rgb name="albedo" value="0.9, 0.8, 0.7"/><phase type="hg"><float name="g" value="{}"/></phase></medium>)",
                       path, g);
}

using Biases = std::array<double, 3>;  ///< at r, r / 2 and r / 4

/// Is it a r^2 + b r^4, with a small second term? The exponent between radii then differs from 2, and by a
/// quarter of that between their halves. A relative 1e-6 is left to rounding.
bool second_order(const Biases& e) {
    const double first = std::log2(e[0] / e[1]) - 2.0, then = std::log2(e[1] / e[2]) - 2.0;
    const double rounding = 1e-6 * (1.0 / std::fabs(e[1]) + 1.0 / std::fabs(e[2])) / std::log(2.0);
    return std::fabs(first) < 0.1 && std::fabs(then - first / 4.0) < 0.1 * std::fabs(first) + rounding;
}

void check_order(const KernelSlices& slices, Merge technique, BeamLength light_beams) {
    std::array<Vec3d, 3> found;
    for (int i = 0; i < 3; ++i)
        found[std::size_t(i)] = slices.bias(technique, 0.2 * std::exp2(-i), 0.5, light_beams);
    for (int c = 0; c < 3; ++c) {
        const Biases e{found[0][c], found[1][c], found[2][c]};
        INFO(fmt::format("technique {}, light beams {}, channel {}: {}, {}, {}", int(technique),
                         int(light_beams), c, e[0], e[1], e[2]));
        CHECK(second_order(e));
        CHECK_FALSE(second_order({e[0] - 1e-3, e[1] - 5e-4, e[2] - 2.5e-4}));  // of first order
        CHECK_FALSE(second_order({e[0] + 1e-3, e[1] + 1e-3, e[2] + 1e-3}));    // another limit
    }
}

}  // namespace

TEST_CASE("the bias of merges falls with the square of the radius", "[upbp][bias]") {
    TemporaryFolder folder;
    for (const double g : {-0.8, 0.0, 0.8}) {
        const std::pair<std::string, bool> media[] = {
            {fog("0.9", g), true},
            {fog("0.6, 0.9, 1.2", g), true},
            {hill(folder.file("grey.vol"), Rgb(1.5f), g), true},
            {hill(folder.file("coloured.vol"), Rgb(1.0f, 1.5f, 2.0f), g), false}};
        for (const auto& [medium, short_beams] : media) {
            INFO(medium);
            const KernelSlices slices(medium);
            check_order(slices, Merge::point_point_3d, BeamLength::short_beam);
            check_order(slices, Merge::point_beam_2d, BeamLength::short_beam);
            check_order(slices, Merge::beam_beam_1d, BeamLength::long_beam);
            if (short_beams) check_order(slices, Merge::beam_beam_1d, BeamLength::short_beam);
        }
    }
}
