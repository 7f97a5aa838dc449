#include "lights/selection/lightcuts/receiver_sets.h"

#include <algorithm>
#include <limits>

namespace mote::lights {

using namespace core;

namespace {

/// If true, two receivers lie on one face, by their normals. In a medium there are none.
bool alike(const ReceiverLanes& x, int i, int j) {
    if (x.in_medium[i] != x.in_medium[j]) return false;
    if (x.in_medium[i] != 0.0f) return true;
    constexpr float min_cosine = 0.8f, max_off_plane2 = 0.09f;
    const Vec3 a = x.geometric_normal(i), b = x.geometric_normal(j), d = x.position(i) - x.position(j);
    return glm::dot(a, b) >= min_cosine &&
           std::max(sqr(glm::dot(a, d)), sqr(glm::dot(b, d))) <= max_off_plane2 * glm::dot(d, d);
}

}  // namespace

ReceiverSets::ReceiverSets(const ReceiverLanes& x) : stages_(1) {
    constexpr float far = std::numeric_limits<float>::max();
    float apart2[width][width];  // of the farthest of two sets, by the lanes that name them
    int active = 0;
    for (int i = 0; i < width; ++i) {
        const bool lit = x.max_vpl_depth[i] != 0;
        active += lit;
        set_of_[0][std::size_t(i)] = lit ? std::uint8_t(i) : none;
        for (int j = 0; j < i; ++j) {
            const Vec3 d = x.position(i) - x.position(j);
            const bool joined = lit && x.max_vpl_depth[j] != 0 && alike(x, i, j);
            apart2[i][j] = joined ? std::min(glm::dot(d, d), far) : far;
        }
    }
    for (; stages_ < active; ++stages_) {
        int a = 0, b = 0;
        float least = far;
        for (int i = 0; i < width; ++i)
            for (int j = 0; j < i; ++j)
                if (apart2[i][j] < least) least = apart2[i][j], a = i, b = j;
        if (!(least < far)) break;
        // b represents both; a is no longer a representative.
        for (int i = 0; i < width; ++i) {
            if (i == a || i == b) continue;
            float& to_b = i > b ? apart2[i][b] : apart2[b][i];
            to_b = std::max(to_b, i > a ? apart2[i][a] : apart2[a][i]);
        }
        for (int i = 0; i < width; ++i) (i > a ? apart2[i][a] : apart2[a][i]) = far;
        const auto now = std::size_t(stages_);
        diameter_[now] = std::max(diameter_[now - 1], std::sqrt(least));
        set_of_[now] = set_of_[now - 1];
        for (std::uint8_t& set : set_of_[now])
            if (set == a) set = std::uint8_t(b);
    }
}

}  // namespace mote::lights
