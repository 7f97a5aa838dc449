// The render call itself: ranges, earlier passes, resume, cancellation, time, observers that throw, two
// renders at once, and files that are not its own.
#include "session/render.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/objects/error.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using mote::tests::TemporaryFolder;
using session::LoadedScene, session::Rendered, session::RenderSettings;

namespace {

LoadedScene scene_of(const std::string& integrator, int size = 16, bool interval = false) {
    const std::string edge = std::to_string(size);
    return LoadedScene::from_text(R"(<scene version="3.0.0"><integrator type=")" + integrator + R"("/>
        <sensor type="perspective"><film type="hdrfilm"><integer name="width" value=")" +
                                      edge + R"("/>
        <integer name="height" value=")" +
                                      edge + R"("/><boolean name="interval" value=")" +
                                      (interval ? "true" : "false") + R"("/></film><transform name="to_world">
        <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
        <shape type="sphere"><bsdf type="diffuse"/></shape><emitter type="constant"/></scene>)",
                                  "");
}

RenderSettings passes(std::uint32_t count) {
    RenderSettings settings;
    settings.stop.passes = count, settings.threads = 2;
    return settings;
}

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Cancels as soon as there are so many passes.
struct Cancelling : session::RenderObserver {
    explicit Cancelling(std::uint32_t count) : count_(count) {}
    void progress(const core::RenderProgress& p) override { now_ = p.passes; }
    bool cancelled() override { return now_ >= count_; }

  private:
    std::uint32_t count_, now_ = 0;
};

}  // namespace

TEST_CASE("Ranges of passes add up to the bits of one render", "[session][range]") {
    const LoadedScene scene = scene_of("path");
    const Rendered whole = session::render(scene, passes(6));
    RenderSettings settings;
    settings.range = core::PassRange{0, 4};
    Rendered first = session::render(scene, settings);
    REQUIRE(first.film);
    CHECK(first.image.names.empty());
    CHECK(first.film->pass_count() == 4);
    settings = passes(6);
    settings.begin_with = {std::make_shared<core::Film>(std::move(*first.film)), first.counts,
                           session::render_hash(scene, settings)};
    const Rendered both = session::render(scene, settings);
    CHECK(both.passes == 6);
    CHECK(both.image.channels == whole.image.channels);
    // The rays of both are counted.
    CHECK(both.counts.rays.at("closest") == whole.counts.rays.at("closest"));
    SECTION("Earlier passes of another render are refused") {
        settings.begin_with->scene_hash = "another";
        CHECK_THROWS_AS(session::render(scene, settings), core::InputError);
    }
}

TEST_CASE("A render that was cancelled continues to the same bits", "[session][resume]") {
    const TemporaryFolder folder;
    const LoadedScene scene = scene_of("path", 64);
    RenderSettings settings = passes(1u << 20);
    settings.checkpoint = folder.file("film.checkpoint");
    Cancelling observer(3);
    const Rendered part = session::render(scene, settings, observer);
    CHECK(part.interrupted);
    REQUIRE(part.passes >= 3);
    REQUIRE(std::filesystem::exists(settings.checkpoint));
    settings.stop.passes = part.passes + 2, settings.resume = true;
    const Rendered resumed = session::render(scene, settings);
    CHECK_FALSE(resumed.interrupted);
    CHECK(resumed.image.channels == session::render(scene, passes(part.passes + 2)).image.channels);
    CHECK_FALSE(std::filesystem::exists(settings.checkpoint));
}

