#include "media/volume_texture.h"

#include "core/materials/textures.h"
#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/volume.h"

namespace mote::media {
namespace {

class VolumeTexture final : public core::Texture {
  public:
    explicit VolumeTexture(std::shared_ptr<const Volume> volume) : volume_(std::move(volume)) {}

    core::Rgb eval(const core::TextureCoordinates& uv) const override { return volume_->eval(uv.position); }
    /// Half of the largest value, since the part that a surface shows is not known here.
    core::Rgb mean() const override { return 0.5f * volume_->upper_bound(); }
    float maximum() const override { return core::max_component(volume_->upper_bound()); }
    float minimum() const override { return 0.0f; }

  private:
    std::shared_ptr<const Volume> volume_;
};

std::shared_ptr<core::Object> create(const core::Properties& p) {
    const auto volume = volume_of(p, "volume", core::Rgb(1.0f));
    if (const auto value = volume->constant()) return core::make_constant_texture(*value);
    return std::make_shared<VolumeTexture>(volume);
}

}  // namespace

void register_volume_texture(core::Registry& registry) {
    registry.add({core::Category::texture,
                  "volume",
                  "A volume as a texture: a surface has the value of the volume where it stands in the "
                  "world, whatever "
                  "its texture coordinates. No slopes: as a bump map it has no effect.",
                  {{"volume", "volume", "1", "a gridvolume, vdbvolume or constvolume, a colour or a number"}},
                  R"(<texture type="volume" name="reflectance">
    <volume type="gridvolume" name="volume">
        <string name="filename" value="marble.vol"/>
    </volume>
</texture>)"},
                 create);
}

}  // namespace mote::media
