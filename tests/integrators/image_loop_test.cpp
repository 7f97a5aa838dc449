// The image loop: every pixel once, in the shape of packets that was requested, for all rows or some.
#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "core/render/render_driver.h"
#include "integrators/eye_path/image_loop.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;
using namespace mote::tests;

namespace {

constexpr int width = 37, height = 45;  // no multiples of a tile

struct Loop {
    std::unique_ptr<const Scene> scene = scene_from(box(grey, ""));
    RenderOptions options{.seed = 3, .width = width, .height = height};
    std::unique_ptr<const PixelFilter> filter = make_pixel_filter("box", 0.5f, 0.5f);
    std::atomic<bool> cancelled{false};
    PassImage image{width, height, transport_layer_count(false)};

    /// Pixels by task, in the order in which they were visited.
    std::map<std::size_t, std::vector<glm::ivec2>> visited(const ImageLoopSettings& settings,
                                                           PixelRows rows = {}) {
        ImageLoop<false> loop(*scene, options, settings);
        std::map<std::size_t, std::vector<glm::ivec2>> tasks;
        std::mutex mutex;
        const auto visit = [&](EyeTask<false>& task) {
            std::vector<glm::ivec2> pixels;
            task.for_each_pixel([&](int x, int y) { pixels.emplace_back(x, y); });
            const std::lock_guard lock(mutex);
            tasks[task.index()] = pixels;
            CHECK(task.index() < loop.tasks());
        };
        CHECK(loop.run({0, *filter, cancelled}, image, {}, visit, rows));
        return tasks;
    }
};

}  // namespace

TEST_CASE("the image loop visits every pixel once", "[image_loop]") {
    const ImageLoopSettings settings[] = {{}, {.interleaving = 3}, {.by_rows = true}};
    for (const ImageLoopSettings& s : settings) {
        std::vector<int> visits(std::size_t(width * height), 0);
        for (const auto& [task, pixels] : Loop().visited(s))
            for (const glm::ivec2& p : pixels) ++visits[std::size_t(p.y * width + p.x)];
        CHECK(std::all_of(visits.begin(), visits.end(), [](int n) { return n == 1; }));
    }
}

TEST_CASE("tasks by rows visit their pixels from left to right, row by row", "[image_loop]") {
    const auto before = [](const glm::ivec2& a, const glm::ivec2& b) {
        return a.y != b.y ? a.y < b.y : a.x < b.x;
    };
    for (const bool by_rows : {true, false}) {
        bool sorted = true;
        for (const auto& [task, pixels] : Loop().visited({.by_rows = by_rows}))
            sorted &= std::is_sorted(pixels.begin(), pixels.end(), before);
        CHECK(sorted == by_rows);
    }
}

TEST_CASE("some rows have the tasks that they have among all", "[image_loop]") {
    Loop loop;
    const auto all = loop.visited({.by_rows = true}), some = loop.visited({.by_rows = true}, {16, 32});
    CHECK(some.size() == 3);
    for (const auto& [task, pixels] : some) {
        REQUIRE(all.count(task) == 1);
        CHECK(all.at(task) == pixels);
        CHECK((pixels.front().y == 16 && pixels.back().y == 31));
    }
    CHECK(loop.visited({.by_rows = true}, {32, 1000}).size() == 3);
}

TEST_CASE("paths that are traced one by one store the mean over their samples", "[image_loop]") {
    Loop l;
    constexpr int samples = 3;
    ImageLoop<false> loop(*l.scene, l.options, {.eye_samples = samples, .by_rows = true});
    const PassContext pass{2, *l.filter, l.cancelled};
    CHECK(loop.run(pass, l.image, {}, [&](EyeTask<false>& task) {
        task.trace_each([&](const EyeRay& eye) {
            TransportSum sum;
            sum[Transport::direct] = Rgb(eye.film.x, eye.film.y, 1.0f);
            sum[Transport::indirect] = Rgb(task.walk().rng.next_float(), 0.0f, 0.0f);
            return sum;
        });
    }));
    int wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Rgb film(0.0f);
            float random = 0.0f;
            for (std::uint32_t k = 0; k < samples; ++k) {  // numbered on from pass to pass
                EyeRay eye = make_eye_ray(*l.scene, l.options,
                                          {pass.index * samples + k, *l.filter, l.cancelled}, x, y);
                film += Rgb(eye.film.x, eye.film.y, 1.0f) / float(samples),
                    random += eye.rng.next_float() / float(samples);
            }
            const Rgb& found = l.image.at(std::size_t(Transport::direct), x, y);
            wrong += !(glm::distance(found, film) < 1e-4f * (1.0f + glm::length(film)));
            wrong += !(std::fabs(l.image.at(std::size_t(Transport::indirect), x, y).x - random) < 1e-5f);
            wrong += l.image.finished()[std::size_t(y * width + x)] == 0;
        }
    CHECK(wrong == 0);
}
