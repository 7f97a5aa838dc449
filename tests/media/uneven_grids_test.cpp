// Grids whose sides differ, with values that distinguish the three axes.
#include "tests/media/test_media.h"
#include "tests/support/catch.h"

using namespace mote;
using core::Rgb, core::Vec3;

TEST_CASE("every voxel of an uneven grid stands at its own place", "[media][vol][directions]") {
    const glm::ivec3 n(2, 3, 5);
    const auto value = [](int x, int y, int z) { return Rgb(float(x + 10 * y + 100 * z)); };
    for (const int channels : {1, 3})
        for (const media::WrapMode wrap :
             {media::WrapMode::clamp, media::WrapMode::repeat, media::WrapMode::mirror}) {
            const media::GridVolume volume(
                tests::vol_grid(n, channels,
                                [&](int x, int y, int z) { return value(x, y, z) * Rgb(1.0f, 2.0f, 3.0f); }),
                {}, false, "x", wrap);
            int wrong = 0;
            for (int z = 0; z < n.z; ++z)
                for (int y = 0; y < n.y; ++y)
                    for (int x = 0; x < n.x; ++x) {
                        const Vec3 at = (Vec3(float(x), float(y), float(z)) + 0.5f) / Vec3(n);
                        const Rgb expected = value(x, y, z) * (channels == 3 ? Rgb(1, 2, 3) : Rgb(1.0f));
                        wrong += glm::length(volume.eval(at) - expected) > 1e-3f * (1.0f + expected.z);
                        // A quarter of a voxel beyond the first one outside, along z.
                        if (z > 0) continue;
                        const int near = wrap == media::WrapMode::repeat ? 0 : n.z - 1;
                        const int far = wrap == media::WrapMode::repeat   ? 1
                                        : wrap == media::WrapMode::mirror ? n.z - 2
                                                                          : n.z - 1;
                        const Rgb outside = (0.75f * value(x, y, near) + 0.25f * value(x, y, far)) *
                                            (channels == 3 ? Rgb(1, 2, 3) : Rgb(1.0f));
                        wrong += glm::length(volume.eval({at.x, at.y, 1.0f + 0.75f / float(n.z)}) - outside) >
                                 1e-3f * (1.0f + outside.z);
                    }
            INFO("channels " << channels << ", wrap " << int(wrap));
            CHECK(wrong == 0);
        }
}

TEST_CASE("bounds of an uneven grid hold what is in its cells", "[media][majorants][directions]") {
    // One dense voxel, where no exchange of axes leaves it.
    const glm::ivec3 n(40, 24, 56), hot(33, 4, 50);
    media::DenseVoxels voxels{n, 1, std::vector<float>(std::size_t(n.x * n.y * n.z), 0.1f)};
    voxels.values[std::size_t((hot.z * n.y + hot.y) * n.x + hot.x)] = 9.0f;
    const auto majorants = media::dense_majorants<float>(voxels);
    const auto highest_along = [&](const core::Vec3d& origin, const core::Vec3d& direction) {
        float highest = 0.0f;
        majorants.walk(origin, direction, 0.0, 100.0, [&](const auto& range, double, double) {
            highest = std::max(highest, range.upper);
            return true;
        });
        return highest;
    };
    CHECK(highest_along({-10, 4, 50}, {1, 0, 0}) == 9.0f);
    CHECK(highest_along({33, -10, 50}, {0, 1, 0}) == 9.0f);
    CHECK(highest_along({33, 4, -10}, {0, 0, 1}) == 9.0f);
    CHECK(highest_along({-10, 20, 20}, {1, 0, 0}) < 1.0f);
}
