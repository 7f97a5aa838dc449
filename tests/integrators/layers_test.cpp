// A picture of layers by several methods: each cell has the mean that one method gives all of them, nothing
// is counted twice or left out without a word, and the schedule is a function of scene, seed and passes.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/film/film.h"
#include "core/render/pass_runner.h"
#include "core/render/render_driver.h"
#include "integrators/layers/pass_schedule.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/environment.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

const std::vector<std::string> cells{"emission", "direct", "indirect", "single_scattering",
                                     "multiple_scattering"};

/// The box with fog that a lamp and a point light shine into.
std::unique_ptr<Scene> foggy_box() {
    std::string xml = box(grey, fog("0.5, 0.6, 0.8", ""));
    xml.insert(xml.find("<sensor"), R"(<emitter type="point"><point name="position" x="0.4" y="0.95" z="0.3"/>
        <rgb name="intensity" value="0.6, 0.8, 1"/></emitter>)");
    return scene_from(xml, 8);
}

std::shared_ptr<const Integrator> layers_of(const std::string& nested) {
    return integrator_from("<integrator type='mote_layers'>" + nested + "</integrator>");
}

std::string child(const std::string& type, const std::string& names, const std::string& inside = "") {
    return fmt::format("<integrator type='{}' name='{}'>{}</integrator>", type, names, inside);
}

void check_cell(const RenderStatistics& a, const std::string& of_a, const RenderStatistics& b,
                const std::string& cell) {
    INFO(cell);
    check_same_mean(a, of_a, b, cell);
}

}  // namespace

TEST_CASE("children that are unbiased add up to volpath, layer by layer", "[mote_layers]") {
    const auto scene = foggy_box();
    const auto whole =
        render_statistics(*scene, *integrator_from("<integrator type='volpath'/>"), {4, 4000, 1});
    const auto parts = render_statistics(
        *scene,
        *layers_of(child("volpath", "emission, direct") +
                   child("volpath", "single_scattering", "<boolean name='equiangular' value='true'/>") +
                   child("volpath", "multiple_scattering indirect")),
        {4, 4000, 2});
    REQUIRE(parts.layers.size() == cells.size() + 1);
    for (const std::string& cell : cells) check_cell(parts, cell, whole, cell);
    check_cell(parts, "beauty", whole, "beauty");
    for (const std::string cell :
         {"direct", "indirect", "single_scattering", "multiple_scattering", "beauty"}) {
        INFO(cell);  // an error of a tenth would be seen
        CHECK_FALSE(same_mean(parts.scaled(1.1), cell, whole, cell, OnFailure::nothing).passed);
    }
}

TEST_CASE("what the scene chooses adds up to volpath", "[mote_layers]") {
    // Homogeneous fog: marching is exact but for its steps, far below the noise.
    const auto scene = foggy_box();
    const auto whole =
        render_statistics(*scene, *integrator_from("<integrator type='volpath'/>"), {4, 1000, 1});
    RenderSpec spec{4, 1000, 2};
    spec.sums = {{"single_scattering", {"single_scattering_other", "single_scattering_positional"}}};
    const auto parts = render_statistics(*scene, *layers_of(""), spec);
    for (const std::string& cell : cells) check_cell(parts, cell, whole, cell);
    CHECK_FALSE(
        same_mean(parts, "single_scattering_other", whole, "single_scattering", OnFailure::nothing).passed);
}

TEST_CASE("far light by virtual lights is what mote_vpl makes of as many under their bound",
          "[mote_layers]") {
    const auto scene = foggy_box();
    const auto lights =
        render_statistics(*scene,
                          *integrator_from("<integrator type='mote_vpl'><integer name='paths' value='20000'/>"
                                           "<selection type='light_tree'/></integrator>"),
                          {4, 16, 1});
    const auto parts =
        render_statistics(*scene, *layers_of("<string name='far_light' value='lights'/>"), {4, 16, 2});
    for (const std::string cell : {"indirect_bounded", "multiple_scattering_bounded"}) {
        check_cell(parts, cell, lights, cell);
        CHECK_FALSE(same_mean(parts.scaled(1.2), cell, lights, cell, OnFailure::nothing).passed);
    }
}

