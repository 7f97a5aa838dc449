#include "session/denoise/frame_camera.h"

#include <cmath>
#include <functional>
#include <glm/gtc/type_ptr.hpp>
#include <sstream>

namespace mote::session {

using namespace core;

namespace {

std::optional<glm::dmat4> world_to_camera(const ImageChannels& image) {
    const auto text = image.metadata.find("worldToCamera");
    if (text == image.metadata.end()) return std::nullopt;
    std::istringstream stream(text->second);
    std::vector<double> m;
    for (double v; stream >> v;) m.push_back(v);
    if (m.size() != 16) return std::nullopt;
    return glm::make_mat4(m.data());  // rows for row vectors are columns for ours
}

/// y = slope x + intercept by least squares.
struct Line {
    double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    void add(double a, double b) { count += 1, x += a, y += b, xx += a * a, xy += a * b, yy += b * b; }
    double slope() const { return (count * xy - x * y) / (count * xx - x * x); }
    double intercept() const { return (y - slope() * x) / count; }
    double mean_square() const {  ///< of what is left
        return (yy - 2 * slope() * xy - 2 * intercept() * y + slope() * slope() * xx +
                2 * slope() * intercept() * x + count * intercept() * intercept()) /
               count;
    }
    bool holds() const { return count >= 8 && mean_square() < 1.0; }
};

}  // namespace

std::optional<screenspace::FrameCamera> frame_camera(const ImageChannels& image,
                                                     std::span<const Vec3> position) {
    const auto to_camera = world_to_camera(image);
    if (!to_camera) return std::nullopt;
    Line perspective[2], parallel[2];
    for (std::size_t p = 0; p < position.size(); ++p) {
        if (!is_finite(position[p])) continue;
        const glm::dvec4 at = *to_camera * glm::dvec4(glm::dvec3(position[p]), 1.0);
        const double pixel[2] = {double(p % std::size_t(image.width)) + 0.5,
                                 double(p / std::size_t(image.width)) + 0.5};
        for (int c = 0; c < 2; ++c) {
            parallel[c].add(at[c], pixel[c]);
            if (at.z > 0.0) perspective[c].add(at[c] / at.z, pixel[c]);
        }
    }
    const bool lens = perspective[0].holds() && perspective[1].holds();
    if (!lens && !(parallel[0].holds() && parallel[1].holds())) return std::nullopt;
    const Line* lines = lens ? perspective : parallel;
    glm::dmat4x3 to_pixels(0.0);
    for (int c = 0; c < 2; ++c) {
        to_pixels[c][c] = lines[c].slope();
        to_pixels[lens ? 2 : 3][c] = lines[c].intercept();
    }
    to_pixels[lens ? 2 : 3][2] = 1.0;
    return screenspace::FrameCamera{to_pixels * *to_camera};
}

}  // namespace mote::session
