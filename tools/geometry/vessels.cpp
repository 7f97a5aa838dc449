#include "tools/geometry/vessels.h"

namespace mote::tools {

using core::pi;

float pot_soil() { return 0.68f; }

Soup make_pot(float detail) {
    Soup soup;
    const int curve = segments(12, detail, 4), around = segments(24, detail, 6);
    std::vector<Vec2> profile{{0.0f, 0.0f}, {0.24f, 0.0f}, {0.26f, 0.05f}, {0.22f, 0.08f}};
    for (int i = 0; i <= curve; ++i) {
        const float t = float(i) / float(curve);
        profile.emplace_back(0.2f + 0.2f * std::sin(pi * (0.08f + 0.72f * t)) + 0.012f * std::cos(28.0f * t),
                             0.08f + 0.6f * t);
    }
    for (const Vec2& p :
         {Vec2(0.33f, 0.7f), Vec2(0.42f, 0.72f), Vec2(0.43f, 0.79f), Vec2(0.4f, 0.8f), Vec2(0.34f, 0.78f)})
        profile.push_back(p);
    profile.emplace_back(0.3f, pot_soil()), profile.emplace_back(0.0f, pot_soil());
    soup.lathe({}, profile, around);
    return soup;
}

Soup make_rod(const Vec3& a, const Vec3& b, float radius) {
    Soup soup;
    const Vec3 along = glm::normalize(b - a);
    const Vec3 side =
        std::fabs(along.y) < 0.9f ? glm::normalize(glm::cross(along, Vec3(0, 1, 0))) : Vec3(1, 0, 0);
    const Vec3 up = glm::cross(side, along);
    constexpr int sides = 8;
    const auto rim = [&](int i) {
        const float angle = 2.0f * pi * float(i % sides) / sides;
        return radius * (std::cos(angle) * side - std::sin(angle) * up);
    };
    for (int i = 0; i < sides; ++i) soup.quad(a + rim(i), a + rim(i + 1), b + rim(i + 1), b + rim(i));
    return soup;
}

namespace {

/// A bowl on a stem: outer side, rim, inner side; the water stands a little under the rim.
void add_bowl(Parts& parts, const Vec3& foot, float stem, float radius, float height, int around,
              float detail) {
    const int curve = segments(12, detail, 3);
    std::vector<Vec2> profile;
    for (int i = 0; i <= curve; ++i) {
        const float t = float(i) / float(curve);
        profile.emplace_back(stem * (0.75f + 0.5f * core::sqr(2.0f * t - 1.0f) + 0.12f * std::cos(18.0f * t)),
                             height * 0.7f * t);
    }
    for (int i = 1; i <= curve; ++i) {
        const float t = float(i) / float(curve);
        profile.emplace_back(stem + (radius - stem) * std::sin(0.5f * pi * t),
                             height * (0.7f + 0.3f * (1.0f - std::cos(0.5f * pi * t))));
    }
    profile.emplace_back(0.93f * radius, 1.01f * height),
        profile.emplace_back(0.88f * radius, 0.95f * height);
    parts["marble"].lathe(foot, profile, around);
    parts["water"].lathe(foot, {{0.89f * radius, 0.955f * height}, {0.0f, 0.955f * height}}, around);
}

}  // namespace

void add_fountain(Parts& parts, const Vec3& foot, float detail) {
    // Eight sides below, round above.
    parts["marble"].lathe(foot,
                          {{2.1f, -0.02f},
                           {2.1f, 0.16f},
                           {1.8f, 0.16f},
                           {1.72f, 0.22f},
                           {1.72f, 0.55f},
                           {1.82f, 0.6f},
                           {1.82f, 0.7f},
                           {1.5f, 0.7f},
                           {1.5f, 0.3f},
                           {0.0f, 0.3f}},
                          8);
    parts["water"].lathe(foot, {{1.51f, 0.6f}, {0.0f, 0.6f}}, 8);
    const int around = segments(40, detail, 6);
    add_bowl(parts, foot + Vec3(0, 0.3f, 0), 0.24f, 1.05f, 1.35f, around, detail);
    add_bowl(parts, foot + Vec3(0, 1.55f, 0), 0.13f, 0.55f, 0.9f, around, detail);
    parts["bronze"].lathe(foot + Vec3(0, 2.36f, 0),
                          {{0.0f, 0.0f},
                           {0.06f, 0.02f},
                           {0.05f, 0.1f},
                           {0.11f, 0.22f},
                           {0.12f, 0.3f},
                           {0.07f, 0.4f},
                           {0.02f, 0.5f},
                           {0.0f, 0.55f}},
                          around);
}

void add_lantern(Parts& parts, const Vec3& hook, float drop, float detail) {
    const Vec3 foot = hook - Vec3(0, drop, 0);
    const int around = segments(12, detail, 6);
    Soup& bronze = parts["bronze"];
    bronze.add(make_rod(hook, foot + Vec3(0, 0.6f, 0), 0.012f), {});
    bronze.lathe(foot, {{0.0f, -0.08f}, {0.05f, 0.0f}, {0.14f, 0.03f}, {0.14f, 0.06f}, {0.0f, 0.06f}},
                 around);
    bronze.lathe(foot, {{0.0f, 0.45f}, {0.19f, 0.45f}, {0.12f, 0.55f}, {0.03f, 0.62f}, {0.0f, 0.66f}},
                 around);
    for (int i = 0; i < 6; ++i) {
        const float angle = 2.0f * pi * float(i) / 6.0f;
        const Vec3 out(std::cos(angle), 0, std::sin(angle));
        bronze.add(
            make_rod(foot + 0.13f * out + Vec3(0, 0.05f, 0), foot + 0.17f * out + Vec3(0, 0.46f, 0), 0.01f),
            {});
    }
    parts["glow"].lathe(foot, {{0.0f, 0.1f}, {0.06f, 0.14f}, {0.08f, 0.22f}, {0.05f, 0.32f}, {0.0f, 0.36f}},
                        around);
}

}  // namespace mote::tools
