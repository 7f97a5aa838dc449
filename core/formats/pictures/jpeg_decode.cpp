// JPEG by libjpeg. Whatever it warns of makes a file damaged: it would fill in grey for what is missing.
#include <cstdio>

#include <jpeglib.h>

#include <csetjmp>
#include <cstring>

#include "core/formats/pictures/decoded_picture.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr int max_scans = 500;  // progressive files of thousands of scans take minutes

class JpegReader {
  public:
    explicit JpegReader(const PictureFile& file) : file_(file) {
        jpeg_.err = jpeg_std_error(&errors_);
        jpeg_.client_data = this;
        errors_.error_exit = fail;
        errors_.emit_message = [](j_common_ptr jpeg, int level) {
            if (level < 0) fail(jpeg);
        };
        errors_.output_message = [](j_common_ptr) {};
        progress_.progress_monitor = [](j_common_ptr jpeg) {
            if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > max_scans) fail(jpeg);
        };
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    DecodedPicture run() {
        guarded([this] {
            jpeg_create_decompress(&jpeg_);
            jpeg_.progress = &progress_;
            jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(file_.bytes.data()),
                         static_cast<unsigned long>(file_.bytes.size()));
            jpeg_read_header(&jpeg_, TRUE);
        });
        check_picture_size(file_, jpeg_.image_width, jpeg_.image_height, jpeg_.num_components);
        guarded([this] { jpeg_start_decompress(&jpeg_); });
        const int stored = jpeg_.output_components;  // 4: CMYK
        DecodedPicture picture =
            make_room(file_, jpeg_.output_width, jpeg_.output_height, stored == 4 ? 3 : stored, true);
        std::vector<JSAMPLE> row(std::size_t(picture.width) * std::size_t(stored));
        JSAMPROW rows[] = {row.data()};
        float* to = picture.values.data();
        for (int y = 0; y < picture.height; ++y) {
            guarded([&] { jpeg_read_scanlines(&jpeg_, rows, 1); });
            to = stored == 4 ? put_cmyk(row, to) : put(row, to);
        }
        guarded([this] { jpeg_finish_decompress(&jpeg_); });
        return picture;
    }

  private:
    static float* put(const std::vector<JSAMPLE>& row, float* to) {
        for (const JSAMPLE value : row) *to++ = fraction(value, 255);
        return to;
    }
    /// Adobe stores inks inverted: 255 is none.
    static float* put_cmyk(const std::vector<JSAMPLE>& row, float* to) {
        for (std::size_t i = 0; i < row.size(); i += 4)
            for (std::size_t c = 0; c < 3; ++c) *to++ = fraction(row[i + c], 255) * fraction(row[i + 3], 255);
        return to;
    }
    template <typename F>
    void guarded(F&& f) {
        if (setjmp(jump_) != 0) throw InputError("damaged JPEG file: " + printable(message_));
        f();
    }
    static void fail(j_common_ptr jpeg) {
        auto& self = *static_cast<JpegReader*>(jpeg->client_data);
        self.errors_.format_message(jpeg, self.message_);
        std::longjmp(self.jump_, 1);
    }

    const PictureFile& file_;
    jpeg_decompress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    std::jmp_buf jump_;
    char message_[JMSG_LENGTH_MAX] = {};
};

}  // namespace

DecodedPicture decode_jpeg(const PictureFile& file) { return JpegReader(file).run(); }

}  // namespace mote::core
