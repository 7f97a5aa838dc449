// Sums over pixels and over nodes. A receiver's form factors, the sum with L = 1, cannot exceed one; where
// they do, because surfaces hide each other or the picture is coarse, E is divided by their sum. So no step
// can add more light than there was, whatever the picture.
#include "screenspace/ssbc/ssbc_sum.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace mote::screenspace {

using namespace core;

namespace {

/// Sums gathered by the receivers of a packet.
template <class Real>
struct PacketSums {
    alignas(32) std::array<Real, packet_size> r{}, g{}, b{}, form_factor{};

    void add(const Lanes& residual, const Rgb& power, float area) {
        MOTE_INDEPENDENT_LANES
        for (std::size_t l = 0; l < packet_size; ++l) {
            r[l] += residual[l] * power.x, g[l] += residual[l] * power.y, b[l] += residual[l] * power.z;
            form_factor[l] += residual[l] * area;
        }
    }
    /// Writes E for the first lanes and returns how many had to be limited.
    std::uint64_t store(std::span<Rgb> irradiance) const {
        std::uint64_t limited = 0;
        for (std::size_t l = 0; l < irradiance.size(); ++l) {
            // f_r of Eq. 11.5 without the reflectance: 1/pi.
            const Real total = form_factor[l] * Real(inv_pi), scale = Real(inv_pi) / std::max(Real(1), total);
            irradiance[l] = {float(r[l] * scale), float(g[l] * scale), float(b[l] * scale)};
            limited += total > Real(1);
        }
        return limited;
    }
};

/// A packet that is not full repeats its last receiver.
ReceiverPacket make_packet(std::span<const SsbcReceiver> receivers) {
    ReceiverPacket packet;
    for (std::size_t l = 0; l < packet_size; ++l) packet.set(l, receivers[std::min(l, receivers.size() - 1)]);
    return packet;
}

float largest_of(const Lanes& values) {
    float result = values[0];
    for (const float v : values) result = std::max(result, v);
    return result;
}

float squared_distance(const Bounds3& a, const Bounds3& b) {
    const Vec3 gap = glm::max(glm::max(a.lower - b.upper, b.lower - a.upper), Vec3(0.0f));
    return glm::dot(gap, gap);
}

/// Adds what a pixel's patch sends to a packet, or the halves of it where it appears too large.
template <class Real>
class PatchSum {
  public:
    PatchSum(const ResidualSum& sum, const RefinementRules& rules, const ReceiverPacket& packet)
        : sum_(sum), rules_(rules), packet_(packet) {}

    void add(std::size_t pixel, SumCounts& counts) {
        const SurfaceNode& node = sum_.surfaces.levels()[0].nodes[pixel];
        const float g = largest(node);
        if (g <= sum_.bound) return;
        const Rgb radiance = sum_.light.power(0, pixel) / node.area;
        if (g * node.area <= rules_.projected_angle || rules_.splits == 0) return add(node, radiance, counts);
        add_halves(sum_.surfaces.patches()[pixel], radiance, rules_.splits - 1, counts);
    }
    void add(const SurfaceNode& node, const Rgb& radiance, SumCounts& counts) {
        residual_of(packet_, node, sum_.bound, lanes_);
        sums.add(lanes_, node.area * radiance, node.area);  // G_r A_i L_i of Engelhardt 2013, Eq. 11.5
        ++counts.samples;
    }

    PacketSums<Real> sums;

  private:
    float largest(const SurfaceNode& node) {
        largest_geometry_term(packet_, node, false, lanes_);
        return largest_of(lanes_);
    }
    void add_halves(PixelPatch patch, const Rgb& radiance, int splits, SumCounts& counts) {
        Vec3& side = glm::dot(patch.a, patch.a) > glm::dot(patch.b, patch.b) ? patch.a : patch.b;
        side *= 0.5f, patch.area *= 0.5f;
        const Vec3 centre = patch.centre, to_half = side;
        for (const float sign : {-1.0f, 1.0f}) {
            patch.centre = centre + sign * to_half;
            const SurfaceNode half = patch_node(patch);
            ++counts.visits;
            if (splits > 0 && largest(half) * half.area > rules_.projected_angle)
                add_halves(patch, radiance, splits - 1, counts);
            else
                add(half, radiance, counts);
        }
    }

    const ResidualSum& sum_;
    const RefinementRules& rules_;
    const ReceiverPacket& packet_;
    Lanes lanes_;
};

struct NodeReference {
    std::int32_t level, x, y;
};

/// Walks the pyramid from its top for one packet, depth first in a fixed order.
class Traversal {
  public:
    Traversal(const ResidualSum& sum, const RefinementRules& rules, const ReceiverPacket& packet)
        : levels_(sum.surfaces.levels()),
          light_(sum.light),
          rules_(rules),
          packet_(packet),
          bound_(sum.bound),
          radius_squared_(1.0f / sum.bound),  // r = b^(-1/2), Sec. 11.2.1
          patches_(sum, rules, packet) {}

