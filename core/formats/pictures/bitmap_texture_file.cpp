// Texture "bitmap": a picture file over the unit square.
#include "core/formats/pictures/image_file.h"
#include "core/formats/register_formats.h"
#include "core/materials/textures.h"
#include "core/objects/error.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

std::shared_ptr<Object> create_bitmap_texture(const Properties& p) {
    BitmapTextureParameters parameters;
    parameters.filter = p.get_choice("filter_type", "bilinear", {"bilinear", "nearest"}) == "nearest"
                            ? TextureFilter::nearest
                            : TextureFilter::bilinear;
    const std::string wrap = p.get_choice("wrap_mode", "repeat", {"repeat", "mirror", "clamp"});
    parameters.wrap = wrap == "repeat"   ? TextureWrap::repeat
                      : wrap == "mirror" ? TextureWrap::mirror
                                         : TextureWrap::clamp;
    parameters.to_uv = p.get_transform("to_uv");
    parameters.name = p.get_string("filename", "");
    const std::string path = p.require_file("filename");
    try {
        return make_bitmap_texture(read_bitmap(path, p.get_bool("raw", false)), parameters);
    } catch (const InputError& e) {
        if (e.where().line > 0) throw;
        throw InputError(e.what(), p.where_of("filename"));
    }
}

}  // namespace

void register_bitmap_texture(Registry& registry) {
    Manual manual{
        Category::texture,
        "bitmap",
        "A picture file over the unit square of uv. The top row of the picture lies at v = 0 (the OBJ reader "
        "turns v over, as in Mitsuba).",
        {{"filename", "string", "", "the picture: PNG, JPEG, EXR, HDR, TGA, ..."},
         {"filter_type", "string", "bilinear", "bilinear or nearest"},
         {"wrap_mode", "string", "repeat", "repeat, mirror or clamp: what lies outside the unit square"},
         {"raw", "boolean", "false", "take 8-bit values as linear instead of sRGB"},
         {"to_uv", "transform", "identity", "applied to the uv coordinates first"}},
        R"(<texture type="bitmap" name="reflectance">
    <string name="filename" value="wood.png"/>
    <string name="wrap_mode" value="mirror"/>
</texture>)"};
    registry.add(std::move(manual), create_bitmap_texture);
}

}  // namespace mote::core
