#include "session/denoise/bmfr_features.h"

#include <cmath>

#include "session/denoise/beauty_layers.h"
#include "session/in_scattered_feature.h"

namespace mote::session {

using namespace core;
using screenspace::FeaturePlane;

namespace {

std::vector<float> component(std::span<const Vec3> vectors, int c) {
    std::vector<float> result(vectors.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = vectors[i][c];
    return result;
}

/// 1 / (1 + depth / mean): finite for the sky, and even for light that thins out with distance.
std::vector<float> nearness(const std::vector<float>& depth) {
    double sum = 0.0, count = 0.0;
    for (const float d : depth)
        if (std::isfinite(d)) sum += double(d), count += 1.0;
    const float mean = sum > 0.0 ? float(sum / count) : 1.0f;
    std::vector<float> result(depth.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = depth[i] >= 0.0f ? 1.0f / (1.0f + depth[i] / mean) : 0.0f;
    return result;
}

}  // namespace

BmfrFeatures::BmfrFeatures(const ImageChannels& image)
    : image_(image), albedo_(image.rgb("Albedo")), position_(vector_layer(image, "P")) {
    for (const char* name : {"Ns", "N"})
        if (normal_.empty()) normal_ = vector_layer(image, name), normals_ = name;
    if (normal_.empty()) normals_.clear();
    const std::vector<float> coverage = plane("Coverage.Y"), depth = plane("Depth.Z");
    for (std::size_t p = 0; p < position_.size(); ++p)  // a position where nothing was hit is none
        if ((!coverage.empty() && coverage[p] == 0.0f) || (!depth.empty() && !std::isfinite(depth[p])))
            position_[p] = Vec3(infinity);
    for (int c = 0; c < 3 && !normal_.empty(); ++c) surface_planes_.push_back(component(normal_, c));
    for (int c = 0; c < 3 && !position_.empty(); ++c) surface_planes_.push_back(component(position_, c));
    // Reflections in mirrors, in their blocks: it does not vary, and takes no part, in others.
    for (const std::vector<Vec3>& vectors :
         {vector_layer(image, "Mirrored.Ns"), vector_layer(image, "Mirrored.P"), image.rgb("Mirrored.Albedo"),
          image.rgb("Mirrored.Emission")})
        for (int c = 0; c < 3 && !vectors.empty(); ++c) mirrored_planes_.push_back(component(vectors, c));
    const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
    for (std::size_t p = 0; p < pixels; ++p) {
        column_.push_back(float(p % std::size_t(image.width)));
        row_.push_back(float(p / std::size_t(image.width)));
    }
    if (!depth.empty()) nearness_ = nearness(depth);
    for (const Rgb& t : image.rgb("Transmittance"))
        transmittance_.push_back(is_finite(t) ? average(t) : 0.0f);
    for (const Rgb& light : in_scattered(image))
        in_scattered_.push_back(is_finite(light) ? average(light) : 0.0f);
    const std::vector<float> x = plane("MotionVector.X"), y = plane("MotionVector.Y");
    for (std::size_t p = 0; p < x.size() && p < y.size(); ++p) {
        const bool sky = !position_.empty() && !is_finite(position_[p]);
        motion_.push_back(sky ? Vec2(infinity) : Vec2(x[p], y[p]));
    }
    if (!motion_.empty()) previous_position_ = vector_layer(image, "PreviousP");
    for (std::size_t p = 0; p < previous_position_.size() && p < position_.size(); ++p)
        if (!is_finite(position_[p])) previous_position_[p] = position_[p];
    for (const float id : plane("ObjectId.Y")) id_.push_back(id >= 0.0f && id < 4e9f ? std::uint32_t(id) : 0);
}

std::vector<float> BmfrFeatures::plane(const std::string& channel) const {
    const std::vector<float>* values = image_.find(channel);
    return values ? *values : std::vector<float>();
}

std::vector<FeaturePlane> BmfrFeatures::of_surfaces() const {
    if (surface_planes_.empty()) return {{column_, true}, {row_, true}};
    std::vector<FeaturePlane> features;
    const std::size_t normals = normal_.empty() ? 0 : 3;
    for (std::size_t i = 0; i < surface_planes_.size(); ++i)
        features.push_back({surface_planes_[i], i >= normals});
    if (position_.empty()) features.push_back({column_, true}), features.push_back({row_, true});
    for (const std::vector<float>& plane : mirrored_planes_) features.push_back({plane, false});
    return features;
}

std::vector<FeaturePlane> BmfrFeatures::of_media() const {
    std::vector<FeaturePlane> features{{column_, true}, {row_, true}};
    if (!in_scattered_.empty()) {  // the others would add little but noise
        features.push_back({in_scattered_, false});
        return features;
    }
    if (!nearness_.empty()) features.push_back({nearness_, true});
    if (!transmittance_.empty()) features.push_back({transmittance_, true});
    return features;
}

std::string BmfrFeatures::said() const {
    std::vector<std::string> names;
    if (!albedo_.empty()) names.emplace_back("Albedo");
    if (!normals_.empty()) names.push_back(normals_);
    if (!position_.empty()) names.emplace_back("P");
    if (!mirrored_planes_.empty()) names.emplace_back("Mirrored");
    if (!in_scattered_.empty()) names.emplace_back("in-scattered light");
    return names.empty() ? ", without features" : ", with " + joined(names);
}

}  // namespace mote::session
