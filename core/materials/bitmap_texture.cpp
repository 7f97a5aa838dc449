// Texture "bitmap": a picture over the unit square, bilinear or nearest, repeated, mirrored or clamped.
#include <algorithm>

#include "core/materials/pictured_texture.h"
#include "core/materials/texels.h"
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
    /// The bitmap was checked.
    BitmapTexture(const Bitmap& bitmap, const BitmapTextureParameters& parameters)
        : width_(bitmap.width),
          height_(bitmap.height),
          texel_(bitmap),
          parameters_(parameters),
          to_uv_(parameters.to_uv) {
        summarise(bitmap);
    }

    Rgb eval(const TextureCoordinates& uv) const override {
        const glm::dvec2 p = to_uv_(uv);
        const float u = wrap_coordinate(p.x, parameters_.wrap), v = wrap_coordinate(p.y, parameters_.wrap);
        if (parameters_.filter == TextureFilter::nearest)
            return texel_(std::min(int(u * float(width_)), width_ - 1),
                          std::min(int(v * float(height_)), height_ - 1));
        const float x = u * float(width_) - 0.5f, y = v * float(height_) - 0.5f;
        const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
        const int i0 = neighbour(int(x0), width_), i1 = neighbour(int(x0) + 1, width_);
        const int j0 = neighbour(int(y0), height_), j1 = neighbour(int(y0) + 1, height_);
        return (1.0f - fy) * ((1.0f - fx) * texel_(i0, j0) + fx * texel_(i1, j0)) +
               fy * ((1.0f - fx) * texel_(i0, j1) + fx * texel_(i1, j1));
    }
    /// Gradient of the bilinear patch; nearest texels are flat.
    Vec2 scalar_gradient(const TextureCoordinates& uv) const override {
        if (parameters_.filter == TextureFilter::nearest) return {0.0f, 0.0f};
        const glm::dvec2 p = to_uv_(uv);
        const float x = wrap_coordinate(p.x, parameters_.wrap) * float(width_) - 0.5f,
                    y = wrap_coordinate(p.y, parameters_.wrap) * float(height_) - 0.5f;
        const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
        const int i0 = neighbour(int(x0), width_), i1 = neighbour(int(x0) + 1, width_);
        const int j0 = neighbour(int(y0), height_), j1 = neighbour(int(y0) + 1, height_);
        const float h00 = luminance(texel_(i0, j0)), h10 = luminance(texel_(i1, j0)),
                    h01 = luminance(texel_(i0, j1)), h11 = luminance(texel_(i1, j1));
        const glm::dvec2 slope((1.0f - fy) * (h10 - h00) + fy * (h11 - h01),
                               (1.0f - fx) * (h01 - h00) + fx * (h11 - h10));
        return Vec2(to_uv_.gradient(slope * glm::dvec2(width_, height_) *
                                    glm::dvec2(reflected(p.x), reflected(p.y))));
    }
    Rgb mean() const override { return mean_; }
    float maximum() const override { return maximum_; }
    float minimum() const override { return minimum_; }
    glm::ivec2 resolution() const override { return {width_, height_}; }
    bool constant() const override { return constant_; }
    std::string file() const override { return parameters_.name; }

  private:
    /// -1 where mirroring turns the picture over.
    double reflected(double x) const {
        return parameters_.wrap == TextureWrap::mirror && x - 2.0 * std::floor(0.5 * x) > 1.0 ? -1.0 : 1.0;
    }
    /// Index -1 or n, one beyond the border: the other end when repeated, else the border itself (the mirror
    /// image of the texel beyond is the border's own).
    int neighbour(int i, int n) const {
        if (parameters_.wrap == TextureWrap::repeat) return i < 0 ? i + n : (i >= n ? i - n : i);
        return std::clamp(i, 0, n - 1);
    }

    void summarise(const Bitmap& bitmap) {
        Vec3d sum(0.0);
        for (const Rgb& c : bitmap.pixels) {
            sum += Vec3d(c);
            maximum_ = std::max(maximum_, max_component(c));
            minimum_ = std::min(minimum_, min_component(c));
            constant_ = constant_ && c == bitmap.pixels.front();
        }
        mean_ = Rgb(sum / double(bitmap.pixels.size()));
    }

    int width_, height_;  ///< [texels]
    Texels texel_;
    BitmapTextureParameters parameters_;
    UvTransform to_uv_;
    Rgb mean_{0.0f};
    float maximum_ = -infinity, minimum_ = infinity;
    bool constant_ = true;
};

/// Throws InputError.
void check(const Bitmap& bitmap, const std::string& name) {
    const auto width = std::size_t(bitmap.width);
    if (bitmap.width < 1 || bitmap.height < 1 || bitmap.pixels.size() != width * std::size_t(bitmap.height))
        throw InputError("texture '" + printable(name, 300) + "' holds no pixels");
    const auto bad = [](const Rgb& c) { return !is_finite(c); };
    const auto found = std::ranges::find_if(bitmap.pixels, bad);
    if (found == bitmap.pixels.end()) return;
    const auto first = std::size_t(found - bitmap.pixels.begin());
    throw InputError("texture '" + printable(name, 300) + "' has " +
                     std::to_string(std::ranges::count_if(bitmap.pixels, bad)) +
                     " pixels that are not finite, the first at (" + std::to_string(first % width) + ", " +
                     std::to_string(first / width) + ")");
}

}  // namespace

std::shared_ptr<Texture> make_bitmap_texture(const Bitmap& bitmap,
                                             const BitmapTextureParameters& parameters) {
    check(bitmap, parameters.name);
    return std::make_shared<BitmapTexture>(bitmap, parameters);
}

}  // namespace mote::core
