// The weights of bidirectional path tracing against brute force: of every path that is found, the densities
// of all techniques are multiplied up vertex by vertex, and the weights that they give add up to 1 by
// construction.
#include "integrators/bidirectional/strategies.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;
using integrators::Contribution;
using integrators::Heuristic;
using integrators::LightEnds;
using integrators::LightPoint;
using integrators::PathVertex;

namespace {

constexpr std::uint32_t light_paths = 37;  // not the number of pixels: the factor must show

/// A path from the light (0) to the lens (n - 1).
struct WholePath {
    std::vector<PathVertex> vertices;
    LightPoint light;
    std::vector<double> edges;  ///< tau between i and i + 1
    int from_light = 0;         ///< vertices of the light path; others were found from the camera
};

enum class Planted { none, reverse, measure, light };

class BruteForce {
  public:
    BruteForce(const core::Scene& scene, const LightEnds& ends, Heuristic heuristic, Planted planted)
        : scene_(scene), ends_(ends), heuristic_(heuristic), planted_(planted) {}

    double weight(const WholePath& path, int s) const {
        double sum = 0.0, own = 0.0;
        for (int i = 0; i < int(path.vertices.size()); ++i) {
            const double p = density(path, i);
            const double h = heuristic_ == Heuristic::power ? p * p : p;
            sum += h;
            if (i == s) own = h;
        }
        return own / sum;
    }

  private:
    static core::Vec3 towards(const WholePath& path, int from, int to) {
        if (path.light.infinite() && from == 0) return -path.light.wi;
        if (path.light.infinite() && to == 0) return path.light.wi;
        // As it was walked, where it was: positions are rounded.
        const int i = std::min(from, to), s = path.from_light;
        if (i + 1 < s || (i >= s && i + 2 < int(path.vertices.size()))) {
            const bool by_light = i + 1 < s;
            const core::Vec3 back = path.vertices[std::size_t(by_light ? i + 1 : i)].scattering.wo;
            return (by_light ? to == i : to == i + 1) ? back : -back;
        }
        return core::Vec3(glm::normalize(core::Vec3d(path.vertices[std::size_t(to)].scattering.position) -
                                         core::Vec3d(path.vertices[std::size_t(from)].scattering.position)));
    }
    /// C / d^2 tau of vertex `to`, next to `from`.
    double measure(const WholePath& path, int from, int to) const {
        const double tau = path.edges[std::size_t(std::min(from, to))];
        const auto &a = path.vertices[std::size_t(from)], &b = path.vertices[std::size_t(to)];
        const core::Vec3 w = towards(path, from, to);
        if (path.light.infinite() && to == 0) return tau;
        const core::Vec3d d = core::Vec3d(a.scattering.position) - core::Vec3d(b.scattering.position);
        double cosine = 1.0;
        if (to == 0 && path.light.normal != core::Vec3(0.0f))
            cosine = std::fabs(double(glm::dot(path.light.normal, w)));
        else if (to != 0 && b.scattering.on_surface())
            cosine = std::fabs(double(glm::dot(b.scattering.hit.geometric_normal, w)));
        if (planted_ == Planted::measure && to == 1) cosine = 1.0;
        const bool parallel =
            (path.light.infinite() && from == 0) ||
            (from == int(path.vertices.size()) - 1 && scene_.camera().traits().delta_direction);
        return tau * cosine / (parallel ? 1.0 : glm::dot(d, d));
    }
    /// Per solid angle, of continuing from `at` to `to` when coming from `from`; 1 for a delta part.
    double scatters(const WholePath& path, int from, int at, int to, core::TransportMode mode) const {
        if (path.vertices[std::size_t(at)].delta) return 1.0;
        core::ScatteringVertex v = path.vertices[std::size_t(at)].scattering;
        v.wo = towards(path, at, from);
        core::Vec3 w = towards(path, at, to);
        if (planted_ == Planted::reverse && mode == core::TransportMode::power) std::swap(v.wo, w);
        return double(v.pdf_solid_angle(w, mode));
    }
    double density(const WholePath& path, int s) const {
        const int n = int(path.vertices.size()), t = n - s;
        const auto delta = [&](int i) { return i > 0 && i < n - 1 && path.vertices[std::size_t(i)].delta; };
        const core::EmitterTraits traits = path.light.emitter->traits();
        if (s == 0 && !traits.can_be_hit()) return 0.0;
        if (s > 0 && (delta(s - 1) || delta(s))) return 0.0;  // what is connected has no delta part
        if (t == 1 && n == 2) return 0.0;                     // lights are not joined to the lens
        double p = t == 1 ? double(light_paths) : 1.0;
        const LightEnds::Start start = ends_.start(path.light);
        if (s == 1) {
            const auto& v = path.vertices[1].scattering;
            const core::Vec3d d = core::Vec3d(v.position) - core::Vec3d(path.light.position);
            p *= ends_.sampled(v.light_receiver(), path.light, path.light.infinite() ? 1.0 : glm::dot(d, d));
        }
        if (s >= 2) p *= start.light * (planted_ == Planted::light ? 2.0 : 1.0);
        if (s >= 2) p *= start.receiver * measure(path, 0, 1);
        for (int i = 2; i < s; ++i)
            p *= scatters(path, i - 2, i - 1, i, core::TransportMode::power) * measure(path, i - 1, i);
        if (t >= 2) {
            const core::Vec3 origin = path.vertices[std::size_t(n - 1)].scattering.position;
            const auto w = scene_.camera().importance(origin, towards(path, n - 1, n - 2), 1.0f);
            if (!w) return 0.0;
            const bool parallel = scene_.camera().traits().delta_direction;
            p *= double(parallel ? w->pdf_area : w->pdf_solid_angle) * measure(path, n - 1, n - 2);
        }
        for (int i = n - 3; i >= s; --i)
            p *= scatters(path, i + 2, i + 1, i, core::TransportMode::radiance) * measure(path, i + 1, i);
        return p;
    }

