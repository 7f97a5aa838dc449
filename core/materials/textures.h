// Factories of textures, for code that builds scenes itself and for tests.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/film/bitmap.h"
#include "core/materials/texture.h"
#include "core/math/transform.h"

namespace mote::core {

/// Squares of half a unit of the transformed uv; color0 holds at the origin.
std::shared_ptr<Texture> make_checkerboard_texture(TexturePtr color0, TexturePtr color1,
                                                   const Transform& to_uv = {});

/// Between texels: mixed of four, or the nearest one.
enum class TextureFilter : std::uint8_t { bilinear, nearest };
/// Beyond [0, 1]: the picture again, mirrored, or its border.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };

struct BitmapTextureParameters {
    TextureFilter filter = TextureFilter::bilinear;  ///< between texels
    TextureWrap wrap = TextureWrap::repeat;          ///< beyond the picture
    Transform to_uv{};                               ///< applied to the texture coordinates first
    std::string name = "bitmap";                     ///< used in error messages
};
/// The first row of the bitmap lies at v = 0, texel centres at half-integers (Mitsuba 3; its OBJ reader turns
/// v over). Throws InputError when the bitmap is empty or holds values that are not finite.
std::shared_ptr<Texture> make_bitmap_texture(const Bitmap& bitmap,
                                             const BitmapTextureParameters& parameters = {});

}  // namespace mote::core
