// Cameras and scenes as text.
#include "session/reference_metadata.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/render/render_driver.h"

namespace mote::session {

namespace {

/// Numbers of a matrix, or nothing when the text is anything else.
std::vector<double> numbers(const std::string& text) {
    std::istringstream stream(text);
    std::vector<double> values;
    for (double v; stream >> v;) values.push_back(v);
    return stream.eof() ? values : std::vector<double>{};
}

}  // namespace

std::string as_lines(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += name + "\n";
    return text;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::string world_to_camera(const core::Camera& camera) {
    // OpenEXR has x to the right, y up, z forward; ours has x to the left. The transpose is written.
    glm::dmat4 flip(1.0);
    flip[0][0] = -1.0;
    const glm::dmat4 m = flip * camera.to_world().inverse().matrix;
    std::string text;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            text += fmt::format("{}{:.9g}", text.empty() ? "" : " ", m[column][row]);
    return text;
}

bool same_camera(const std::string& a, const std::string& b) {
    const std::vector<double> x = numbers(a), y = numbers(b);
    if (x.size() != y.size() || x.empty()) return a == b;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (!(std::fabs(x[i] - y[i]) <= 1e-5 * (1.0 + std::fabs(y[i])))) return false;
    return true;
}

std::vector<core::Rgb> variance_of_beauty(const core::ImageChannels& image) {
    std::vector<core::Rgb> variance = image.rgb("Variance");
    const auto text = image.metadata.find(variance_gain_key);
    if (text == image.metadata.end()) return variance;
    const std::vector<double> gain = numbers(text->second);
    // Files come from anywhere; a gain is at most a little above 1.
    if (gain.size() == 1 && gain[0] >= 0.0 && gain[0] <= 2.0)
        for (core::Rgb& v : variance) v *= float(gain[0]);
    return variance;
}

std::string scene_content(const core::Scene& scene, std::vector<std::string> defines) {
    std::sort(defines.begin(), defines.end());
    return core::content_hash(scene, defines);
}

}  // namespace mote::session
