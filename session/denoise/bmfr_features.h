// Layers of a picture as features of regressions and of reprojection.
#pragma once

#include <memory>

#include "core/film/image_channels.h"
#include "screenspace/denoising/sequence_denoiser.h"

namespace mote::session {

/// Owns what the features of a frame refer to. The picture must outlive it.
class BmfrFeatures {
  public:
    explicit BmfrFeatures(const core::ImageChannels& image);
    BmfrFeatures(const BmfrFeatures&) = delete;
    BmfrFeatures& operator=(const BmfrFeatures&) = delete;

    std::vector<screenspace::FeaturePlane> of_surfaces() const;  ///< Ns (else N), P and its squares
    /// The place and its squares, and in-scattered light where it is known, else Depth and Transmittance.
    std::vector<screenspace::FeaturePlane> of_media() const;
    std::span<const core::Rgb> albedo() const { return albedo_; }
    std::span<const core::Vec3> position() const { return position_; }
    std::span<const core::Vec3> normal() const { return normal_; }
    std::span<const core::Vec2> motion() const { return motion_; }  ///< not finite where nothing was hit
    std::span<const core::Vec3> previous_position() const { return previous_position_; }
    std::span<const std::uint32_t> id() const { return id_; }
    std::string said() const;  ///< ", with Albedo, Ns and P"

  private:
    std::vector<float> plane(const std::string& channel) const;

    const core::ImageChannels& image_;
    std::string normals_;  ///< name of the layer
    std::vector<core::Rgb> albedo_;
    std::vector<core::Vec3> position_, normal_, previous_position_;
    std::vector<core::Vec2> motion_;
    std::vector<std::uint32_t> id_;
    /// Normal and position, as far as they are known; and of what mirrors show.
    std::vector<std::vector<float>> surface_planes_, mirrored_planes_;
    std::vector<float> column_, row_, nearness_, transmittance_, in_scattered_;
};

}  // namespace mote::session
