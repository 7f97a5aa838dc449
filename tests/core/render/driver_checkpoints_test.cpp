// Checkpoints: resumed to the very same bits, refused where they are of another render or damaged.
#include "core/render/checkpoint.h"

#include <filesystem>
#include <fstream>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"
#include "tests/core/render/fake_render.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}
void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

// Renders until `last` passes are done, then is interrupted in the middle of the next.
RenderResult interrupted_render(const Scene& scene, RenderRequest request, std::uint32_t last) {
    std::atomic<bool> flag{false};
    const CountingIntegrator integrator([&](std::uint32_t index) {
        if (index == last) flag = true;
    });
    request.interrupted = &flag;
    return render(scene, integrator, request);
}

}  // namespace

TEST_CASE("A checkpoint beyond the budget is not begun", "[driver][memory]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene(200, 100);
    const CountingIntegrator integrator;
    const RenderResult whole = render(*scene, integrator, request_for(2));
    const std::string path = folder.file("checkpoint");
    CHECK_THROWS_AS(write_checkpoint(path, {"0123456789abcdef", 9}, whole.film, MemoryBudget(1000.0)),
                    OutOfMemory);
    CHECK(folder.size() == 0);
    CHECK_NOTHROW(write_checkpoint(path, {"0123456789abcdef", 9}, whole.film, MemoryBudget(1e9)));
}

TEST_CASE("An interrupted render drops the running pass and keeps the rest", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    const RenderResult cut = interrupted_render(*scene, request_for(30, folder.file("c")), 19);
    CHECK(cut.interrupted);
    CHECK(cut.film.pass_count() == 19);
    CHECK(cut.film.mean(0)[0] == Rgb(7.0f));  // finish() was called nonetheless
    CHECK_FALSE(cut.finished_for);
    CHECK(bits(cut) == bits(render(*scene, CountingIntegrator(), request_for(19))));
    CHECK(folder.size() == 1);
}

TEST_CASE("Interrupted and resumed gives the bits of one run", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    const auto whole = bits(render(*scene, CountingIntegrator(), request_for(50)));
    for (const std::uint32_t first : {1u, 15u, 16u, 17u, 33u}) {
        interrupted_render(*scene, request_for(50, folder.file("c")), first);
        RenderRequest again = request_for(50, folder.file("c"));
        again.resume = true;
        interrupted_render(*scene, again, first + 9);  // and once more
        const RenderResult resumed = render(*scene, CountingIntegrator(), again);
        CHECK(resumed.resumed_at == first + 9);
        CHECK(bits(resumed) == whole);
    }
    // A complete checkpoint has nothing left to do, or can be taken further.
    RenderRequest more = request_for(60, folder.file("c"));
    more.resume = true;
    CHECK(bits(render(*scene, CountingIntegrator(), more)) ==
          bits(render(*scene, CountingIntegrator(), request_for(60))));
}

TEST_CASE("Checkpoints are written on the way, and a killed render continues from the last",
          "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    RenderRequest request = request_for(40, folder.file("c"));
    request.checkpoint_every_seconds = 0.0;
    const CountingIntegrator dying([](std::uint32_t index) {
        if (index == 23) throw std::runtime_error("killed");
    });
    CHECK_THROWS_AS(render(*scene, dying, request), std::runtime_error);
    request.resume = true;
    const RenderResult resumed = render(*scene, CountingIntegrator(), request);
    CHECK(resumed.resumed_at == 23);
    CHECK(bits(resumed) == bits(render(*scene, CountingIntegrator(), request_for(40))));
}

TEST_CASE("Resuming without a checkpoint starts anew, with a warning", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    RenderRequest request = request_for(3, folder.file("c"));
    request.resume = true;
    const RenderResult result = render(*scene, CountingIntegrator(), request);
    CHECK(result.film.pass_count() == 3);
    CHECK(result.statistics.warnings.size() == 1);
}

TEST_CASE("A checkpoint of another render is refused", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    const RenderRequest good = [&] {
        RenderRequest request = request_for(8, folder.file("c"));
        render(*scene, CountingIntegrator(), request);
        request.resume = true;
        request.stop.passes = 9;
        return request;
    }();
    const auto refused = [&](const RenderRequest& request, const Integrator& integrator, const Scene& in,
                             const std::string& reason) {
        try {
            render(in, integrator, request);
        } catch (const InputError& error) {
            const std::string message = error.what();
            INFO(message);
            CHECK(message.find(folder.file("c")) == 0);
            return message.find(reason) != std::string::npos;
        }
        return false;
    };
    RenderRequest other = good;
    other.seed = 1;
    CHECK(refused(other, CountingIntegrator(), *scene, "seed"));
    other = good;
    other.content_hash = "fedcba9876543210";
    CHECK(refused(other, CountingIntegrator(), *scene, "changed"));
    CHECK(refused(good, CountingIntegrator(), *fake_scene(21, 37), "picture"));
    CHECK(refused(good, CountingIntegrator({}, "multiple"), *scene, "layers"));
    CHECK(render(*scene, CountingIntegrator(), good).resumed_at == 8);
}