TEST_CASE("paths through fog in which a lamp stands look for its light along every ray", "[mote_layers]") {
    const auto scene_with_lamp_at = [](const char* place) {
        return scene_from(fmt::format(R"(<scene version="3.0.0"><shape type="cube"><bsdf type="null"/>
            <medium type="homogeneous" name="interior"><float name="sigma_t" value="0.5"/>
            <float name="albedo" value="0.9"/></medium></shape>
            <emitter type="point"><point name="position" value="{}"/></emitter>
            <sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
            <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
                                      place),
                          8);
    };
    const auto looks_along = [](const Scene& scene) {
        const Plan plan = layers_of("")->plan(scene, find_requirements(scene));
        return std::any_of(plan.runs.begin(), plan.runs.end(), [](const PlanEntry& entry) {
            return entry.topic.find("equi-angular") != std::string::npos;
        });
    };
    const auto inside = scene_with_lamp_at("0.1, 0.1, 0");
    CHECK(looks_along(*inside));
    const auto outside = scene_with_lamp_at("0.1, 2.1, 0");
    CHECK_FALSE(looks_along(*outside));
    const auto marches = [](const Scene& scene) {
        const Plan plan = layers_of("")->plan(scene, find_requirements(scene));
        return std::ranges::any_of(plan.runs,
                                   [](const PlanEntry& entry) { return entry.choice == "mote_epipolar"; });
    };
    CHECK_FALSE(marches(*inside));
    CHECK(marches(*outside));
    const auto variance = [&](const std::string& integrator) {
        const auto r = render_statistics(*inside, *integrator_from(integrator), {4, 1000, 1});
        return r.whole[r.layer("multiple_scattering")][1].variance_of_mean;
    };
    const auto along = render_statistics(
        *inside,
        *integrator_from(
            "<integrator type='volpath'><boolean name='equiangular' value='true'/></integrator>"),
        {4, 1000, 2});
    const auto chosen = render_statistics(*inside, *layers_of(""), {4, 1000, 1});
    check_cell(chosen, "multiple_scattering", along, "multiple_scattering");
    CHECK_FALSE(
        same_mean(chosen.scaled(1.1), "multiple_scattering", along, "multiple_scattering", OnFailure::nothing)
            .passed);
    // At collisions alone it has no finite variance: more than twice in any sample of it.
    CHECK(2.0 * chosen.whole[chosen.layer("multiple_scattering")][1].variance_of_mean <
          variance("<integrator type='volpath'><boolean name='equiangular' value='false'/></integrator>"));
}

TEST_CASE("a method that is requested one cell gives it its own mean and traces fewer rays",
          "[mote_layers][long]") {
    const auto foggy = foggy_box(), dry = scene_from(box(mixed, ""), 8);
    for (const std::string& type : registry().types(Category::integrator)) {
        if (type == "mote_layers") continue;
        const bool media = type != "mote_vsl" && type != "mote_vpl_ray_bundles" &&
                           type != "mote_ray_bundles" && type != "mote_micro_rendering" && type != "path";
        const Scene& scene = media ? *foggy : *dry;
        std::string few;
        if (type == "mote_vpl" || type == "mote_vsl" || type == "mote_vpl_ray_bundles" ||
            type == "mote_ray_lights")
            few = "<integer name='paths' value='4'/>";
        if (type == "mote_epipolar")
            few = "<integer name='lines' value='16'/><integer name='steps' value='8'/>";
        if (type == "mote_single_scattering") few = "<integer name='steps' value='8'/>";
        if (type == "mote_photon_map") few = "<integer name='photon_paths' value='50'/>";
        if (type == "mote_micro_rendering")
            few = "<integer name='points' value='200'/><integer name='micro_buffer' value='4'/>";
        if (type == "mote_ray_bundles")
            few = "<integer name='directions' value='32'/><integer name='texel_budget' value='2000'/>";
        const auto integrator = integrator_from("<integrator type='" + type + "'>" + few + "</integrator>");
        const auto all = render_statistics(scene, *integrator, {8, 200, 1});
        for (const Layer& layer : integrator->layers(scene)) {
            INFO(type << ": " << layer.name);
            RenderSpec spec{8, 200, 2};
            spec.cells = layer.transport;
            const auto alone = render_statistics(scene, *integrator, spec);
            check_same_mean(alone, layer.name, all, layer.name);
        }
    }
}

