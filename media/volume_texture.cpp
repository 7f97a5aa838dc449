#include "media/volume_texture.h"

#include "core/materials/texture.h"
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

}  // namespace

void register_volume_texture(core::Registry& registry) {
    using namespace core;
    struct Settings {
        VolumePtr volume = make_constant_volume(1.0f);
    };
    add_type<Settings>(registry, Category::texture, "volume",
                       "A volume as a texture: a surface has the value of the volume at its position in the "
                       "world, whatever its texture coordinates. No slopes: as a bump map it has no effect.",
                       {row("volume", &Settings::volume, at_least(0),
                            "A gridvolume, vdbvolume or constvolume, a colour or a number.")},
                       R"(<texture type="volume" name="reflectance">
    <volume type="gridvolume" name="volume">
        <string name="filename" value="marble.vol"/>
    </volume>
</texture>)",
                       [](const Settings& s) -> std::shared_ptr<Texture> {
                           if (const auto value = s.volume->constant()) return make_constant_texture(*value);
                           return std::make_shared<VolumeTexture>(s.volume);
                       });
}

}  // namespace mote::media
