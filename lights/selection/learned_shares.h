// What drawn lights found out about groups of lights: by how much what arrives differs from what was
// expected.
//
// Of a group that is expected to send e, one drawn light says r e, and the mean of r^2 is m^2. A draw among
// groups with shares p_i has the second moment  sum of (e_i m_i)^2 / p_i,  which is least where p_i is in
// proportion to e_i m_i (Cauchy and Schwarz; Vevoda et al. 2018 learn the same with a prior). So hidden
// groups, and lobes that send less than their place lets expect, are drawn less often. Nobody's share is 0:
// after n draws m^2 is
//   (sum of r^2 + k m^2 of the group above) / (n + k),
// and never below a share of that. So what n draws have not seen is drawn sqrt(1 + n/k) times less often, at
// most. Estimates stay unbiased, as long as a draw's shares come of other draws alone: of the tiles before.
//
// Resampling knows r without what stands between for every candidate, and of few rays what does: there m^2 is
// the product of two means, each learned by itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "lights/selection/light_tree.h"

namespace mote::lights {

/// m^2 of a group: of looks without rays, or of all that is known, and of rays.
struct LearnedMean {
    float looks = 1.0f, rays = 1.0f;
    float square() const { return looks * rays; }
    /// m over that of another.
    float over(const LearnedMean& other) const { return std::sqrt(square() / other.square()); }
};

class LearnedShares {
  public:
    using Means = std::array<LearnedMean, most_parts>;

    bool empty() const { return all_.looks.count == 0.0f; }
    /// Of the root. Only ratios to it count: 1 where nothing arrived yet.
    LearnedMean of_all() const { return {all_.looks.mean(), all_.rays.mean()}; }
    /// Of the parts of a node, whose own is `above`. Returns whether any is known; else all are the same.
    bool of_parts(std::uint32_t node, const LearnedMean& above, Means& means) const {
        means.fill(above);
        const Node* seen = find(node);
        if (!seen) return false;
        for (std::size_t i = 0; i < most_parts; ++i)
            means[i] = {(*seen)[i].looks.mean(above.looks, prior_looks),
                        (*seen)[i].rays.mean(above.rays, prior_rays)};
        return true;
    }
    /// Of a part of a node, one draw's r^2, and the sum of those of rays.
    void add(std::uint32_t node, int part, float look, float rays, float ray_squares) {
        if (Node* seen = place(node)) (*seen)[std::size_t(part)].add(look, rays, ray_squares);
    }
    void add_to_all(float look, float rays, float ray_squares) { all_.add(look, rays, ray_squares); }

  private:
    static constexpr float prior_looks = 4.0f, prior_rays = 8.0f, least = 1.0f / 16.0f;
    struct Sum {
        float count = 0.0f, squares = 0.0f;

        float mean() const { return squares > 0.0f ? squares / count : 1.0f; }
        float mean(float above, float prior) const {
            return std::max((squares + prior * above) / (count + prior), least * above);
        }
    };
    struct Seen {
        Sum looks, rays;

        void add(float look, float ray_count, float ray_squares) {
            looks.count += 1.0f, looks.squares += look;
            rays.count += ray_count, rays.squares += ray_squares;
        }
    };
    using Node = std::array<Seen, most_parts>;
    static constexpr std::size_t size = 1 << 12;  // places, of which some stay free

    static std::size_t first_place(std::uint32_t node) {
        return std::size_t((std::uint64_t(node) + 1) * 0x9e3779b97f4a7c15ull >> 52);
    }
    const Node* find(std::uint32_t node) const {
        if (items_.empty()) return nullptr;
        for (std::size_t p = first_place(node); places_[p] != 0; p = (p + 1) % size)
            if (nodes_[places_[p] - 1u] == node) return &items_[places_[p] - 1u];
        return nullptr;
    }
    /// Nothing where there are too many.
    Node* place(std::uint32_t node) {
        if (places_.empty()) places_.resize(size);
        std::size_t p = first_place(node);
        for (; places_[p] != 0; p = (p + 1) % size)
            if (nodes_[places_[p] - 1u] == node) return &items_[places_[p] - 1u];
        if (items_.size() >= size * 3 / 4) return nullptr;
        nodes_.push_back(node), items_.emplace_back();
        places_[p] = std::uint16_t(items_.size());
        return &items_.back();
    }

    Seen all_;
    std::vector<std::uint16_t> places_;  ///< by hash of a node: 1 + its item; 0: none
    std::vector<std::uint32_t> nodes_;
    std::vector<Node> items_;
};

}  // namespace mote::lights