TEST_CASE("what a method is not requested costs nothing", "[mote_layers]") {
    const auto scene = foggy_box();
    const auto work = [&](const std::string& xml, TransportSet wanted) {
        RenderOptions options{1, 8, 8, SamplerKind::independent};
        options.cells = wanted;
        const auto integrator = integrator_from(xml);
        const auto estimator = integrator->prepare(*scene, options);
        const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
        const std::atomic<bool> never{false};
        PassImage image(8, 8, integrator->layers(*scene).size());
        for (std::uint32_t i = 0; i < 16; ++i) estimator->pass({i, *filter, never}, image);
        Statistics s;
        estimator->add_statistics(s);
        return s.rays;
    };
    const std::string path = "<integrator type='volpath'/>", vpl = "<integrator type='mote_vpl'/>";
    // Emission needs one ray through the fog and no connection at all.
    CHECK(work(path, Transport::emission)["occlusion"] == 0);
    CHECK(work(path, Transport::emission)["closest"] == 16 * 64);
    // Connections to the first vertex alone: two samples of lights a path at most.
    const TransportSet once = TransportSet(Transport::direct) | Transport::single_scattering;
    CHECK(work(path, once)["occlusion"] <= 2 * 16 * 64);
    CHECK(work(path, once)["occlusion"] > 0);
    // And none there, if that is what is not wanted.
    const auto all = work(path, TransportSet::all()),
               more = work(path, TransportSet(Transport::indirect) | Transport::multiple_scattering);
    CHECK(all.at("occlusion") - more.at("occlusion") > 16 * 64 / 2);
    // Virtual lights are not gathered for light of the primary ones.
    CHECK(work(vpl, Transport::direct)["occlusion"] <= 16 * 64);
}

TEST_CASE("two methods for one cell are an error, and a cell without any is missing", "[mote_layers]") {
    const auto scene = foggy_box();
    const auto prepare = [&](const std::string& nested) {
        layers_of(nested)->prepare(*scene, {.seed = 1, .width = 8, .height = 8});
    };
    CHECK_THROWS_WITH(prepare(child("volpath", "") + child("path", "direct")),
                      ContainsSubstring("two methods fill 'direct': volpath and path"));
    CHECK_THROWS_WITH(prepare(child("mote_epipolar", "single_scattering_positional",
                                    "<string name='lights' value='positional'/>") +
                              child("volpath", "single_scattering")),
                      ContainsSubstring("two methods fill 'single_scattering_positional'"));
    CHECK_THROWS_WITH(prepare(child("volpath", "dierct")), ContainsSubstring("direct"));
    CHECK_THROWS_WITH(prepare(child("path", "single_scattering")), ContainsSubstring("cannot fill"));
    CHECK_THROWS_WITH(prepare("<integrator type='mote_layers'/>"),
                      ContainsSubstring("cannot fill a part of another"));

    const Plan plan =
        layers_of(child("path", "emission, indirect") + child("mote_epipolar", "single_scattering_positional",
                                                              "<string name='lights' value='positional'/>"))
            ->plan(*scene, find_requirements(*scene));
    std::set<std::string> missing;
    for (const PlanEntry& entry : plan.missing) missing.insert(entry.topic);
    CHECK(missing.contains("direct"));
    CHECK(missing.contains("single_scattering_other"));
    CHECK(missing.contains("multiple_scattering"));
    CHECK_FALSE(missing.contains("indirect"));
    CHECK(layers_of("")->plan(*scene, find_requirements(*scene)).missing.empty());
}

TEST_CASE("passes go where they take the most error for their work", "[mote_layers]") {
    // Two parts of known variance and work: n_i ~ s_i / sqrt(w_i).
    const std::vector<Layer> layers{{"a", ""}, {"b", "", false, false, "", {}, 1}};
    Film film(16, 16, layers);
    Rng rng(7);
    const double spread[2] = {0.4, 0.1}, work[2] = {100.0, 400.0}, left[2] = {1.0, 1.0};
    for (int i = 0; i < 900; ++i) {
        const std::size_t part = mote::integrators::next_part(film, left);
        PassImage image(16, 16, 1);
        for (Rgb& pixel : image.layer(0)) pixel = Rgb(float(1.0 + spread[part] * (rng.next_float() - 0.5)));
        film.add_pass(image, part, work[part]);
    }
    // 0.4 / sqrt(100) against 0.1 / sqrt(400): 8 to 1.
    CHECK(double(film.pass_count(0)) / film.pass_count(1) == Approx(8.0).epsilon(0.05));
    // A filter that leaves a 64th of the variance of part 0 turns it round: 1 to 1.
    Film filtered(16, 16, layers);
    const double share[2] = {1.0 / 64.0, 1.0};
    for (int i = 0; i < 400; ++i) {
        const std::size_t part = mote::integrators::next_part(filtered, share);
        PassImage image(16, 16, 1);
        for (Rgb& pixel : image.layer(0)) pixel = Rgb(float(1.0 + spread[part] * (rng.next_float() - 0.5)));
        filtered.add_pass(image, part, work[part]);
    }
    CHECK(double(filtered.pass_count(0)) / filtered.pass_count(1) == Approx(1.0).epsilon(0.05));
}