    const core::Scene& scene_;
    const LightEnds& ends_;
    Heuristic heuristic_;
    Planted planted_;
};

/// The path that was just found, from both subpaths.
template <bool Media>
WholePath whole(const core::Scene& scene, const integrators::Strategies<Media>& found, int s, int t) {
    const auto &light = found.light_path().vertices, &eye = found.eye_path().vertices;
    WholePath path;
    path.from_light = s;
    path.light = s >= 2 ? found.light_start() : found.light_point();
    for (int i = 0; i < s; ++i) path.vertices.push_back(s == 1 ? PathVertex{} : light[std::size_t(i)]);
    if (s == 1) path.vertices[0].scattering.position = path.light.position;
    if (t == 1) path.vertices.emplace_back().scattering.position = found.lens_point();
    for (int i = t - 1; t > 1 && i >= 0; --i) path.vertices.push_back(eye[std::size_t(i)]);
    if (s > 0) path.vertices[std::size_t(s - 1)].delta = false;
    path.vertices[std::size_t(s)].delta = false;
    const int n = s + t;
    // tau of every edge anew, from its end nearer to the light where that has its media.
    for (int i = 0; i + 1 < n; ++i) {
        const bool infinite = i == 0 && path.light.infinite();
        const int at = i == 0 ? 1 : i, other = i == 0 ? 0 : i + 1;
        const PathVertex& from = path.vertices[std::size_t(at)];
        const core::Vec3 to = path.vertices[std::size_t(other)].scattering.position;
        const core::Vec3 d = infinite ? path.light.wi : glm::normalize(to - from.scattering.position);
        core::Ray ray{from.scattering.ray_origin(d), d};
        if (!infinite) ray.t_max = glm::distance(to, ray.origin);
        core::TrackingCounters counters;
        path.edges.push_back(!Media
                                 ? 1.0
                                 : integrators::edge_transmittance(
                                       scene, ray, from.scattering.state_towards(from.state, d), counters));
    }
    return path;
}

/// Light that a technique finds, times the weight of one of them: over samples, some of which find nothing.
struct Kept {
    double now = 0.0, sum = 0.0, squares = 0.0, samples = 0.0;
    void end_sample() { sum += now, squares += now * now, now = 0.0; }
    double mean() const { return sum / samples; }
    double variance_of_mean() const { return (squares / samples - mean() * mean()) / samples; }
};

struct Comparison {
    int paths = 0, wrong = 0, with_delta = 0, with_media = 0;
    double worst = 0.0;
    std::map<std::pair<int, int>, std::map<int, Kept>> kept;  ///< by technique, of paths of two edges
    std::map<std::pair<int, int>, int> techniques;
};

template <bool Media>
Comparison compare(const core::Scene& scene, Heuristic heuristic, Planted planted = Planted::none,
                   std::uint32_t samples = 300, double tolerance = 1e-6) {
    const LightEnds ends(scene);
    integrators::BidirectionalSettings settings;
    settings.heuristic = heuristic, settings.all_connections = true, settings.limits.max_depth = 6;
    core::WalkContext context;
    integrators::Strategies<Media> strategies(scene, ends, settings, light_paths, 1.0f, context);
    const BruteForce brute(scene, ends, heuristic, planted);
    Comparison result;
    const auto check = [&](const Contribution& c, bool inside = true) {
        // Where nothing was found there is no weight; of one edge there is one technique.
        if (!(c.weight > 0.0f) || c.s + c.t < 3) return;
        const WholePath path = whole(scene, strategies, c.s, c.t);
        const double expected = brute.weight(path, c.s);
        const double error = std::fabs(double(c.weight) - expected);
        const bool right = error < tolerance;
        result.worst = std::max(result.worst, error);
        // A light path lands somewhere on the film, all light paths together on all pixels.
        const double share = c.t == 1 ? (inside ? light_paths / 256.0 : 0.0) : 1.0;
        for (int k = 0; c.s + c.t == 3 && k < 3; ++k)
            result.kept[{c.s, c.t}][k].now += share * double(c.light.x / c.weight) * brute.weight(path, k);
        ++result.paths, ++result.techniques[{c.s, c.t}], result.wrong += !right;
        for (const PathVertex& v : path.vertices)
            result.with_delta += v.delta, result.with_media += v.scattering.phase != nullptr;
    };
    for (std::uint32_t i = 0; i < samples; ++i) {
        context.rng = core::Rng(i + 1);
        core::Sampler light(core::SamplerKind::independent, 1, i, 5),
            eye(core::SamplerKind::independent, 1, i, 7);
        strategies.trace_light_path(light, [&](const Contribution& c, const core::Vec2& at) {
            check(c, at.x >= 0.0f && at.x < 16.0f && at.y >= 0.0f && at.y < 16.0f);
        });
        const core::Vec2 film = 16.0f * eye.next_2d();
        const core::Ray ray = scene.camera().sample_ray(film, eye.next_2d());
        strategies.trace_eye_path({ray, film, eye, context.rng}, check);
        for (auto& [technique, kept] : result.kept)
            for (auto& [other, k] : kept) k.end_sample(), k.samples = samples;
    }
    return result;
}

const std::string glass_and_mirror = R"(
    <shape type="sphere"><point name="center" x="-0.35" y="-0.4" z="0.2"/><float name="radius" value="0.35"/>
        <bsdf type="dielectric"/></shape>
    <shape type="sphere"><point name="center" x="0.5" y="0.2" z="-0.4"/><float name="radius" value="0.3"/>
        <bsdf type="conductor"/></shape>
    <shape type="sphere"><point name="center" x="0.1" y="-0.1" z="0.3"/><float name="radius" value="0.2"/>
        <bsdf type="plastic"/></shape>)";
