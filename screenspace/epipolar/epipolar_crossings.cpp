#include "screenspace/epipolar/epipolar_crossings.h"

#include <algorithm>
#include <cmath>

namespace mote::screenspace {

using namespace core;

namespace {

/// Lines of the other light that are tried for one sample.
constexpr int candidates = 12;

/// Which places of the spread samples are taken, by line.
using Taken = std::vector<std::vector<bool>>;

/// Places that cannot move: ends of runs, which are marched anyway, and all of a line that the cap cuts,
/// since it counts from the line's start.
std::vector<bool> fixed_places(const SampledLine& line, int cap) {
    std::vector<bool> fixed(std::size_t(line.spread().count), line.spread().count > cap);
    for (std::size_t i = 0; i < fixed.size(); ++i)
        if (line.ends_run(std::ptrdiff_t(std::ceil(line.spread().place(int(i)))))) fixed[i] = true;
    return fixed;
}

struct Result {
    std::array<RayEnd, 2> ends;
    std::array<MarchedRay, 2> light;
};
static_assert(sizeof(Crossing) + sizeof(std::optional<Result>) <= crossing_bytes);

struct Choice {
    Crossing crossing;
    int place;  ///< on the other line
    double cost = infinity;
};

/// Where the sample of light `l` that belongs at `place` of a line could go, among the lines of light `o`.
std::optional<Choice> best_crossing(std::span<EpipolarPicture* const> lights, std::uint32_t l,
                                    std::uint32_t o, std::uint32_t line, int place, const Taken& taken) {
    const SampledLine& own = lights[l]->sampled()[line];
    const auto& spread = own.spread();
    const double last = double(own.texels().size() - 1), middle = spread.place(place);
    const auto film = [&](double texel) { return own.film(std::clamp(texel, 0.0, last)); };
    // The other light's lines around both ends of the stretch: all in between cross it.
    const EpipolarLines& others = lights[o]->lines();
    const int n = int(others.lines().size());
    const int from = int(others.around(film(middle - 0.5 * spread.spacing)).before);
    int count = int(others.around(film(middle + 0.5 * spread.spacing)).before) - from;
    if (others.light_inside() && std::abs(count) > n / 2) count += count < 0 ? n : -n;
    const int first = std::min(from, from + count), lines = std::abs(count) + 2;  // those beside them too
    std::optional<Choice> best;
    for (int k = 0; k < std::min(lines, candidates); ++k) {
        const int i = first + int(std::int64_t(k) * lines / std::min(lines, candidates));
        const auto other_line = std::size_t((i % n + n) % n);
        const SampledLine& other = lights[o]->sampled()[other_line];
        const auto meeting = meet(own.line(), other.line());
        if (!meeting) continue;
        const double texel = meeting->a * last, there = meeting->b * double(other.texels().size() - 1);
        const int other_place = other.spread().nearest(there);
        if (other_place < 0 || other_place >= other.spread().count) continue;
        if (taken[other_line][std::size_t(other_place)] || !own.lit(texel) || !other.lit(there)) continue;
        const double moved = (texel - middle) / spread.spacing;
        const double moved_there = (there - other.spread().place(other_place)) / other.spread().spacing;
        if (std::abs(moved) >= 0.5) continue;
        const double cost = moved * moved + moved_there * moved_there;
        if (best && best->cost <= cost) continue;
        best = Choice{
            {{{{l, line, texel}, {o, std::uint32_t(other_line), there}}}, film(texel)}, other_place, cost};
    }
    return best;
}

}  // namespace

std::optional<Meeting> meet(const EpipolarLine& a, const EpipolarLine& b) {
    const Vec2d u = a.end - a.start, v = b.end - b.start, w = b.start - a.start;
    const auto cross = [](const Vec2d& p, const Vec2d& q) { return p.x * q.y - p.y * q.x; };
    const double area = cross(u, v);
    // Closer to parallel than this, the point in common is not known to a fraction of a pixel.
    if (!(std::abs(area) > 1e-9 * glm::length(u) * glm::length(v))) return std::nullopt;
    const Meeting m{cross(w, v) / area, cross(w, u) / area};
    const auto within = [](double share) { return share >= 0.0 && share <= 1.0; };
    if (!within(m.a) || !within(m.b)) return std::nullopt;
    return m;
}

std::vector<Crossing> choose_crossings(std::span<EpipolarPicture* const> lights,
                                       core::CancelToken cancelled) {
    std::vector<Taken> taken(lights.size());
    for (std::size_t l = 0; l < lights.size(); ++l) {
        if (lights[l]->sampled().empty()) return {};  // cancelled
        for (const SampledLine& line : lights[l]->sampled())
            taken[l].push_back(fixed_places(line, lights[l]->settings().cap));
    }
    std::vector<Crossing> chosen;
    const auto n = std::uint32_t(lights.size());
    for (std::uint32_t l = 0; l + 1 < n; ++l)
        for (std::uint32_t line = 0; line < taken[l].size(); ++line)
            for (int place = 0; place < int(taken[l][line].size()); ++place)
                // The lights that are still to come, in turn.
                for (std::uint32_t k = 0; k < n - l - 1 && !taken[l][line][std::size_t(place)]; ++k) {
                    cancelled.check();
                    const std::uint32_t o = l + 1 + (std::uint32_t(place) + line + k) % (n - l - 1);
                    const auto choice = best_crossing(lights, l, o, line, place, taken[o]);
                    if (!choice) continue;
                    taken[l][line][std::size_t(place)] = true;
                    taken[o][choice->crossing.sides[1].line][std::size_t(choice->place)] = true;
                    chosen.push_back(choice->crossing);
                }
    return chosen;
}

std::size_t march_crossings(std::span<EpipolarPicture* const> lights, const SharedRaySource& source,
                            const EpipolarPicture::Loop& loop, core::CancelToken cancelled) {
    const std::vector<Crossing> crossings = choose_crossings(lights, cancelled);
    std::vector<std::optional<Result>> results(crossings.size());
    constexpr std::size_t chunk = 64;
    loop(int((crossings.size() + chunk - 1) / chunk), [&](int c) {
        const auto task = source.start();
        for (std::size_t i = std::size_t(c) * chunk;
             i < std::min(crossings.size(), (std::size_t(c) + 1) * chunk); ++i) {
            Result result{task->ends_of(crossings[i]), {}};
            bool both = true;
            for (std::size_t s = 0; s < 2; ++s) {
                const Crossing::Side& side = crossings[i].sides[s];
                const SampledLine& line = lights[side.light]->sampled()[side.line];
                const auto nearest = std::round(side.texel);
                const LineTexel& texel = line.texels()[std::size_t(nearest)];
                both &= continues(result.ends[s], texel.distance, texel.surface,
                                  lights[side.light]->settings().depth_tolerance,
                                  [&] { return task->ray(line.film(nearest)); });
            }
            if (!both) continue;
            result.light = task->march(crossings[i], result.ends);
            results[i] = result;
        }
    });
    std::size_t marched = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        if (!results[i]) continue;
        ++marched;
        for (std::size_t s = 0; s < 2; ++s) {
            const Crossing::Side& side = crossings[i].sides[s];
            lights[side.light]->line(side.line).add(side.texel, results[i]->ends[s], results[i]->light[s]);
        }
    }
    return marched;
}

}  // namespace mote::screenspace