TEST_CASE("a render of unequal parts ends with every part, and stops where it is due", "[mote_layers]") {
    const auto scene = foggy_box();
    RenderRequest request;
    request.stop.passes = 1;
    const RenderResult one = render(*scene, *layers_of(""), request);
    CHECK(one.film.parts() == 3);
    CHECK(one.film.has_passes(1));
    CHECK(one.film.pass_count() == 3);
    request.stop.passes = 60;
    const RenderResult many = render(*scene, *layers_of(""), request);
    CHECK(many.film.pass_count() == 60);
    std::set<std::uint32_t> counts;
    for (std::size_t part = 0; part < 3; ++part) counts.insert(many.film.pass_count(part));
    CHECK(counts.size() > 1);
    CHECK(std::isfinite(many.film.noise()));
}

TEST_CASE("unequal passes resume to the same bits", "[mote_layers]") {
    const auto scene = foggy_box();
    const auto integrator = layers_of("<integer name='filter_samples' value='4'/>");
    const TemporaryFolder folder;
    std::atomic<bool> flag{false};
    RenderRequest request;
    request.stop.passes = 41, request.content_hash = "0123456789abcdef";
    const RenderResult straight = render(*scene, *integrator, request);
    request.checkpoint_path = folder.file("checkpoint");
    RenderRequest second = request;
    second.resume = true;
    request.interrupted = &flag;
    request.progress = [&](const RenderProgress& p) { flag = p.passes == 23; };
    const RenderResult interrupted = render(*scene, *integrator, request);
    REQUIRE(interrupted.interrupted);
    RenderRequest same;
    same.stop.passes = 23;
    CHECK((interrupted.film.beauty() == render(*scene, *integrator, same).film.beauty()));  // filtered, too
    const RenderResult resumed = render(*scene, *integrator, second);
    CHECK(resumed.resumed_at == 23);
    CHECK(straight.film.pass_count(0) != straight.film.pass_count(1));
    CHECK((straight.film.serialize() == resumed.film.serialize()));
    CHECK((straight.film.beauty() == resumed.film.beauty()));  // filtered
}

TEST_CASE("light that is marched to through smoke in small steps has volpath's mean, and less noise",
          "[mote_layers]") {
    const TemporaryFolder folder;
    std::string xml = box(grey, smoke_medium(folder.file("smoke.vol")));
    const auto lamp =
        xml.find("<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.25\"/>");
    REQUIRE(lamp != std::string::npos);
    xml.erase(lamp, xml.find("</shape>", lamp) + 8 - lamp);
    xml.insert(xml.find("<sensor"), R"(<emitter type="point"><point name="position" x="0.1" y="0.3" z="0.8"/>
        <rgb name="intensity" value="0.6, 0.8, 1"/></emitter>)");
    const auto scene = scene_from(xml, 8);
    const RenderSpec spec{4, 8000, 1};
    const auto tracked = render_statistics(*scene, *integrator_from("<integrator type='volpath'/>"), spec);
    const auto marched = render_statistics(
        *scene,
        *integrator_from("<integrator type='mote_single_scattering'><integer name='steps' value='1'/>"
                         "<float name='voxels' value='0.25'/></integrator>"),
        {4, 8000, 2});
    check_cell(marched, "direct", tracked, "direct");
    CHECK_FALSE(same_mean(marched.scaled(1.03), "direct", tracked, "direct", OnFailure::nothing).passed);
    const auto variance = [](const RenderStatistics& s) {
        return s.whole[s.layer("direct")][1].variance_of_mean;
    };
    CHECK(variance(marched) < 0.8 * variance(tracked));
}

