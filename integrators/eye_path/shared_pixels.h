// A pass whose light is gathered at a lattice of the pixels alone, and between them found by what neighbours
// see (screenspace/upsampling): the points that every pixel sees, and the pixels to render again.
#pragma once

#include <array>
#include <vector>

#include "core/scene/scene.h"
#include "integrators/eye_path/eye_path.h"
#include "screenspace/upsampling/upsampling.h"

namespace mote::integrators {

/// Points that the first segment of a pixel's eye path meets. Their modulations hold the weight of its
/// receivers.
struct SeenPixel {
    screenspace::UpsamplingPoint surface, volume;

    /// For light from farther along the path, which no neighbour shares.
    void share_nothing() {
        surface.shared = volume.shared = false;
        surface.modulation = volume.modulation = core::Rgb(1.0f);
    }
};

/// The place and footprint of the vertex at the end of the first segment, without modulations. `film` is the
/// place of the ray in the picture [pixels].
template <bool Media>
SeenPixel see_first_segment(const core::Scene& scene, const EyePath<Media>& path, const core::Vec2& film) {
    const core::ScatteringVertex& v = path.vertex();
    SeenPixel seen;
    if (!v.on_surface()) {
        seen.share_nothing();
        return seen;
    }
    const bool front = glm::dot(v.hit.geometric_normal, v.wo) > 0.0f;
    screenspace::UpsamplingPoint& p = seen.surface;
    p.position = v.position;
    p.normal = front ? v.hit.geometric_normal : -v.hit.geometric_normal;
    p.shading_normal = front ? v.hit.shading.n : -v.hit.shading.n;
    p.distance = path.segment_length(), p.transmittance = core::average(path.throughput());
    const auto at = [&](float x, float y) {
        return scene.camera().sample_ray(film + core::Vec2(x, y), core::Vec2(0.5f)).at(p.distance);
    };
    p.footprint = std::fmax(glm::distance(at(1, 0), at(0, 0)), glm::distance(at(0, 1), at(0, 0)));
    seen.volume = p;
    return seen;
}

/// The weight of a receiver at the path's vertex, where that is the first.
template <bool Media>
void see_receiver(SeenPixel& seen, const EyePath<Media>& path) {
    if (path.depth() > 1 || !path.vertex().on_surface()) return;
    screenspace::UpsamplingPoint& surface = seen.surface;
    const auto reflectance = path.vertex().diffuse_reflectance();
    surface.shared = reflectance.has_value();
    surface.modulation = path.throughput() * reflectance.value_or(core::Rgb(1.0f));
    if (reflectance && !(glm::dot(surface.shading_normal, path.vertex().wo) > 0.0f))
        surface.modulation = core::Rgb(0.0f);  // as ReceiverTile::set() has it
}

class SharedPixels {
  public:
    SharedPixels(int width, int height, const screenspace::ShadedLattice& lattice)
        : width_(width), height_(height), lattice_(lattice) {
        surfaces_.resize(std::size_t(width) * std::size_t(height)), volumes_.resize(surfaces_.size());
    }
    const screenspace::ShadedLattice& lattice() const { return lattice_; }
    /// Pixels may be set by many threads, each by one.
    void set(int x, int y, const SeenPixel& seen) {
        const auto pixel = std::size_t(y) * std::size_t(width_) + std::size_t(x);
        surfaces_[pixel] = seen.surface, volumes_[pixel] = seen.volume;
    }
    /// After all are set: pixels that are to be rendered with their own VPLs, in ascending order.
    std::vector<std::uint32_t> again() const;
    /// Sets light from surfaces, or from media, at the pixels between.
    void fill(screenspace::LayerKind kind, std::span<core::Rgb> light) const;

  private:
    screenspace::Upsampling upsampling(screenspace::LayerKind kind) const {
        return {width_, height_, lattice_, kind,
                kind == screenspace::LayerKind::surface ? surfaces_ : volumes_};
    }
    int width_, height_;
    screenspace::ShadedLattice lattice_;
    std::vector<screenspace::UpsamplingPoint> surfaces_, volumes_;
};

}  // namespace mote::integrators