TEST_CASE("A checkpoint replaces and removes nothing but its own", "[session][own]") {
    const TemporaryFolder folder;
    const LoadedScene scene = scene_of("path");
    RenderSettings settings = passes(1);
    settings.checkpoint = folder.file("precious");
    SECTION("a text") {
        std::ofstream(settings.checkpoint) << "a diary";
        CHECK_THROWS_WITH(session::render(scene, settings), ContainsSubstring("precious"));
        CHECK(text_of(settings.checkpoint) == "a diary");
    }
    SECTION("an empty file") {
        std::ofstream(settings.checkpoint).close();
        CHECK_THROWS_AS(session::render(scene, settings), core::InputError);
        CHECK(std::filesystem::exists(settings.checkpoint));
    }
    SECTION("an empty folder") {
        std::filesystem::create_directory(settings.checkpoint);
        CHECK_THROWS_AS(session::render(scene, settings), core::InputError);
        CHECK(std::filesystem::is_directory(settings.checkpoint));
    }
    SECTION("a checkpoint of another scene") {
        RenderSettings of_another = settings;
        of_another.keep_checkpoint = true;
        session::render(scene_of("path", 8), of_another);
        const std::string before = text_of(settings.checkpoint);
        REQUIRE_FALSE(before.empty());
        CHECK_THROWS_WITH(session::render(scene, settings), ContainsSubstring("another render"));
        CHECK(text_of(settings.checkpoint) == before);
    }
    SECTION("one of its own, of another seed") {
        settings.keep_checkpoint = true;
        session::render(scene, settings);
        settings.keep_checkpoint = false, settings.seed = 7;
        session::render(scene, settings);
        CHECK_FALSE(std::filesystem::exists(settings.checkpoint));
    }
    SECTION("what is put there while it renders") {
        struct Swap : session::RenderObserver {
            std::string path;
            void building_is_over() override { std::ofstream(path) << "put here later"; }
        } observer;
        observer.path = settings.checkpoint;
        session::render(scene, settings, observer);
        CHECK(text_of(settings.checkpoint) == "put here later");
    }
}

TEST_CASE("The limit in time holds, and what exceeds it is said", "[session][time]") {
    const LoadedScene scene = scene_of("path", 64);
    RenderSettings settings;
    settings.stop.seconds = 0.5;
    const auto start = std::chrono::steady_clock::now();
    const Rendered rendered = session::render(scene, settings);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(15));
    CHECK_FALSE(rendered.interrupted);
    CHECK(rendered.passes >= 1);
    // Ten seconds were spent before the call: there is time for no more than what a limit always grants.
    settings.stop.seconds = 5.0, settings.seconds_before = 10.0;
    const Rendered late = session::render(scene, settings);
    CHECK(late.passes < rendered.passes + 2);
    REQUIRE_FALSE(late.warnings.empty());
    CHECK_THAT(late.warnings.back(), ContainsSubstring("limit of 5 s"));
    settings.seconds_before = 0.0, settings.seconds_after = 10.0;
    CHECK(session::render(scene, settings).passes < rendered.passes + 2);
}

TEST_CASE("What an observer throws ends the render and leaves it", "[session][observer]") {
    struct Thrown {};
    struct Throwing : session::RenderObserver {
        int what = 0;
        void progress(const core::RenderProgress&) override {
            if (what == 0) throw Thrown();
        }
        bool cancelled() override {
            if (what == 1) throw Thrown();
            return false;
        }
        bool wants_previews() const override { return true; }
        void preview(const core::ImageChannels&) override {
            if (what == 2) throw Thrown();
        }
        void building_is_over() override {
            if (what == 3) throw Thrown();
        }
    };
    const LoadedScene scene = scene_of("path", 64);
    for (int what = 0; what < 4; ++what) {
        Throwing observer;
        observer.what = what;
        CHECK_THROWS_AS(session::render(scene, passes(1u << 20), observer), Thrown);
    }
}

TEST_CASE("Two renders at once have the bits that each has alone", "[session][threads]") {
    const LoadedScene scene = scene_of("mote_vpl", 32);
    const Rendered alone = session::render(scene, passes(3));
    Rendered at_once[2];
    std::thread other([&] { at_once[1] = session::render(scene, passes(3)); });
    at_once[0] = session::render(scene, passes(3));
    other.join();
    for (const Rendered& r : at_once) CHECK(r.image.channels == alone.image.channels);
}

