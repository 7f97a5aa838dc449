// PNG by libpng. Its error function must not return: it jumps, over frames that have nothing to destroy.
#include <png.h>

#include <csetjmp>
#include <cstring>
#include <memory>

#include "core/formats/pictures/decoded_picture.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

class PngReader {
  public:
    explicit PngReader(const PictureFile& file) : file_(file), left_(file.bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
        if (png_) info_ = png_create_info_struct(png_);
        if (!info_) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, this, read);
        png_set_user_limits(png_, INT32_MAX, INT32_MAX);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    DecodedPicture run() {
        guarded([this] { png_read_info(png_, info_); });
        const std::int64_t width = png_get_image_width(png_, info_),
                           height = png_get_image_height(png_, info_);
        check_picture_size(file_, width, height, 1);
        guarded([this] { expand(); });
        const int channels = png_get_channels(png_, info_), bytes = png_get_bit_depth(png_, info_) / 8;
        DecodedPicture picture = make_room(file_, width, height, channels, bytes == 1);
        const std::size_t stride = std::size_t(width) * std::size_t(channels) * std::size_t(bytes);
        if (png_get_rowbytes(png_, info_) != stride) throw InputError("damaged PNG file: odd rows");
        std::vector<png_byte> pixels(stride * std::size_t(height));
        std::vector<png_bytep> rows;
        for (std::int64_t y = 0; y < height; ++y) rows.push_back(pixels.data() + std::size_t(y) * stride);
        guarded([&] {
            png_read_image(png_, rows.data());
            png_read_end(png_, nullptr);
        });
        for (std::size_t i = 0; i < picture.values.size(); ++i)
            picture.values[i] = bytes == 1
                                    ? fraction(pixels[i], 255)
                                    : fraction(std::uint32_t(pixels[2 * i] << 8 | pixels[2 * i + 1]), 65535);
        return picture;
    }

  private:
    /// Palettes and grey of few bits to 8 bits, transparent colours to alpha.
    void expand() {
        png_set_expand(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
    }
    template <typename F>
    void guarded(F&& f) {
        if (setjmp(jump_) != 0) throw InputError("damaged PNG file: " + printable(message_));
        f();
    }
    static void fail(png_structp png, png_const_charp message) {
        auto& self = *static_cast<PngReader*>(png_get_error_ptr(png));
        std::strncpy(self.message_, message, sizeof(message_) - 1);
        std::longjmp(self.jump_, 1);
    }
    static void ignore(png_structp, png_const_charp) {}
    static void read(png_structp png, png_bytep to, std::size_t count) {
        auto& self = *static_cast<PngReader*>(png_get_io_ptr(png));
        if (count > self.left_.size()) png_error(png, "cut short");
        std::memcpy(to, self.left_.data(), count);
        self.left_ = self.left_.subspan(count);
    }

    const PictureFile& file_;
    std::span<const std::byte> left_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::jmp_buf jump_;
    char message_[200] = {};
};

}  // namespace

DecodedPicture decode_png(const PictureFile& file) { return PngReader(file).run(); }

}  // namespace mote::core
