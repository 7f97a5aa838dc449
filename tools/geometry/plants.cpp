#include "tools/geometry/plants.h"

#include <algorithm>

#include "core/math/frame.h"
#include "core/math/warp.h"

namespace mote::tools {
namespace {

using core::lerp;
using core::pi;
using core::Rng;

Vec3 across(const Vec3& direction) {
    const Vec3 side = glm::cross(direction, Vec3(0.0f, 1.0f, 0.0f));
    const float length = glm::length(side);
    return length > 1e-3f ? side / length : Vec3(1.0f, 0.0f, 0.0f);
}

/// A tapered tube of five sides.
void add_limb(Soup& soup, const Vec3& a, const Vec3& b, float radius_a, float radius_b) {
    const Vec3 along = glm::normalize(b - a), s = across(along), t = glm::cross(along, s);
    constexpr int sides = 5;
    for (int i = 0; i < sides; ++i) {
        const float angle0 = 2.0f * pi * float(i) / sides,
                    angle1 = 2.0f * pi * float((i + 1) % sides) / sides;
        const Vec3 d0 = std::cos(angle0) * s + std::sin(angle0) * t;
        const Vec3 d1 = std::cos(angle1) * s + std::sin(angle1) * t;
        soup.quad(a + radius_a * d0, a + radius_a * d1, b + radius_b * d1, b + radius_b * d0);
    }
}

struct Grower {
    const Tree& tree;
    Rng& rng;
    Parts& parts;

    void twig(const Vec3& a, const Vec3& b) {
        for (int i = 0; i < tree.leaves_a_twig; ++i) {
            const Vec3 out =
                glm::normalize(random_direction(rng) + Vec3(0.0f, 0.3f, 0.0f) + 0.4f * glm::normalize(b - a));
            const float size = tree.leaf * (0.7f + 0.6f * rng.next_float());
            add_leaf(parts["leaves"], {glm::mix(a, b, rng.next_float()), out, size, 0.5f * size, 0.25f});
        }
    }
    void branch(const Vec3& from, const Vec3& direction, float length, float radius, int level) {
        // Two bends, so that no limb is a straight stick.
        const Vec3 bent = glm::normalize(direction + 0.22f * random_direction(rng));
        const Vec3 middle = from + 0.5f * length * direction, to = middle + 0.5f * length * bent;
        Soup& bark = parts["bark"];
        add_limb(bark, from, middle, radius, 0.85f * radius);
        add_limb(bark, middle, to, 0.85f * radius, 0.7f * radius);
        if (level + 2 >= tree.levels) twig(from, to);
        if (level + 1 == tree.levels) return;
        const int forks = level == 0 ? 4 : 2 + int(rng.next_float() < 0.5f);
        const float start = 2.0f * pi * rng.next_float();
        const Vec3 s = across(bent), t = glm::cross(bent, s);
        for (int i = 0; i < forks; ++i) {
            const float angle = start + 2.0f * pi * (float(i) + 0.4f * rng.next_float()) / float(forks);
            const float spread = 0.45f + 0.35f * rng.next_float();
            const Vec3 out = std::cos(angle) * s + std::sin(angle) * t;
            const Vec3 next = glm::normalize(bent + spread * out + Vec3(0.0f, 0.08f, 0.0f));
            branch(to, next, length * (0.68f + 0.16f * rng.next_float()), 0.66f * radius, level + 1);
        }
    }
};

}  // namespace

Vec3 random_direction(Rng& rng) {
    const float z = 1.0f - 2.0f * rng.next_float(), angle = 2.0f * pi * rng.next_float();
    const float r = core::safe_sqrt(1.0f - z * z);
    return {r * std::cos(angle), z, r * std::sin(angle)};
}

void add_leaf(Soup& soup, const Leaf& leaf) {
    const Vec3 side = across(leaf.direction), up = glm::cross(side, leaf.direction);
    const auto spine = [&](float t) {
        return leaf.base + leaf.length * (t * leaf.direction - Vec3(0.0f, leaf.droop * t * t, 0.0f));
    };
    const auto half_width = [&](float t) {
        return 0.5f * leaf.width * std::sin(pi * std::pow(t, 0.7f)) + 1e-3f * leaf.width;
    };
    const int steps = leaf.joints + 1;
    for (int i = 0; i < steps; ++i) {
        const float t0 = float(i) / float(steps), t1 = float(i + 1) / float(steps);
        for (const float sign : {-1.0f, 1.0f}) {
            const auto edge = [&](float t) { return spine(t) + half_width(t) * (sign * side + 0.35f * up); };
            const Vec3 a = spine(t0), b = edge(t0), c = edge(t1), d = spine(t1);
            const auto face = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
                sign > 0.0f ? soup.triangle(p, q, r) : soup.triangle(p, r, q);
            };
            if (i > 0) face(a, b, i + 1 < steps ? c : d);
            if (i + 1 < steps) face(a, c, d);
        }
    }
}

Soup make_tuft(float height, int blades, Rng& rng, float detail) {
    Soup soup;
    for (int i = 0; i < blades; ++i) {
        const float lean = 0.15f + 1.1f * float(i) / float(blades),
                    angle = 2.4f * float(i) + 0.3f * rng.next_float();
        const Vec3 direction(std::sin(lean) * std::cos(angle), std::cos(lean),
                             std::sin(lean) * std::sin(angle));
        const float length = height * (0.8f + 0.3f * rng.next_float());
        add_leaf(soup, {0.03f * height * direction, direction, length, 0.11f * height, 0.15f + 0.45f * lean,
                        segments(6, detail, 1)});
    }
    return soup;
}

Soup make_bush(float radius, float height, int leaves, Rng& rng) {
    Soup soup;
    for (int i = 0; i < leaves; ++i) {
        // Mostly near the surface, where there is light.
        const Vec3 at = random_direction(rng) * std::pow(rng.next_float(), 0.2f);
        const Vec3 out = glm::normalize(at + 0.7f * random_direction(rng) + Vec3(0.0f, 0.2f, 0.0f));
        const float size = (3.6f + 2.2f * rng.next_float()) * radius / std::sqrt(float(leaves));
        add_leaf(soup,
                 {Vec3(at.x * radius, 0.5f * height * (1.0f + at.y), at.z * radius), out, size, 0.5f * size});
    }
    return soup;
}

void add_vines(Soup& soup, const Vec3& a, const Vec3& b, float length, int stems, int leaves, Rng& rng) {
    for (int i = 0; i < stems; ++i) {
        Vec3 at = glm::mix(a, b, rng.next_float());
        const float reach = length * (0.35f + 0.65f * rng.next_float()), step = reach / float(leaves);
        const float sway = 6.0f * rng.next_float(), swing = 2.0f * pi * rng.next_float();
        for (int k = 0; k < leaves; ++k) {
            const float t = float(k) / float(leaves);
            at += step * Vec3(0.35f * std::cos(sway * t + swing), -1.0f, 0.35f * std::sin(sway * t + swing));
            Vec3 out = random_direction(rng);
            out = glm::normalize(out + Vec3(0.0f, -0.5f, 0.0f));
            const float size = 0.14f * (1.1f - 0.5f * t) * (0.7f + 0.6f * rng.next_float());
            add_leaf(soup, {at, out, size, 0.75f * size, 0.3f});
        }
    }
}

Parts make_tree(const Tree& tree, Rng& rng) {
    Parts parts;
    Grower{tree, rng, parts}.branch({}, glm::normalize(Vec3(0.04f, 1.0f, 0.02f)), 0.28f * tree.height,
                                    0.032f * tree.height, 0);
    return parts;
}

}  // namespace mote::tools
