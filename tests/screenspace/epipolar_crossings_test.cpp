// Samples where epipolar lines of two lights cross: where they are, what they are worth, and that lines stay
// covered.
#include "screenspace/epipolar/epipolar_crossings.h"

#include <set>

#include "core/math/random.h"
#include "screenspace/in_scattering/eye_media.h"
#include "tests/screenspace/epipolar_scenes.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

constexpr int width = 96, height = 64;
const FilmRectangle frame{{0.0, 0.0}, {width, height}};
const std::vector<FilmPoint> lamps{{20.0, 25.0, 1.0}, {150.0, 10.0, 1.0}, {40.0, 90.0, 1.0}};

/// Shafts around each lamp, in front of a wall with a disc before it.
RayEnd end_at(const Vec2d& film) {
    RayEnd end;
    end.distance = glm::length(film - Vec2d(60.0, 36.0)) < 12.0 ? 1.0f : 4.0f, end.surface = true;
    end.normal = Vec3(0, 0, -1), end.position = Vec3(float(film.x), float(film.y), end.distance);
    return end;
}
Ray ray_at(const Vec2d& film) { return {Vec3(float(film.x), float(film.y), 0.0f), Vec3(0, 0, 1)}; }
Rgb light_at(std::size_t lamp, const Vec2d& film, const RayEnd& end) {
    const Vec2d v = film - Vec2d(lamps[lamp].x, lamps[lamp].y);
    const double r = glm::length(v), near = r * r / (r * r + 25.0);
    const double shafts = 1.5 + near * std::sin(double(8 + lamp) * std::atan2(v.y, v.x));
    return Rgb(float(double(end.distance) * double(lamp + 1) * shafts * std::exp(-r / 60.0)));
}

struct Shafts final : InScatteringSource {
    std::size_t lamp = 0;
    explicit Shafts(std::size_t l) : lamp(l) {}
    struct Task final : InScatteringTask {
        std::size_t lamp;
        explicit Task(std::size_t l) : lamp(l) {}
        Ray ray(const Vec2d& film) override { return ray_at(film); }
        RayEnd end_of(const Vec2d& film) override { return end_at(film); }
        MarchedRay march(const Vec2d& film, const RayEnd& end) override {
            return {light_at(lamp, film, end), Rgb(1.0f)};
        }
    };
    std::unique_ptr<InScatteringTask> start() const override { return std::make_unique<Task>(lamp); }
};

enum class Fault { none, lights_swapped, wrong_ends };

struct SharedShafts final : SharedRaySource {
    Fault fault = Fault::none;
    explicit SharedShafts(Fault f = Fault::none) : fault(f) {}
    struct Task final : SharedRayTask {
        Fault fault;
        explicit Task(Fault f) : fault(f) {}
        Ray ray(const Vec2d& film) override { return ray_at(film); }
        std::array<RayEnd, 2> ends_of(const Crossing& c) override {
            RayEnd end = end_at(c.film);
            if (fault == Fault::wrong_ends) end.distance *= 2.0f, end.position.z *= 2.0f;
            return {end, end};
        }
        std::array<MarchedRay, 2> march(const Crossing& c, const std::array<RayEnd, 2>& ends) override {
            std::array<MarchedRay, 2> marched;
            for (std::size_t i = 0; i < 2; ++i) {
                const std::size_t lamp = c.sides[fault == Fault::lights_swapped ? 1 - i : i].light;
                marched[i] = {light_at(lamp, c.film, ends[i]), Rgb(1.0f)};
            }
            return marched;
        }
    };
    std::unique_ptr<SharedRayTask> start() const override { return std::make_unique<Task>(fault); }
};

const EpipolarPicture::Loop in_turn = [](int count, const std::function<void(int)>& body) {
    for (int i = 0; i < count; ++i) body(i);
};

/// The lines of several lamps, found and not marched.
struct Pictures {
    std::vector<EpipolarPicture> all;
    std::vector<EpipolarPicture*> each;
    Pictures(const std::vector<FilmPoint>& at, int lines, const LineSampling& sampling) {
        all.reserve(at.size());
        for (std::size_t i = 0; i < at.size(); ++i)
            all.emplace_back(EpipolarLines(at[i], frame, lines, 0.37), sampling, Shafts(i), in_turn),
                each.push_back(&all.back());
    }
};

struct Outcome {
    double rms = 0.0;
    std::size_t shared = 0;
    std::uint64_t marched = 0;
};

