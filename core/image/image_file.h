// Image files: layered OpenEXR out and in, PNG previews out, any bitmap in.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

/// A picture of named float channels, row by row from the top.
struct ImageChannels {
    int width = 0, height = 0;                    ///< [pixels]
    std::vector<std::string> names;               ///< "R", "G", "B", "direct.R", "Depth.Z"
    std::vector<std::vector<float>> channels;     ///< one plane per name
    std::map<std::string, std::string> metadata;  ///< attributes of the file, as text

    /// A channel: width * height values.
    void add(const std::string& name, std::vector<float> plane);
    /// Splits an RGB plane into layer.R, layer.G, layer.B (or R, G, B for an empty layer name).
    void add_rgb(const std::string& layer, std::span<const Rgb> pixels);
    const std::vector<float>* find(const std::string& name) const;
    /// The three channels of a layer ("" for the beauty); empty when one is missing.
    std::vector<Rgb> rgb(const std::string& layer) const;
};

/// Writes beside the final name and renames, so that no crash leaves half a file. float32 unless `half`.
/// Returns how many finite values were too large for a half and became the largest one. Throws InputError
/// when the file cannot be written.
std::uint64_t write_exr(const std::string& path, const ImageChannels& image, bool half = false);
/// Reads a scan-line or tiled OpenEXR. Throws InputError naming the file for anything damaged or too large.
ImageChannels read_exr(const std::string& path);
/// Its metadata alone, from the header: no pixel is looked at.
std::map<std::string, std::string> read_exr_metadata(const std::string& path);

/// 8-bit sRGB preview: exposure in stops, then clipped. Values that are not finite are shown in magenta.
void write_png(const std::string& path, int width, int height, std::span<const Rgb> pixels,
               float exposure = 0.0f);
/// A PNG file of 8-bit values in memory. `srgb`: marked as sRGB; data that is no picture is not.
std::vector<std::byte> encode_png(int width, int height, std::span<const std::uint8_t> rgb, bool srgb);

/// Any bitmap that OpenImageIO reads, as linear RGB; 8-bit files are taken as sRGB unless `raw`.
struct Bitmap {
    int width = 0, height = 0;  ///< [pixels]
    std::vector<Rgb> pixels;    ///< row by row from the top
};
/// Throws InputError naming the file when it is damaged, larger than `max_pixels` or unreadable.
Bitmap read_bitmap(const std::string& path, bool raw, std::size_t max_pixels = std::size_t(1) << 28);

/// Writes bytes beside the final name, syncs and renames. Throws InputError with the system's reason.
void write_file_atomically(const std::string& path, std::span<const std::byte> bytes);
/// The same for bytes in several pieces.
void write_file_atomically(const std::string& path, std::span<const std::span<const std::byte>> pieces);

}  // namespace mote::core
