// Sampling and interpolation along epipolar lines, of light that is a function of the film.
#include "screenspace/epipolar/epipolar_picture.h"

#include "core/math/random.h"
#include "screenspace/epipolar/in_scattering_grid.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;

namespace {

constexpr int width = 96, height = 64;
const FilmRectangle frame{{0.0, 0.0}, {width, height}};
const FilmPoint light{20.0, 25.0, 1.0};

/// Shafts around the light, that fade along their way; and a disc in front of a wall, where the way is
/// shorter.
class Shafts final : public InScatteringSource {
  public:
    float disc_distance = 1.0f;
    double radius = 12.0;

    RayEnd end_of(const Vec2d& film) const {
        RayEnd end;
        const bool on_disc = glm::length(film - Vec2d(60.0, 36.0)) < radius;
        end.distance = on_disc ? disc_distance : 4.0f, end.surface = true;
        end.normal = Vec3(0, 0, -1), end.position = ray(film).at(end.distance);
        return end;
    }
    static Ray ray(const Vec2d& film) { return {Vec3(float(film.x), float(film.y), 0.0f), Vec3(0, 0, 1)}; }
    static Rgb light_of(const Vec2d& film, const RayEnd& end) {
        const Vec2d v = film - Vec2d(light.x, light.y);
        const double r = glm::length(v), near = r * r / (r * r + 25.0);  // at the light all shafts meet
        const double shafts = 1.5 + near * std::sin(8.0 * std::atan2(v.y, v.x));
        return Rgb(float(double(end.distance) * shafts * std::exp(-r / 60.0)));
    }
    std::unique_ptr<InScatteringTask> start() const override;
};

class ShaftsTask final : public InScatteringTask {
  public:
    explicit ShaftsTask(const Shafts& source) : source_(source) {}
    Ray ray(const Vec2d& film) override { return Shafts::ray(film); }
    RayEnd end_of(const Vec2d& film) override { return source_.end_of(film); }
    MarchedRay march(const Vec2d& film, const RayEnd& end) override {
        return {Shafts::light_of(film, end), Rgb(1.0f)};
    }

  private:
    const Shafts& source_;
};

/// A disc of a medium that is a thousand times as bright as what is around it, which no depth shows.
class BrightDisc final : public InScatteringSource, public InScatteringTask {
  public:
    static constexpr double radius = 6.0;
    static double distance(const Vec2d& film) { return glm::length(film - Vec2d(60.3, 36.7)); }
    static Rgb light_of(const Vec2d& film) { return Rgb(distance(film) < radius ? 1000.0f : 1.0f); }
    std::unique_ptr<InScatteringTask> start() const override { return std::make_unique<BrightDisc>(); }
    Ray ray(const Vec2d& film) override { return Shafts::ray(film); }
    RayEnd end_of(const Vec2d&) override { return {.distance = 4.0f}; }
    MarchedRay march(const Vec2d& film, const RayEnd&) override { return {light_of(film), Rgb(1.0f)}; }
};

std::unique_ptr<InScatteringTask> Shafts::start() const { return std::make_unique<ShaftsTask>(*this); }

const EpipolarPicture::Loop in_turn = [](int count, const std::function<void(int)>& body) {
    for (int i = 0; i < count; ++i) body(i);
};

struct Error {
    double rms = 0.0, worst = 0.0, disc_worst = 0.0;
    std::uint64_t marched = 0, filled = 0;
};

template <typename LightAt>
Error error_of(const Shafts& source, std::uint64_t marched, const LightAt& light_at) {
    Error error;
    error.marched = marched;
    const auto task = source.start();
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec2d film(x + 0.5, y + 0.5);
            const RayEnd end = source.end_of(film);
            const Rgb truth = Shafts::light_of(film, end);
            const std::optional<Rgb> found = light_at(film, end, *task);
            const double d = found ? std::abs(double(found->x - truth.x)) : 0.0;
            error.filled += !found, error.rms += d * d, error.worst = std::max(error.worst, d);
            if (end.distance == source.disc_distance) error.disc_worst = std::max(error.disc_worst, d);
        }
    error.rms = std::sqrt(error.rms / (width * height));
    return error;
}

EpipolarPicture sampled(const InScatteringSource& source, EpipolarLines lines, const LineSampling& sampling) {
    return {std::move(lines), sampling, source, in_turn};
}

Error epipolar(const Shafts& source, int lines, LineSampling sampling) {
    const EpipolarPicture picture = sampled(source, EpipolarLines(light, frame, lines, 0.4), sampling);
    return error_of(source, picture.counts().marched, [&](auto& film, auto& end, InScatteringTask& task) {
        return picture.light_at(film, end, task);
    });
}

Error sub_sampled(const Shafts& source, double spacing) {
    const InScatteringGrid grid(frame, spacing, Vec2d(0.3, 0.6), 0.02f, source, in_turn);
    return error_of(source, grid.marched(),
                    [&](auto& film, auto& end, InScatteringTask&) { return grid.light_at(film, end); });
}

}  // namespace