TEST_CASE("Every damage to a checkpoint is refused", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene(3, 2);
    RenderRequest request = request_for(5, folder.file("c"));
    render(*scene, CountingIntegrator(), request);
    request.resume = true;
    const std::string good = read_text(folder.file("c"));
    REQUIRE(good.size() > 500);
    std::size_t tried = 0;
    for (std::size_t i = 0; i < good.size(); i += i < 200 ? 1 : 7, ++tried) {
        std::string bad = good;
        bad[i] = char(bad[i] ^ (1 << (i % 8)));
        write_text(folder.file("c"), bad);
        REQUIRE_THROWS_AS(render(*scene, CountingIntegrator(), request), InputError);
        write_text(folder.file("c"), good.substr(0, i));
        REQUIRE_THROWS_AS(render(*scene, CountingIntegrator(), request), InputError);
    }
    write_text(folder.file("c"), good + "x");
    CHECK_THROWS_AS(render(*scene, CountingIntegrator(), request), InputError);
    CHECK(tried > 250);
    write_text(folder.file("c"), good);
    CHECK(render(*scene, CountingIntegrator(), request).resumed_at == 5);
}

TEST_CASE("A checkpoint that cannot be written is a warning and another try", "[driver][checkpoint]") {
    const TemporaryFolder folder;
    const auto scene = fake_scene();
    write_text(folder.file("plain"), "file");
    const std::string path = folder.file("plain/c");
    const RenderResult result = render(*scene, CountingIntegrator(), request_for(2, path));
    CHECK(result.film.pass_count() == 2);
    REQUIRE(result.statistics.warnings.size() == 1);
    CHECK(result.statistics.warnings[0].find(path) != std::string::npos);
    // A file that is no checkpoint is refused before the first pass.
    CHECK_THROWS_AS(render(*scene, CountingIntegrator(), request_for(2, "/dev/full")), InputError);
    CHECK_THROWS_AS(render(*scene, CountingIntegrator(), request_for(2, folder.file("plain"))), InputError);
    // There is room again after the second pass.
    int failed = 0;
    RenderRequest request = request_for(4, folder.file("later/c"));
    request.checkpoint_every_seconds = 0.0;
    request.checkpoint_failed = [&](const std::string&) { ++failed; };
    const CountingIntegrator makes_room([&](std::uint32_t index) {
        if (index == 2) std::filesystem::create_directory(folder.file("later"));
    });
    CHECK(render(*scene, makes_room, request).statistics.warnings.empty());
    CHECK(failed == 2);
    RenderRequest more = request_for(4, folder.file("later/c"));
    more.resume = true;
    CHECK(render(*scene, CountingIntegrator(), more).resumed_at == 4);
}

TEST_CASE("The content hash changes with every byte of every file and every setting, not with names",
          "[driver]") {
    const TemporaryFolder folder;
    write_text(folder.file("a"), "scene");
    write_text(folder.file("b"), "grid");
    const auto hash = [&](std::vector<std::string> files, std::vector<std::string> settings) {
        for (auto& f : files) f = folder.file(f);
        return content_hash(*fake_scene(4, 4, files), settings);
    };
    const std::string h = hash({"a", "b"}, {"x=1"});
    CHECK(h.size() == 16);
    CHECK(hash({"a", "b"}, {"x=1"}) == h);
    CHECK(hash({"a", "b"}, {"x=2"}) != h);
    CHECK(hash({"a", "b"}, {"x=", "1"}) != h);
    CHECK(hash({"b", "a"}, {"x=1"}) != h);
    write_text(folder.file("renamed"), "grid");
    CHECK(hash({"a", "renamed"}, {"x=1"}) == h);
    write_text(folder.file("b"), "grie");
    CHECK(hash({"a", "b"}, {"x=1"}) != h);
    write_text(folder.file("b"), "");
    write_text(folder.file("a"), "scenegrid");
    CHECK(hash({"a", "b"}, {"x=1"}) != h);
    CHECK_THROWS_AS(hash({"missing"}, {}), InputError);
}
