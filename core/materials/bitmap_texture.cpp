// Texture "bitmap": a picture over the unit square, bilinear or nearest, repeated, mirrored or clamped.
#include <algorithm>

#include "core/materials/pictured_texture.h"
#include "core/materials/textures.h"
#include "core/materials/uv_transform.h"
#include "core/objects/error.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

/// The coordinate brought into [0, 1]. Coordinates that are not finite count as 0.
float wrap_coordinate(double x, TextureWrap wrap) {
    if (!std::isfinite(x)) return 0.0f;
    if (wrap == TextureWrap::clamp) return float(std::clamp(x, 0.0, 1.0));
    if (wrap == TextureWrap::repeat) return float(x - std::floor(x));
    const double t = x - 2.0 * std::floor(0.5 * x);
    return float(t > 1.0 ? 2.0 - t : t);
}

class BitmapTexture final : public Texture, public PicturedTexture {
  public:
    BitmapTexture(Bitmap bitmap, const BitmapTextureParameters& parameters)
        : bitmap_(std::move(bitmap)), parameters_(parameters), to_uv_(parameters.to_uv) {
        const auto size = std::size_t(bitmap_.width) * std::size_t(bitmap_.height);
        if (bitmap_.width < 1 || bitmap_.height < 1 || bitmap_.pixels.size() != size)
            throw InputError("texture '" + printable(parameters_.name, 300) + "' holds no pixels");
        summarise();
    }

    Rgb eval(const TextureCoordinates& uv) const override {
        const glm::dvec2 p = to_uv_(uv);
        const float u = wrap_coordinate(p.x, parameters_.wrap), v = wrap_coordinate(p.y, parameters_.wrap);
        if (parameters_.filter == TextureFilter::nearest)
            return texel(std::min(int(u * float(bitmap_.width)), bitmap_.width - 1),
                         std::min(int(v * float(bitmap_.height)), bitmap_.height - 1));
        const float x = u * float(bitmap_.width) - 0.5f, y = v * float(bitmap_.height) - 0.5f;
        const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
        const int i0 = neighbour(int(x0), bitmap_.width), i1 = neighbour(int(x0) + 1, bitmap_.width);
        const int j0 = neighbour(int(y0), bitmap_.height), j1 = neighbour(int(y0) + 1, bitmap_.height);
        return (1.0f - fy) * ((1.0f - fx) * texel(i0, j0) + fx * texel(i1, j0)) +
               fy * ((1.0f - fx) * texel(i0, j1) + fx * texel(i1, j1));
    }
    /// Gradient of the bilinear patch; nearest texels are flat.
    Vec2 scalar_gradient(const TextureCoordinates& uv) const override {
        if (parameters_.filter == TextureFilter::nearest) return {0.0f, 0.0f};
        const glm::dvec2 p = to_uv_(uv);
        const float x = wrap_coordinate(p.x, parameters_.wrap) * float(bitmap_.width) - 0.5f,
                    y = wrap_coordinate(p.y, parameters_.wrap) * float(bitmap_.height) - 0.5f;
        const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
        const int i0 = neighbour(int(x0), bitmap_.width), i1 = neighbour(int(x0) + 1, bitmap_.width);
        const int j0 = neighbour(int(y0), bitmap_.height), j1 = neighbour(int(y0) + 1, bitmap_.height);
        const float h00 = luminance(texel(i0, j0)), h10 = luminance(texel(i1, j0)),
                    h01 = luminance(texel(i0, j1)), h11 = luminance(texel(i1, j1));
        const glm::dvec2 slope((1.0f - fy) * (h10 - h00) + fy * (h11 - h01),
                               (1.0f - fx) * (h01 - h00) + fx * (h11 - h10));
        return Vec2(to_uv_.gradient(slope * glm::dvec2(bitmap_.width, bitmap_.height) *
                                    glm::dvec2(reflected(p.x), reflected(p.y))));
    }
    Rgb mean() const override { return mean_; }
    float maximum() const override { return maximum_; }
    float minimum() const override { return minimum_; }
    glm::ivec2 resolution() const override { return {bitmap_.width, bitmap_.height}; }
    bool constant() const override { return constant_; }
    std::string file() const override { return parameters_.name; }

  private:
    /// -1 where mirroring turns the picture over.
    double reflected(double x) const {
        return parameters_.wrap == TextureWrap::mirror && x - 2.0 * std::floor(0.5 * x) > 1.0 ? -1.0 : 1.0;
    }
    const Rgb& texel(int x, int y) const {
        return bitmap_.pixels[std::size_t(y) * std::size_t(bitmap_.width) + std::size_t(x)];
    }
    /// Index -1 or n, one beyond the border: the other end when repeated, else the border itself (the mirror
    /// image of the texel beyond is the border's own).
    int neighbour(int i, int n) const {
        if (parameters_.wrap == TextureWrap::repeat) return i < 0 ? i + n : (i >= n ? i - n : i);
        return std::clamp(i, 0, n - 1);
    }

    void summarise() {
        Vec3d sum(0.0);
        for (std::size_t i = 0; i < bitmap_.pixels.size(); ++i) {
            const Rgb& c = bitmap_.pixels[i];
            if (!is_finite(c)) refuse(i);
            sum += Vec3d(c);
            maximum_ = std::max(maximum_, max_component(c));
            minimum_ = std::min(minimum_, min_component(c));
            constant_ = constant_ && c == bitmap_.pixels.front();
        }
        mean_ = Rgb(sum / double(bitmap_.pixels.size()));
    }
    [[noreturn]] void refuse(std::size_t first) const {
        const auto count = std::count_if(bitmap_.pixels.begin(), bitmap_.pixels.end(),
                                         [](const Rgb& c) { return !is_finite(c); });
        const auto width = std::size_t(bitmap_.width);
        throw InputError("texture '" + printable(parameters_.name, 300) + "' has " + std::to_string(count) +
                         " pixels that are not finite, the first at (" + std::to_string(first % width) +
                         ", " + std::to_string(first / width) + ")");
    }

    Bitmap bitmap_;
    BitmapTextureParameters parameters_;
    UvTransform to_uv_;
    Rgb mean_{0.0f};
    float maximum_ = -infinity, minimum_ = infinity;
    bool constant_ = true;
};

}  // namespace

std::shared_ptr<Texture> make_bitmap_texture(Bitmap bitmap, const BitmapTextureParameters& parameters) {
    return std::make_shared<BitmapTexture>(std::move(bitmap), parameters);
}

}  // namespace mote::core