/// Error of the sum over all lamps, with crossings or without.
Outcome outcome(int lines, const LineSampling& sampling, const SharedShafts* shared) {
    Pictures pictures(lamps, lines, sampling);
    Outcome outcome;
    if (shared) outcome.shared = march_crossings(pictures.each, *shared, in_turn);
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        const Shafts source(i);
        pictures.all[i].march(source, in_turn);
        outcome.marched += pictures.all[i].counts().marched;
        const auto task = source.start();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const Vec2d film(x + 0.5, y + 0.5);
                const RayEnd end = end_at(film);
                const auto found = pictures.all[i].light_at(film, end, *task);
                const double d = found ? double(found->x - light_at(i, film, end).x) : 0.0;
                outcome.rms += d * d / (width * height);
            }
    }
    outcome.rms = std::sqrt(outcome.rms);
    return outcome;
}

}  // namespace

TEST_CASE("Lines meet where a walk along one crosses the other", "[epipolar]") {
    Rng rng(5);
    const auto point = [&] {
        return Vec2d(90.0 * double(rng.next_float()), 60.0 * double(rng.next_float()));
    };
    int met = 0;
    for (int i = 0; i < 300; ++i) {
        const EpipolarLine a{point(), point()}, b{point(), point()};
        const Vec2d along = b.end - b.start, across(-along.y, along.x);
        std::optional<double> brute;
        constexpr int steps = 20000;
        for (int k = 0; k < steps; ++k) {
            const Vec2d p = a.at(double(k) / steps), q = a.at(double(k + 1) / steps);
            if ((glm::dot(p - b.start, across) < 0.0) == (glm::dot(q - b.start, across) < 0.0)) continue;
            const double share = glm::dot(0.5 * (p + q) - b.start, along) / glm::dot(along, along);
            if (share >= 0.0 && share <= 1.0) brute = (k + 0.5) / steps;
        }
        const auto meeting = meet(a, b);
        INFO("pair " << i);
        REQUIRE(meeting.has_value() == brute.has_value());
        if (!brute) continue;
        ++met;
        CHECK(std::abs(meeting->a - *brute) < 1.0 / steps);
        CHECK(glm::length(a.at(meeting->a) - b.at(meeting->b)) < 1e-9);
    }
    CHECK(met > 30);
    const EpipolarLine a{{1, 1}, {9, 5}};
    CHECK_FALSE(meet(a, a));                 // the same
    CHECK_FALSE(meet(a, {{1, 2}, {9, 6}}));  // parallel
    CHECK_FALSE(meet(a, {{3, 3}, {3, 3}}));  // a point
}

TEST_CASE("Chosen crossings lie on both lines, near the places they stand for", "[epipolar]") {
    Pictures pictures(lamps, 80, {.initial = 8, .shift = 0.3});
    const auto crossings = choose_crossings(pictures.each);
    std::set<std::array<std::size_t, 3>> taken;
    std::array<std::size_t, 3> by_light{};
    for (const Crossing& c : crossings) {
        CHECK(c.sides[0].light != c.sides[1].light);
        for (const Crossing::Side& side : c.sides) {
            const SampledLine& line = pictures.all[side.light].sampled()[side.line];
            CHECK(glm::length(line.film(side.texel) - c.film) < 1e-9);
            CHECK(line.lit(side.texel));
            const int place = line.spread().nearest(side.texel);
            CHECK(std::abs(side.texel - line.spread().place(place)) <= 0.5 * line.spread().spacing + 1e-9);
            CHECK(taken.insert({side.light, side.line, std::size_t(place)}).second);  // each place once
            ++by_light[side.light];
        }
    }
    std::size_t places = 0;
    for (const EpipolarPicture& picture : pictures.all)
        for (const SampledLine& line : picture.sampled()) places += std::size_t(line.spread().count);
    INFO(crossings.size() << " crossings for " << places << " places");
    CHECK(2 * crossings.size() > places / 3);  // the greedy choice is worth its name
    for (const std::size_t n : by_light) CHECK(n > 0);
}

