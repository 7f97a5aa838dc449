#include "media/volume_texture.h"

#include "core/materials/textures.h"
#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/volume.h"

namespace mote::media {
namespace {

std::shared_ptr<core::Object> create(const core::Properties& p) {
    const auto volume = volume_of(p, "volume", core::Rgb(1.0f));
    const auto value = volume->constant();
    if (!value)
        throw core::InputError("a texture 'volume' holds a constvolume: grids on surfaces are not supported",
                               p.where_of("volume"));
    return core::make_constant_texture(*value);
}

}  // namespace

void register_volume_texture(core::Registry& registry) {
    registry.add(
        {core::Category::texture,
         "volume",
         "A volume that is the same everywhere, as a colour; volumes that vary are refused.",
         {{"volume", "volume", "1", "a constvolume, a colour or a number"}},
         R"(<texture type="volume" name="reflectance"><volume type="constvolume" name="volume"><rgb name="value" value="0.2, 0.5, 0.3"/></volume></texture>)"},
        create);
}

}  // namespace mote::media