TEST_CASE("the filter is the library where it is installed, our own elsewhere, and named in the plan",
          "[mote_layers]") {
    const auto scene = foggy_box();
    const auto layers = [](const std::string& filter) {
        return integrator_from(fmt::format(
            "<integrator type='mote_layers'><string name='filter' value='{}'/></integrator>", filter));
    };
    struct Render {
        std::string choice;  ///< of the plan
        std::vector<Rgb> picture, passes;
        double noise = 0.0;
    };
    const auto render_with = [&](const std::string& filter) {
        const auto integrator = layers(filter);
        Render result;
        for (const PlanEntry& e : integrator->plan(*scene, find_requirements(*scene)).runs)
            if (e.topic == "filter") result.choice = e.choice;
        RenderRequest request;
        request.stop.passes = 12;
        RenderResult rendered = render(*scene, *integrator, request);
        result.noise = rendered.statistics.values.at("noise");
        result.picture = rendered.film.beauty();
        rendered.film.exchange_replaced();
        result.passes = rendered.film.beauty();
        CHECK((filter != "none" || result.noise == rendered.film.noise()));
        return result;
    };
    const Render none = render_with("none");
    CHECK(none.choice.empty());
    CHECK(none.picture == none.passes);
    Render own, absent;
    {
        const Environment off("MOTE_OIDN", "off");
        own = render_with("own"), absent = render_with("automatic");
        CHECK_THROWS_WITH(render_with("oidn"), ContainsSubstring("MOTE_OIDN"));
    }
    CHECK(own.picture == absent.picture);
    CHECK(own.choice == absent.choice);
    CHECK(own.noise < none.noise);
    const Environment named("MOTE_OIDN", MOTE_BINARY_DIR "/stand_ins");
    const Render oidn = render_with("oidn"), automatic = render_with("automatic");
    CHECK_THAT(oidn.choice, ContainsSubstring("OpenImageDenoise 9.8.7"));
    CHECK(oidn.picture == automatic.picture);
    CHECK(oidn.picture != oidn.passes);
    CHECK(oidn.passes == none.passes);  // passes are shared out by the noise before filters
    CHECK(oidn.noise == none.noise);    // what the library leaves is not known
}

TEST_CASE("quarters of pixels have the light of the samples that fell into them", "[mote_layers][fine]") {
    const Environment off("MOTE_OIDN", "off");  // films are the same with the library and without
    struct Case {
        std::string medium, parameters;
        std::vector<std::string> fine;
    };
    const std::vector<std::string> both = {"direct", "indirect"};
    for (const Case& c : {Case{"", "", both}, Case{fog("0.5, 0.6, 0.8", ""), "", both},
                          Case{"", "<string name='far_light' value='lights'/>", {"direct"}},
                          Case{"", "<string name='filter' value='none'/>", {}},
                          Case{"", "<string name='filter' value='own'/>", {}}}) {
        CAPTURE(c.medium, c.parameters);
        const auto scene = scene_from(box(grey, c.medium), 16);
        const auto integrator = layers_of(c.parameters);
        Film film(16, 16, film_layers(*scene, *integrator, {}));
        PassRunner runner(*scene, *integrator, 5, film);
        const std::atomic<bool> never{false};
        for (int i = 0; i < 24; ++i) REQUIRE(runner.run_pass(never));
        std::vector<std::string> found;
        for (std::size_t l = 0; l < film.layers().size(); ++l) {
            if (!film.layers()[l].fine) continue;
            found.push_back(film.layers()[l].name);
            // By a box filter a pixel has no sample of its neighbours: its quarters have all of its own.
            const FineSums& sums = film.fine_sums(l);
            const std::vector<Rgb> fine = sums.mean(), mean = film.mean(l);
            const std::uint32_t passes = film.pass_count(film.layers()[l].part);
            for (std::size_t p = 0; p < mean.size(); ++p) {
                const std::size_t q = p / 16 * 2 * 32 + p % 16 * 2;
                Vec3d light(0.0);
                double samples = 0.0;
                for (const std::size_t i : {q, q + 1, q + 32, q + 33})
                    light += double(sums.counts()[i]) * Vec3d(fine[i]), samples += double(sums.counts()[i]);
                REQUIRE(samples == double(passes));
                REQUIRE(glm::length(Rgb(light / samples) - mean[p]) <= 1e-5f * glm::length(mean[p]));
            }
        }
        CHECK(found == c.fine);
    }
}