TEST_CASE("With crossings no gap of a line exceeds twice the spacing", "[epipolar]") {
    const LineSampling sampling{.initial = 10, .shift = 0.6};
    Pictures pictures(lamps, 70, sampling);
    REQUIRE(march_crossings(pictures.each, SharedShafts(), in_turn) > 100);
    double widest = 0.0;
    const auto check_gaps = [&](const SampledLine& line) {
        const auto& samples = line.samples();
        for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
            CHECK(samples[i].texel <= samples[i + 1].texel);
            const double gap = double(samples[i + 1].texel - samples[i].texel);
            widest = std::max(widest, (gap - 1.0) / line.spread().spacing);
        }
        return samples.size();
    };
    for (std::size_t l = 0; l < lamps.size(); ++l) {
        const auto task = Shafts(l).start();
        const Pictures plain({lamps[l]}, 70, sampling);
        for (std::size_t i = 0; i < pictures.all[l].sampled().size(); ++i) {
            SampledLine& line = pictures.all[l].line(i);
            line.march(sampling, *task);
            const std::size_t with = check_gaps(line);
            const std::size_t wanted = std::size_t(line.spread().count);
            CHECK(with >= wanted);          // one for every place, and the ends of runs
            CHECK(with <= wanted + 2 * 6);  // the wall, the disc, the wall
        }
    }
    INFO("widest gap, in spacings: " << widest);
    CHECK(widest <= 2.0);
    CHECK(widest > 1.0);  // some did move
}

TEST_CASE("Pictures with crossings converge like those without", "[epipolar]") {
    const SharedShafts shared;
    double previous = 1.0;
    for (const int rate : {1, 3, 9}) {
        const LineSampling sampling{.initial = 10 * rate, .tolerance = 0.0f, .texels = double(rate)};
        const Outcome with = outcome(60 * rate, sampling, &shared),
                      without = outcome(60 * rate, sampling, nullptr);
        INFO("rate " << rate << ": " << with.rms << " with " << with.shared << " crossings, " << without.rms);
        CHECK(with.shared > 100);
        CHECK(with.rms < 1.3 * without.rms);
        CHECK(with.rms < 0.5 * previous);
        CHECK(double(with.marched) < 1.05 * double(without.marched));
        previous = with.rms;
    }
    CHECK(previous < 0.03);
}

TEST_CASE("Wrong light and wrong ends at crossings are seen", "[epipolar]") {
    const LineSampling sampling{.initial = 10};
    const SharedShafts right, swapped(Fault::lights_swapped), wrong(Fault::wrong_ends);
    const Outcome good = outcome(120, sampling, &right);
    CHECK(outcome(120, sampling, &swapped).rms > 5.0 * good.rms);
    // Rays that end elsewhere than the lines around them are turned down, all of them.
    const Outcome none = outcome(120, sampling, &wrong), plain = outcome(120, sampling, nullptr);
    CHECK(none.shared == 0);
    CHECK(none.rms == plain.rms);
    CHECK(none.marched == plain.marched);
}

TEST_CASE("Crossings of lights in one place, at infinity, and of capped lines", "[epipolar]") {
    const LineSampling sampling{.initial = 10};
    // All lines of two lights in one place meet there alone, where no line goes.
    Pictures same({lamps[0], lamps[0]}, 60, sampling);
    CHECK(choose_crossings(same.each).empty());
    // Parallel lines of both: every pair of lines is parallel, or crosses when directions differ.
    Pictures parallel({{1.0, 0.4, 0.0}, {1.0, 0.4, 0.0}}, 60, sampling);
    CHECK(choose_crossings(parallel.each).empty());
    Pictures crossed({{1.0, 0.4, 0.0}, {-0.3, 1.0, 0.0}}, 60, sampling);
    CHECK(choose_crossings(crossed.each).size() > 50);
    // One light alone, and more crossings than samples.
    Pictures alone({lamps[0]}, 60, sampling);
    CHECK(choose_crossings(alone.each).empty());
    Pictures many({lamps[0], lamps[1]}, 3000, {.initial = 2});
    for (const Crossing& c : choose_crossings(many.each)) CHECK(glm::length(c.film) < 200.0);
    // The cap holds.
    Pictures capped(lamps, 60, {.initial = 30, .cap = 5});
    CHECK(march_crossings(capped.each, SharedShafts(), in_turn) == 0);
}