TEST_CASE("Epipolar pictures of shafts converge, faster than regular grids", "[epipolar]") {
    const Shafts source;
    double previous = 1.0;
    for (const int lines : {40, 80, 160, 320, 640}) {
        const Error e = epipolar(source, lines, {.initial = 64, .tolerance = 0.0f});
        INFO(lines << " lines, rms " << e.rms << ", " << e.marched << " marched, " << e.filled << " filled");
        CHECK(e.rms < (lines == 40 ? 0.4 : 0.6 * previous));  // of light up to 6
        CHECK(e.filled < 60);                                 // the disc's rim
        previous = e.rms;
    }
    CHECK(previous < 3e-3);
    const Error few = epipolar(source, 160, {.initial = 8});
    const Error grid = sub_sampled(source, 1.5);
    CHECK(few.marched < grid.marched);
    CHECK(few.rms < grid.rms);
}

TEST_CASE("Light does not leak across edges in depth", "[epipolar]") {
    const Shafts source;
    const Error found = epipolar(source, 320, {.initial = 16});
    CHECK(found.disc_worst < 0.1);
    // A search that sees no edges takes the wall's light, four times as much.
    const Error blind = epipolar(source, 320, {.initial = 16, .tolerance = 0.0f, .depth_tolerance = 10.0f});
    CHECK(blind.disc_worst > 1.0);
}

TEST_CASE("Things that fall between lines are left to the caller", "[epipolar]") {
    Shafts source;
    source.radius = 0.8;  // no line comes by
    const Error e = epipolar(source, 8, {.initial = 16});
    CHECK(e.filled >= 1);
    CHECK(e.disc_worst == 0.0);
}

TEST_CASE("What is much brighter is blurred over a pixel, and keeps its light", "[epipolar]") {
    // Light over the truth, with every texel marched: of the whole picture, and of the pixels beside the
    // disc.
    const auto light_of = [](int lines, double texels) {
        const BrightDisc source;
        const auto task = source.start();
        double sum = 0.0, truth = 0.0, beside = 0.0, true_beside = 0.0;
        for (const double offset : {0.1, 0.3, 0.5, 0.7, 0.9}) {
            const EpipolarPicture picture = sampled(source, EpipolarLines(light, frame, lines, offset),
                                                    {.initial = 4096, .texels = texels});
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const Vec2d film(x + 0.5, y + 0.5);
                    const double own = double(BrightDisc::light_of(film).x);
                    const double found = double(picture.light_at(film, task->end_of(film), *task)->x);
                    sum += found, truth += own;
                    if (BrightDisc::distance(film) > BrightDisc::radius) beside += found, true_beside += own;
                }
        }
        return std::pair(sum / truth, beside / true_beside);
    };
    const auto [all, beside] = light_of(320, 1.0);
    const auto [all_fine, beside_fine] = light_of(5120, 16.0);
    INFO("whole " << all << ", beside the disc " << beside << "; fine " << all_fine << ", " << beside_fine);
    CHECK(std::abs(all - 1.0) < 0.01);
    CHECK(beside > 1.5);
    CHECK(beside_fine - 1.0 < 0.25 * (beside - 1.0));
}

TEST_CASE("The cap holds, and what lies beyond it is left to the caller", "[epipolar]") {
    const Shafts source;
    const EpipolarPicture picture =
        sampled(source, EpipolarLines(light, frame, 100, 0.0), {.initial = 30, .cap = 5});
    for (const SampledLine& line : picture.sampled()) CHECK(line.marched() <= 5);
    const Error e = epipolar(source, 100, {.initial = 30, .cap = 5});
    CHECK(e.filled > 100);
    CHECK(e.worst < 2.0);
}

TEST_CASE("Refinement keeps its tolerance along a line", "[epipolar]") {
    const Shafts source;
    const auto worst_on_lines = [&](float tolerance) {
        const EpipolarPicture picture =
            sampled(source, EpipolarLines(light, frame, 50, 0.0), {.initial = 12, .tolerance = tolerance});
        double worst = 0.0;
        for (const SampledLine& line : picture.sampled())
            for (std::size_t i = 0; i < line.texels().size(); ++i) {
                const Vec2d film = line.film(double(i));
                const float truth = Shafts::light_of(film, source.end_of(film)).x;
                worst = std::max(worst, std::abs(double(line.texels()[i].light.x - truth)));
            }
        return worst;
    };
    CHECK(worst_on_lines(0.02f) < 0.02 * 10.0);  // light goes up to 9
    CHECK(worst_on_lines(0.0f) > 0.3);           // twelve samples miss what happens near the light
}

TEST_CASE("Texels take the memory that is stated", "[epipolar]") {
    STATIC_REQUIRE(sizeof(LineTexel) == 24);
    const Shafts source;
    const EpipolarPicture picture = sampled(source, EpipolarLines(light, frame, 200, 0.0), {});
    const PictureCounts counts = picture.counts();
    CHECK(counts.bytes <= 24 * counts.texels + 160 * counts.lines);
}