TEST_CASE("A noise that passes cannot show is unknown, and ends no render", "[session][noise]") {
    const auto fog = [](const std::string& integrator, const std::string& g) {
        return LoadedScene::from_text(R"(<scene version="3.0.0"><integrator type=")" + integrator + R"("/>
            <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/>
            <integer name="height" value="8"/></film><transform name="to_world">
            <lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
            <shape type="sphere"><bsdf type="null"/><medium type="homogeneous" name="interior">
            <rgb name="sigma_t" value="1"/><phase type="hg"><float name="g" value=")" +
                                          g + R"("/></phase></medium></shape>
            <emitter type="point"><point name="position" x="0.2" y="0.3" z="0.1"/></emitter></scene>)",
                                      "");
    };
    for (const char* connecting :
         {"mote_vpl", "mote_ray_lights", "mote_photon_map", "mote_single_scattering"})
        for (const char* g : {"0.999", "-0.999"}) {
            INFO(connecting << ", g " << g);
            CHECK_FALSE(std::isfinite(session::render(fog(connecting, g), passes(8)).noise));
        }
    CHECK(std::isfinite(session::render(fog("mote_vpl", "0.5"), passes(8)).noise));
    CHECK(std::isfinite(session::render(fog("volpath", "0.999"), passes(8)).noise));
    RenderSettings until;
    until.stop.noise = 0.05;
    CHECK_THROWS_WITH(session::render(fog("mote_vpl", "0.999"), until),
                      ContainsSubstring("number of passes"));
    // One pixel of sixteen passes, which mote_layers shares out among its methods.
    for (const char* integrator : {"path", "mote_layers"}) {
        CHECK_FALSE(std::isfinite(session::render(scene_of(integrator, 1), passes(16)).noise));
        CHECK(std::isfinite(session::render(scene_of(integrator, 16), passes(16)).noise));
    }
}

TEST_CASE("A noise that no passes have shown is unknown, not zero", "[session][noise]") {
    const LoadedScene scene = scene_of("path");
    CHECK(std::isinf(session::render(scene, passes(1)).noise));
    CHECK(nlohmann::json::parse(session::render(scene, passes(1)).statistics)["noise"].is_null());
    Cancelling at_once(0);
    const Rendered nothing = session::render(scene_of("path", 256), passes(1u << 20), at_once);
    CHECK(nothing.interrupted);
    if (nothing.passes < 2) CHECK(std::isinf(nothing.noise));
    CHECK(std::isinf(Rendered().noise));
}

TEST_CASE("An interval of the error is stated where it was requested and is known", "[session][halves]") {
    const auto unknown = [](const Rendered& rendered) {
        const auto said = nlohmann::json::parse(rendered.statistics)["error"];
        return said.contains("unknown") ? said["unknown"].get<std::string>() : "";
    };
    const Rendered without = session::render(scene_of("path"), passes(16));
    CHECK(!without.error);
    CHECK(unknown(without) == "film.interval is not set");
    CHECK(!without.image.metadata.contains("errorInterval"));

    const LoadedScene scene = scene_of("path", 32, true);
    const Rendered with = session::render(scene, passes(16));
    REQUIRE(with.error);
    CHECK(unknown(with).empty());
    CHECK(with.error->low < with.error->error);
    CHECK(with.error->error < with.error->high);
    CHECK(with.image.metadata.contains("errorInterval"));
    RenderSettings one_thread = passes(16);
    one_thread.threads = 1;
    CHECK(session::render(scene, one_thread).image.channels == with.image.channels);

    CHECK(unknown(session::render(scene, passes(3))) == "too few passes");
    const Rendered of_groups = session::render(scene_of("mote_vpl", 16, true), passes(16));
    REQUIRE(of_groups.error);
    CHECK(of_groups.error->low < of_groups.error->high);
    const Rendered of_other_method = session::render(scene_of("mote_photon_map", 16, true), passes(16));
    CHECK(!of_other_method.error);
    CHECK(!unknown(of_other_method).empty());
}

