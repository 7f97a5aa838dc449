#include "tools/geometry/rotunda.h"

#include "core/math/random.h"
#include "tools/geometry/masonry.h"

namespace mote::tools {
namespace {

/// Stones between two radii and two heights, each a little apart from the next.
void add_ring(Soup& soup, float inner, float outer, float bottom, float top, int stones, float gap) {
    for (int i = 0; i < stones; ++i) {
        const float step = 2.0f * core::pi / float(stones);
        std::array<Vec3, 8> corners;
        for (int c = 0; c < 8; ++c) {
            // Axes: inwards, up, counter-clockwise from above.
            const float r = c & 1 ? inner : outer, edge = c & 4 ? 1.0f - gap : gap;
            const float angle = step * (float(i) + edge);
            corners[c] = {r * std::cos(angle), c & 2 ? top : bottom, -r * std::sin(angle)};
        }
        soup.hexahedron(corners);
    }
}

}  // namespace

Parts make_rotunda(float detail, std::uint64_t /*seed*/) {
    constexpr int columns = 16;
    constexpr float radius = 13.0f, height = 9.0f;
    Parts parts;
    const Soup column = make_column({height, 0.6f, 1.75f, 0.0f}, 1.6f * detail);
    for (int i = 0; i < columns; ++i) {
        const float angle = 2.0f * core::pi * (float(i) + 0.5f) / columns;
        parts["marble"].add(column, {{radius * std::cos(angle), 0.0f, -radius * std::sin(angle)}, angle});
    }
    // Beams from column to column, in three steps, with teeth under the upper one.
    add_ring(parts["stone"], radius - 0.8f, radius + 0.8f, height, height + 0.9f, 4 * columns, 0.004f);
    add_ring(parts["stone"], radius - 0.7f, radius + 0.7f, height + 0.9f, height + 1.7f, 4 * columns, 0.0f);
    add_ring(parts["stone"], radius - 0.95f, radius + 0.95f, height + 1.7f, height + 2.0f, 10 * columns,
             0.22f);
    add_ring(parts["stone"], radius - 1.2f, radius + 1.2f, height + 2.0f, height + 2.5f, 4 * columns, 0.0f);
    // Floor in rings of alternating stones, steps outside.
    for (int i = 0; i < 8; ++i) {
        const float inner = 2.9f + 1.5f * float(i);
        add_ring(parts[i % 2 ? "red" : "wall"], inner + 0.02f, inner + 1.5f, -0.4f, 0.0f, 16 + 8 * i, 0.01f);
    }
    for (int i = 0; i < 3; ++i)
        add_ring(parts["stone"], 14.5f, 15.4f + 0.7f * float(i), -0.4f * float(i + 1), -0.4f * float(i),
                 4 * columns, 0.003f);
    parts["stone"].lathe({0, -1.4f, 0}, {{40.0f, 0.0f}, {0.0f, 0.0f}}, 64);
    parts["dark"].lathe({0, -0.03f, 0}, {{14.6f, -0.5f}, {14.6f, 0.0f}, {0.0f, 0.0f}}, 64);
    // The pedestal.
    const std::vector<Vec2> mouldings{{2.8f, 0.0f},  {2.8f, 0.35f}, {2.5f, 0.35f}, {2.5f, 0.55f},
                                      {2.3f, 0.6f},  {2.2f, 0.75f}, {2.0f, 0.8f},  {1.95f, 2.0f},
                                      {2.0f, 2.05f}, {2.1f, 2.2f},  {2.35f, 2.3f}, {2.35f, 2.6f},
                                      {0.0f, 2.6f}};
    parts["marble"].lathe({}, mouldings, segments(64, detail, 8));
    return parts;
}

}  // namespace mote::tools