const std::string lamps = R"(
    <emitter type="point"><point name="position" x="-0.5" y="0.5" z="0.5"/><rgb name="intensity" value="0.7"/></emitter>
    <emitter type="spot"><transform name="to_world"><lookat origin="0.6, 0.6, 0.6" target="0, -1, 0" up="0, 1, 0.1"/>
        </transform><rgb name="intensity" value="2"/></emitter>
    <emitter type="directional"><vector name="direction" x="-0.2" y="-0.5" z="-1"/><rgb name="irradiance" value="1"/></emitter>
    <emitter type="constant"><rgb name="radiance" value="0.3"/></emitter>)";

void report(const Comparison& c) {
    std::string text;
    for (const auto& [st, n] : c.techniques) text += fmt::format("({}, {}) {}  ", st.first, st.second, n);
    UNSCOPED_INFO(c.paths << " paths, " << c.wrong << " wrong, the worst by " << c.worst << ", "
                          << c.with_delta << " delta parts, " << c.with_media << " collisions; " << text);
}

}  // namespace

TEST_CASE("the weights of every path add up to 1 over its techniques", "[bdpt][weights]") {
    for (const std::string& wall : {grey, glossy, mixed})
        for (const Heuristic heuristic : {Heuristic::power, Heuristic::balance}) {
            const auto scene = scene_from(with(box(wall, ""), glass_and_mirror + lamps));
            const Comparison c = compare<false>(*scene, heuristic);
            report(c);
            CHECK(c.paths > 600);
            CHECK(c.with_delta > 100);
            CHECK(c.techniques.size() >= 18);
            CHECK(c.wrong == 0);
        }
}