TEST_CASE("Media along a shared eye ray are those of one light's own", "[epipolar]") {
    const TemporaryFolder folder;
    const auto scene = scene_from(box(grey, smoke_medium(folder.file("smoke.vol"))), 8);
    WalkContext walk;
    double worst = 0.0, worst_coarse = 0.0, darkest = 1.0;
    for (int i = 0; i < 64; ++i) {
        Ray ray = scene->camera().sample_ray(Vec2(float(i % 8) + 0.5f, float(i / 8) + 0.5f), Vec2(0.5f));
        const auto hit = scene->rays().closest(ray);
        if (hit) ray.t_max = hit->t;
        if (!std::isfinite(ray.t_max)) continue;
        const MediumState& state = scene->camera_medium_state();
        const EyeMedia media(*scene, ray, state, 0.1f, walk), coarse(*scene, ray, state, 100.0f, walk);
        for (const float share : {0.0f, 0.31f, 0.62f, 1.0f}) {
            Ray part = ray;
            part.t_max = share * ray.t_max;
            std::vector<MediumSegment> own, shared;
            find_segments(*scene, part, state, own, walk);
            media.segments_up_to(part.t_max, shared);
            REQUIRE(own.size() == shared.size());
            for (std::size_t k = 0; k < own.size(); ++k) {
                CHECK(own[k].medium == shared[k].medium);
                CHECK(own[k].t0 == shared[k].t0);
                CHECK(own[k].t1 == shared[k].t1);
            }
            const Rgb truth = marched_transmittance(part, own, 0.02f, walk);
            worst = std::max(worst,
                             double(max_component(glm::abs(media.transmittance(part.t_max, walk) - truth))));
            worst_coarse =
                std::max(worst_coarse,
                         double(max_component(glm::abs(coarse.transmittance(part.t_max, walk) - truth))));
            darkest = std::min(darkest, double(truth.x));
        }
    }
    INFO("worst " << worst << ", darkest " << darkest);
    CHECK(worst < 2e-3);
    CHECK(worst_coarse > 0.05);  // one lookup for all of the grid
    CHECK(darkest < 0.5);
}

TEST_CASE("mote_epipolar with crossings renders several lights alike", "[epipolar]") {
    const std::string more = R"(
        <emitter type="point"><point name="position" x="-2.5" y="0.9" z="0.3"/><rgb name="intensity" value="0.5, 1, 2"/>
        </emitter><emitter type="point"><point name="position" x="0" y="0" z="4"/><rgb name="intensity" value="0.1"/>
        </emitter>)";  // the last one at the eye, where no light has lines
    const std::string crossings = R"(<boolean name="crossings" value="true"/>)";
    const auto scene = sized(block_in_fog({2.5, 0.5, 0.0}, more), 60, 40);
    const Picture reference = render(*scene, full), off = render(*scene, epipolar(100, 8)),
                  on = render(*scene, epipolar(100, 8, crossings));
    const double error = relative_error(on, reference), plain = relative_error(off, reference);
    INFO(error << " with " << on.statistics.values.at("shared_rays") << " shared rays, without " << plain);
    CHECK(on.statistics.values.at("shared_rays") > 50.0);
    CHECK(error < 1.2 * plain + 0.002);
    CHECK(on.statistics.rays.at("closest") < off.statistics.rays.at("closest"));

    const auto one = sized(block_in_fog({2.5, 0.5, 0.0}), 24, 16);
    CHECK(relative_error(render(*one, epipolar(60, 8, crossings)), render(*one, epipolar(60, 8))) == 0.0);
    for (const auto& [w, h] : std::vector<std::pair<int, int>>{{1, 1}, {300, 1}}) {
        const auto thin = sized(block_in_fog({2.5, 0.5, 0.0}, more), w, h);
        CHECK(relative_error(render(*thin, epipolar(60, 8, crossings)), render(*thin, full)) <
              usual_tolerance);
    }
}

TEST_CASE("Crossings in a grid keep to the picture at full rate", "[epipolar]") {
    const TemporaryFolder folder;
    std::string xml = box(grey, smoke_medium(folder.file("smoke.vol")));
    xml.insert(xml.find("<sensor"), R"(
        <emitter type="point"><point name="position" x="0.6" y="0.4" z="1.5"/></emitter>
        <emitter type="point"><point name="position" x="-0.7" y="-0.3" z="1.2"/></emitter>)");
    const auto scene = sized(xml, 32, 24);
    const std::string steps = R"(<integer name="steps" value="16"/>)";
    const auto picture = [&](const std::string& crossings) {
        return render(*scene, epipolar(80, 10, steps + R"(<float name="tolerance" value="0"/>)" + crossings));
    };
    const Picture reference =
        render(*scene, R"(<integrator type="mote_single_scattering">)" + steps + "</integrator>");
    const Picture on = picture(R"(<boolean name="crossings" value="true"/>)"), off = picture("");
    const double error = relative_error(on, reference), plain = relative_error(off, reference);
    INFO(error << " with " << on.statistics.values.at("shared_rays") << " shared rays, without " << plain);
    CHECK(on.statistics.values.at("shared_rays") > 50.0);
    CHECK(error < 1.3 * plain);
    CHECK(relative_error(on, off) > 0.0);
}