TEST_CASE("A limit on the error ends where the interval is below it, with or without previews",
          "[session][halves]") {
    const LoadedScene scene = scene_of("path", 32, true);
    RenderSettings settings;
    settings.threads = 2, settings.stop.error = 0.02;
    const Rendered rendered = session::render(scene, settings);
    REQUIRE(rendered.error);
    CHECK(rendered.error->rule_high <= 0.02);
    CHECK(rendered.passes >= 8);
    struct Watching : session::RenderObserver {
        bool wants_previews() const override { return true; }
        double preview_every_seconds() const override { return 0.0; }
        double preview_share() const override { return 1.0; }
    } watching;
    CHECK(session::render(scene, settings, watching).passes == rendered.passes);
    CHECK_THROWS_AS(session::render(scene_of("path"), settings), core::InputError);
    CHECK_THROWS_AS(session::render(scene_of("mote_photon_map", 16, true), settings), core::InputError);
}

TEST_CASE("A render with halves or groups continues to the same bits", "[session][resume][halves]") {
    const TemporaryFolder folder;
    const std::string integrator = GENERATE("mote_layers", "mote_vpl");
    const LoadedScene scene = scene_of(integrator, 32, true);
    const Rendered whole = session::render(scene, passes(13));
    RenderSettings settings = passes(6);
    settings.checkpoint = folder.file("film.checkpoint"), settings.keep_checkpoint = true;
    session::render(scene, settings);
    settings.stop.passes = 13, settings.resume = true;
    const Rendered resumed = session::render(scene, settings);
    CHECK(resumed.image.channels == whole.image.channels);
    REQUIRE(resumed.error);
    CHECK(resumed.error->high == whole.error->high);
}

TEST_CASE("A limit on the error has control passes, which continue as they would have gone on",
          "[session][resume][halves][controls]") {
    const TemporaryFolder folder;
    const LoadedScene scene = scene_of("mote_layers", 32, true);
    RenderSettings settings = passes(13);
    settings.stop.error = 1e-9;  // never met
    const Rendered whole = session::render(scene, settings), without = session::render(scene, passes(13));
    CHECK(whole.image.channels == without.image.channels);  // they are not part of the picture
    REQUIRE((whole.error && without.error));
    CHECK(whole.error->high != without.error->high);  // but of its error
    RenderSettings one_thread = settings;
    one_thread.threads = 1;
    CHECK(session::render(scene, one_thread).error->high == whole.error->high);

    // Before there are any, and when there are: they begin after eight passes.
    const std::uint32_t before = GENERATE(6u, 11u);
    settings.stop.passes = before, settings.checkpoint = folder.file("film.checkpoint");
    settings.keep_checkpoint = true;
    session::render(scene, settings);
    settings.stop.passes = 13, settings.resume = true;
    const Rendered resumed = session::render(scene, settings);
    CHECK(resumed.image.channels == whole.image.channels);
    CHECK(resumed.error->high == whole.error->high);
    // A limit that is set later has control passes from there on; one that is taken back has none.
    const bool first = GENERATE(false, true);
    RenderSettings half = passes(first ? 11 : 6);
    half.checkpoint = folder.file("half.checkpoint"), half.keep_checkpoint = true;
    if (first) half.stop.error = 1e-9;
    session::render(scene, half);
    half.stop.passes = 13, half.resume = true;
    half.stop.error = first ? std::nullopt : std::optional(1e-9);
    const Rendered changed = session::render(scene, half);
    CHECK(changed.image.channels == whole.image.channels);
    REQUIRE(changed.error);
    CHECK((changed.error->high == without.error->high) == first);
}
