#include "screenspace/denoising/reprojection.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mote::screenspace {

using namespace core;

namespace {

/// Distance to the nearer neighbour in a row or column, the larger of both; infinite without neighbours.
float footprint(const FrameFeatures& f, int x, int y) {
    const auto at = [&](int i, int j) {
        return f.position[std::size_t(j) * std::size_t(f.width) + std::size_t(i)];
    };
    const Vec3 here = at(x, y);
    const auto nearest = [&](int dx, int dy) {
        float least = infinity;
        for (const int sign : {-1, 1}) {
            const int i = x + sign * dx, j = y + sign * dy;
            if (i < 0 || j < 0 || i >= f.width || j >= f.height) continue;
            const float d = glm::distance(at(i, j), here);
            if (std::isfinite(d)) least = std::fmin(least, d);
        }
        return least;
    };
    const float across = nearest(1, 0), down = nearest(0, 1);
    return std::isfinite(across) && std::isfinite(down) ? std::fmax(across, down) : std::fmin(across, down);
}

class Rejection {
  public:
    Rejection(const FrameFeatures& now, const FrameFeatures& before, const RejectionSettings& settings)
        : now_(now), before_(before), s_(settings) {}

    /// The pixel `q` of the frame before showed another point than `p` does now, `reach` [m] apart at most.
    bool rejects(std::size_t p, std::size_t q, float reach) const {
        if (!now_.id.empty() && !before_.id.empty() && now_.id[p] != before_.id[q]) return true;
        if (!now_.position.empty() && !before_.position.empty()) {
            const Vec3 a = now_.previous_position.empty() ? now_.position[p] : now_.previous_position[p];
            const Vec3 b = before_.position[q];
            if (is_finite(a) != is_finite(b)) return true;
            if (!is_finite(a)) return false;  // sky in both
            if (!(glm::distance(a, b) <= reach)) return true;
        }
        return !now_.normal.empty() && !before_.normal.empty() &&
               !(glm::dot(now_.normal[p], before_.normal[q]) >= s_.normal_cosine);
    }
    float reach(int x, int y) const {
        return now_.position.empty() ? infinity : s_.position * footprint(now_, x, y);
    }

  private:
    const FrameFeatures &now_, &before_;
    const RejectionSettings& s_;
};

}  // namespace

void FrameFeatures::check() const {
    const auto fits = [&](std::size_t size) { return size == 0 || size == pixels(); };
    if (width < 1 || height < 1 || !fits(position.size()) || !fits(normal.size()) || !fits(id.size()) ||
        !fits(motion.size()) || !fits(previous_position.size()))
        throw std::invalid_argument("features do not have the size of the frame");
}

std::vector<PixelHistory> reproject(const FrameFeatures& now, const FrameFeatures& before,
                                    const RejectionSettings& settings) {
    now.check(), before.check();
    std::vector<PixelHistory> result(now.pixels());
    const Rejection rejection(now, before, settings);
    tbb::parallel_for(0, now.height, [&](int y) {
        for (int x = 0; x < now.width; ++x) {
            const std::size_t p = std::size_t(y) * std::size_t(now.width) + std::size_t(x);
            const Vec2 at = Vec2(float(x), float(y)) + (now.motion.empty() ? Vec2(0.0f) : now.motion[p]);
            // Also where the motion is not finite.
            if (!(at.x > -1.0f && at.y > -1.0f && at.x < float(before.width) && at.y < float(before.height)))
                continue;
            const int i0 = int(std::floor(at.x)), j0 = int(std::floor(at.y));
            const Vec2 part = at - Vec2(float(i0), float(j0));
            const float reach = rejection.reach(x, y);
            float sum = 0.0f;
            for (int k = 0; k < 4; ++k) {
                const int i = i0 + k % 2, j = j0 + k / 2;
                const float weight = (k % 2 ? part.x : 1.0f - part.x) * (k / 2 ? part.y : 1.0f - part.y);
                if (!(weight > 0.0f) || i < 0 || j < 0 || i >= before.width || j >= before.height) continue;
                const std::size_t q = std::size_t(j) * std::size_t(before.width) + std::size_t(i);
                if (rejection.rejects(p, q, reach)) continue;
                result[p].pixel[std::size_t(k)] = std::uint32_t(q);
                result[p].weight[std::size_t(k)] = weight, sum += weight;
            }
            if (sum < 0.01f)
                result[p].weight = {};
            else if (sum != 1.0f)
                for (float& w : result[p].weight) w /= sum;
        }
    });
    return result;
}

Vec2 FrameCamera::project(const Vec3& point) const {
    const glm::dvec3 h = world_to_pixels * glm::dvec4(glm::dvec3(point), 1.0);
    if (!(h.z > 0.0)) return Vec2(infinity);
    return Vec2(float(h.x / h.z), float(h.y / h.z));
}

std::vector<Vec2> camera_motion(std::span<const Vec3> position, const FrameCamera& now,
                                const FrameCamera& before) {
    std::vector<Vec2> motion(position.size(), Vec2(0.0f));
    if (now.world_to_pixels == before.world_to_pixels) return motion;
    tbb::parallel_for(std::size_t(0), motion.size(), [&](std::size_t p) {
        motion[p] = before.project(position[p]) - now.project(position[p]);
    });
    return motion;
}

}  // namespace mote::screenspace
