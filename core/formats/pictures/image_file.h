// Image files: layered OpenEXR out and in, PNG previews out, any bitmap in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/film/bitmap.h"
#include "core/film/image_channels.h"
#include "core/math/vec.h"

namespace mote::core {

/// Writes beside the final name and renames, so that no crash leaves half a file. float32 unless `half`.
/// Returns how many finite values were too large for a half and became the largest one. Throws InputError
/// when the file cannot be written.
std::uint64_t write_exr(const std::string& path, const ImageChannels& image, bool half = false);
/// Reads a scan-line or tiled OpenEXR. Throws InputError naming the file for anything damaged or too large.
ImageChannels read_exr(const std::string& path);
/// Its metadata alone, from the header: no pixel is read.
std::map<std::string, std::string> read_exr_metadata(const std::string& path);

/// 8-bit sRGB preview: exposure in stops, then clipped. Values that are not finite are shown in magenta.
void write_png(const std::string& path, int width, int height, std::span<const Rgb> pixels,
               float exposure = 0.0f);
/// A PNG file of 8-bit values in memory. `srgb`: marked as sRGB; data that is no picture is not.
std::vector<std::byte> encode_png(int width, int height, std::span<const std::uint8_t> rgb, bool srgb);

/// Any bitmap that OpenImageIO reads, as linear RGB; 8-bit files are taken as sRGB unless `raw`.
/// Throws InputError naming the file when it is damaged, larger than `max_pixels` or unreadable.
Bitmap read_bitmap(const std::string& path, bool raw, std::size_t max_pixels = std::size_t(1) << 28);

/// The least that a texture of this file takes [B], by the header of an OpenEXR or PNG file, else the file's
/// size. Throws InputError.
double bitmap_memory(const std::string& path);

}  // namespace mote::core
