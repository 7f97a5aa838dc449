// Texture "bitmap": a picture file over the unit square.
#include "core/formats/pictures/image_file.h"
#include "core/formats/register_formats.h"
#include "core/materials/textures.h"
#include "core/parameters/add_type.h"

namespace mote::core {
namespace {

struct BitmapFileSettings {
    FileName file;
    BitmapTextureParameters texture;
    bool raw = false;
};

std::shared_ptr<Object> create_bitmap_texture(BitmapFileSettings s, const Properties& p) {
    s.texture.name = s.file.written;
    try {
        return make_bitmap_texture(read_bitmap(s.file.path, s.raw), s.texture);
    } catch (const InputError& e) {
        if (e.where().line > 0) throw;
        throw InputError(e.what(), p.where_of("filename"));
    }
}

}  // namespace

void register_bitmap_texture(Registry& registry) {
    using Parameters = BitmapTextureParameters;
    add_type<BitmapFileSettings>(
        registry, Category::texture, "bitmap",
        "A picture file over the unit square of uv. The top row of the picture lies at v = 0 (the OBJ reader "
        "turns v over, as in Mitsuba).",
        {row("filename", &BitmapFileSettings::file, "The picture: PNG, JPEG, EXR, HDR, TGA, ...").required(),
         within(&BitmapFileSettings::texture,
                row("filter_type", &Parameters::filter,
                    {{"bilinear", TextureFilter::bilinear}, {"nearest", TextureFilter::nearest}},
                    "Values between texels."),
                row("wrap_mode", &Parameters::wrap,
                    {{"repeat", TextureWrap::repeat},
                     {"mirror", TextureWrap::mirror},
                     {"clamp", TextureWrap::clamp}},
                    "Values outside the unit square.")),
         row("raw", &BitmapFileSettings::raw, "Take 8-bit values as linear instead of sRGB."),
         within(&BitmapFileSettings::texture,
                row("to_uv", &Parameters::to_uv, "Applied to the uv coordinates first."))},
        R"(<texture type="bitmap" name="reflectance">
    <string name="filename" value="wood.png"/>
    <string name="wrap_mode" value="mirror"/>
</texture>)",
        create_bitmap_texture);
    registry.set_file_memory(Category::texture, "bitmap",
                             [](const Properties& p) { return bitmap_memory(p.find_file("filename")); });
}

}  // namespace mote::core