TEST_CASE("the weights of every path add up to 1 in media", "[bdpt][weights]") {
    TemporaryFolder folder;
    for (const std::string& medium :
         {fog("0.6, 0.9, 1.2", R"(<phase type="hg"><float name="g" value="0.6"/></phase>)"),
          smoke_medium(folder.file("smoke.vol"))}) {
        const auto scene = scene_from(with(box(grey, medium), glass_and_mirror + lamps));
        // A grid's marching steps are rounded from either end of an edge.
        const Comparison c = compare<true>(*scene, Heuristic::power, Planted::none, 300, 1e-5);
        report(c);
        CHECK(c.paths > 600);
        CHECK(c.with_media > 100);
        CHECK(c.wrong == 0);
    }
}

// Connections that pass the boundary at one of their ends: the medium of an edge is the one on its side of a
// rough surface, which is not the medium on the side that the path came from.
TEST_CASE("the weights of every path add up to 1 through rough glass with fog inside",
          "[bdpt][weights][boundaries]") {
    const std::string ball = R"(<shape type="sphere"><point name="center" x="0.1" y="0" z="0.3"/>
        <float name="radius" value="0.5"/><bsdf type="roughdielectric"><float name="alpha" value="0.5"/></bsdf>)" +
                             fog("3, 4, 5", R"(<phase type="hg"><float name="g" value="0.6"/></phase>)") +
                             "</shape>";
    const auto scene = scene_from(with(box(grey, ""), ball + lamps));
    const Comparison c = compare<true>(*scene, Heuristic::power, Planted::none, 800, 1e-5);
    report(c);
    CHECK(c.paths > 600);
    CHECK(c.with_media > 60);
    CHECK(c.wrong == 0);
}

TEST_CASE("what one technique finds is divided among all as they find it themselves", "[bdpt][weights]") {
    // For paths of two edges, light found by technique k times the weight of technique i is, in the mean, the
    // contribution that i keeps, whatever k is. Densities that both the weights and the brute force had wrong
    // show here.
    const std::string xml = R"(<scene version="3.0.0"><shape type="cube"><transform name="to_world">
        <scale value="0.9"/></transform><bsdf type="null"/><medium type="homogeneous" name="interior">
        <rgb name="sigma_t" value="2"/><rgb name="albedo" value="1"/></medium></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="0.7"/><rotate y="1" angle="180"/>
        <translate z="6"/></transform><emitter type="area"><rgb name="radiance" value="30"/></emitter></shape>
        <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
        <sensor type="perspective"><float name="fov" value="20"/><transform name="to_world">
        <lookat origin="0, 0, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    const Comparison c = compare<true>(*scene_from(xml), Heuristic::power, Planted::none, 40000);
    for (int i = 0; i < 3; ++i) {
        const auto& own = c.kept.at({i, 3 - i}).at(i);
        for (int k = 0; k < 3; ++k) {
            const auto& other = c.kept.at({k, 3 - k}).at(i);
            INFO("technique " << i << " by " << k << ": " << other.mean() << " and " << own.mean());
            CHECK(std::fabs(other.mean() - own.mean()) <
                  4.5 * std::sqrt(other.variance_of_mean() + own.variance_of_mean()));
        }
    }
}

TEST_CASE("the weights of every path add up to 1 for every camera", "[bdpt][weights]") {
    const std::string look =
        R"(<lookat origin="0.2, 0.1, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)";
    for (
        const std::string& sensor :
        {R"(<sensor type="thinlens"><float name="fov" value="34"/><float name="aperture_radius" value="0.15"/>
             <float name="focus_distance" value="3"/><transform name="to_world">)" +
             look,
         R"(<sensor type="orthographic"><transform name="to_world"><scale x="0.9" y="0.9"/>)" + look}) {
        const auto scene = scene_from(with_sensor(box(grey, ""), sensor));
        const Comparison c = compare<false>(*scene, Heuristic::power);
        report(c);
        CHECK(c.paths > 600);
        CHECK(c.wrong == 0);
    }
}

TEST_CASE("wrong densities are found by the weights", "[bdpt][weights][planted]") {
    const auto scene = scene_from(with(box(mixed, ""), lamps));
    for (const Planted planted : {Planted::reverse, Planted::measure, Planted::light})
        CHECK(compare<false>(*scene, Heuristic::power, planted).wrong > 100);
}