    PacketSums<float> run(SumCounts& counts) {
        push(int(levels_.size()) - 1, 0, 0);
        while (size_ > 0) {
            const NodeReference at = stack_[--size_];
            const std::size_t index = level(at).index(at.x, at.y);
            const SurfaceNode& node = level(at).nodes[index];
            if (node.area == 0.0f) continue;
            ++counts.visits;
            if (squared_distance(node.bounds, packet_.bounds) > radius_squared_) continue;
            if (at.level == 0) {
                patches_.add(index, counts);
                continue;
            }
            switch (decide(at, node, level(at).discontinuity[index] != 0)) {
                case Decision::skip:
                    break;
                case Decision::refine:
                    push_children(at);
                    break;
                case Decision::sum:
                    patches_.add(node, light_.power(at.level, index) / node.area, counts);
            }
        }
        return patches_.sums;
    }

  private:
    enum class Decision : std::uint8_t { skip, refine, sum };

    Decision decide(const NodeReference& at, const SurfaceNode& node, bool discontinuity) {
        if (rules_.estimate == RefinementRules::Estimate::at_most)
            largest_geometry_term(packet_, node, discontinuity, lanes_);
        else
            residual_of(packet_, node, 0.0f, lanes_);
        const float g = largest_of(lanes_);
        if (rules_.estimate == RefinementRules::Estimate::at_most && g <= bound_) return Decision::skip;
        // Sec. 11.2.2, criteria 1 and 2: the projected solid angle, less of it across a discontinuity.
        const float limit = discontinuity ? rules_.discontinuity_projected_angle : rules_.projected_angle;
        return at.level >= rules_.levels || g * node.area > limit ? Decision::refine : Decision::sum;
    }
    const SurfacePyramid::Level& level(const NodeReference& at) const {
        return levels_[std::size_t(at.level)];
    }
    void push(int level, int x, int y) { stack_[size_++] = {level, x, y}; }
    void push_children(const NodeReference& at) {
        const SurfacePyramid::Level& below = levels_[std::size_t(at.level - 1)];
        for (int y = 2 * at.y; y < std::min(2 * at.y + 2, below.height); ++y)
            for (int x = 2 * at.x; x < std::min(2 * at.x + 2, below.width); ++x) push(at.level - 1, x, y);
    }

    const std::vector<SurfacePyramid::Level>& levels_;
    const LightPyramid& light_;
    const RefinementRules& rules_;
    const ReceiverPacket& packet_;
    const float bound_, radius_squared_;
    std::array<NodeReference, 3 * 32 + 1> stack_;  // three nodes wait on each of at most 32 levels
    std::size_t size_ = 0;
    Lanes lanes_;
    PatchSum<float> patches_;
};

PacketSums<double> flat_sums(const ResidualSum& sum, const RefinementRules& rules,
                             const ReceiverPacket& packet, SumCounts& counts) {
    PatchSum<double> patches(sum, rules, packet);
    const std::vector<SurfaceNode>& pixels = sum.surfaces.levels()[0].nodes;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (pixels[i].area == 0.0f) continue;
        ++counts.visits;
        patches.add(i, counts);
    }
    return patches.sums;
}

/// Calls `sums_of(packet, counts)` for packets of receivers, in parallel. What is counted are whole numbers:
/// the order does not matter.
template <class SumsOf>
SumCounts for_packets(std::span<const SsbcReceiver> receivers, std::span<Rgb> irradiance,
                      core::CancelToken cancelled, const SumsOf& sums_of) {
    const std::size_t packets = (receivers.size() + packet_size - 1) / packet_size;
    const auto one = [&](std::size_t first) {
        cancelled.check();
        const std::size_t n = std::min(packet_size, receivers.size() - first);
        SumCounts counts;
        const ReceiverPacket packet = make_packet(receivers.subspan(first, n));
        const auto sums = sums_of(packet, counts);
        counts = {n, n * counts.samples, n * counts.visits, 0};  // so far counted once for the packet
        counts.limited = sums.store(irradiance.subspan(first, n));
        return counts;
    };
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, packets, 8), SumCounts{},
        [&](const tbb::blocked_range<std::size_t>& range, SumCounts counts) {
            for (std::size_t p = range.begin(); p < range.end(); ++p) counts += one(p * packet_size);
            return counts;
        },
        [](SumCounts a, const SumCounts& b) { return a += b, a; });
}

}  // namespace

void SumCounts::operator+=(const SumCounts& other) {
    receivers += other.receivers, samples += other.samples;
    visits += other.visits, limited += other.limited;
}

SumCounts ResidualSum::flat(const RefinementRules& rules, std::span<const SsbcReceiver> receivers,
                            std::span<Rgb> irradiance) const {
    return for_packets(receivers, irradiance, rules.cancelled,
                       [&](const ReceiverPacket& packet, SumCounts& counts) {
                           return flat_sums(*this, rules, packet, counts);
                       });
}

SumCounts ResidualSum::hierarchical(const RefinementRules& rules, std::span<const SsbcReceiver> receivers,
                                    std::span<Rgb> irradiance) const {
    return for_packets(receivers, irradiance, rules.cancelled,
                       [&](const ReceiverPacket& packet, SumCounts& counts) {
                           return Traversal(*this, rules, packet).run(counts);
                       });
}

}  // namespace mote::screenspace
