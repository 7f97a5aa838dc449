// Decoders of bitmap files in memory, one for each kind. The bytes are untrusted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mote::core {

/// Interleaved channels as they are stored, 0 to 1 where the file has whole numbers, row by row from the top.
struct DecodedPicture {
    int width = 0, height = 0;
    int channels = 0;         ///< 1 or 2: grey (and alpha); 3 or 4: red, green, blue (and alpha)
    bool eight_bits = false;  ///< at most 8 bits a channel, which are sRGB by custom
    std::vector<float> values;
};

struct PictureFile {
    std::span<const std::byte> bytes;
    std::size_t max_pixels = 0;
};

/// Makes room for a picture. Throws InputError where it is larger than `max_pixels`, or larger than any coder
/// of these formats could pack into the file.
DecodedPicture make_room(const PictureFile& file, std::int64_t width, std::int64_t height, int channels,
                         bool eight_bits);
/// Checks these limits alone.
void check_picture_size(const PictureFile& file, std::int64_t width, std::int64_t height,
                        std::int64_t bytes_per_pixel);

/// Each throws InputError, without the file's name, for anything that no sound file has.
DecodedPicture decode_png(const PictureFile& file);
DecodedPicture decode_jpeg(const PictureFile& file);
DecodedPicture decode_hdr(const PictureFile& file);
DecodedPicture decode_pnm(const PictureFile& file);
DecodedPicture decode_bmp(const PictureFile& file);
DecodedPicture decode_targa(const PictureFile& file);

/// A whole number of `max` + 1 steps as a fraction.
inline float fraction(std::uint32_t value, std::uint32_t max) { return float(value) * (1.0f / float(max)); }

/// Bytes of a file in order; past its end an InputError.
class PictureBytes {
  public:
    explicit PictureBytes(std::span<const std::byte> bytes, std::size_t at = 0) : bytes_(bytes), at_(at) {}
    bool at_end() const { return at_ >= bytes_.size(); }
    std::uint32_t next();
    std::uint32_t next_16() {  // the low byte first
        const std::uint32_t low = next();
        return low | next() << 8;
    }
    void skip(std::size_t count);
    /// Text up to the next line feed, which is consumed; at most 256 characters.
    std::string line();

  private:
    std::span<const std::byte> bytes_;
    std::size_t at_;
};

}  // namespace mote::core
