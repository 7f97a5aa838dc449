// mote convert frames/####.exr film.mp4: the frames of a sequence as a film, by ffmpeg.
#include <fmt/format.h>
#include <sys/wait.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include "apps/command.h"
#include "apps/frame_files.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/film/exposure.h"
#include "core/math/srgb.h"
#include "core/objects/error.h"
#include "session/output_files.h"
#include "session/render_report.h"

namespace mote::apps {

namespace {

/// ffmpeg, which reads pixels from its standard input.
class Encoder {
  public:
    explicit Encoder(const std::vector<std::string>& options)
        : pipe_(::popen(("ffmpeg " + quoted(options)).c_str(), "we")) {
        if (!pipe_) throw core::InputError(std::string("no pipe: ") + std::strerror(errno));
    }
    ~Encoder() { end(); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    /// Throws InputError where the program has ended.
    void write(std::span<const std::uint8_t> bytes) {
        if (std::fwrite(bytes.data(), 1, bytes.size(), pipe_) == bytes.size()) return;
        finish();
        throw core::InputError("ffmpeg ended before the film was complete");
    }
    /// Waits for its end. Throws InputError unless it was a good one.
    void finish() {
        const int status = end();
        if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
            throw core::InputError(
                "films are made by ffmpeg, which cannot be started: install it, or keep the frames");
        if (status != 0) throw core::InputError("ffmpeg could not make the film");
    }

  private:
    int end() { return pipe_ ? ::pclose(std::exchange(pipe_, nullptr)) : 0; }
    std::FILE* pipe_;
};

}  // namespace

bool is_film(const std::string& extension) {
    return extension == ".mp4" || extension == ".webm" || extension == ".mov" || extension == ".gif";
}

int convert_sequence(const ConvertArguments& a) {
    const std::vector<FrameFile> frames = find_frames(a.input);
    std::vector<NamedFile> inputs;
    for (const FrameFile& frame : frames) inputs.push_back({"a frame", frame.path});
    check_outputs(std::vector<NamedFile>{{"the film", a.output}}, inputs);
    std::signal(SIGPIPE, SIG_IGN);  // the end of the encoder is an error of write()
    std::unique_ptr<Encoder> encoder;
    int width = 0, height = 0;
    // The exposure stays: what flickers would be the picture's.
    float scale = std::exp2(a.exposure);
    for (const FrameFile& frame : frames) {
        const core::Bitmap picture = read_picture(frame.path, a.layer).bitmap;
        if (!encoder) {
            width = picture.width, height = picture.height;
            if (a.exposure == 0.0f) scale = std::exp2(core::adapted_exposure(picture.pixels));
            // Encoders want even sizes.
            encoder = std::make_unique<Encoder>(std::vector<std::string>{
                "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
                fmt::format("{}x{}", width, height), "-r", fmt::format("{}", a.rate), "-i", "-", "-vf",
                "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt",
                extension_of(a.output) == ".gif" ? "rgb8" : "yuv420p", a.output});
        }
        if (picture.width != width || picture.height != height)
            throw core::InputError(fmt::format("has {} x {} pixels, the first frame {} x {}", picture.width,
                                               picture.height, width, height),
                                   {frame.path, 0});
        std::vector<std::uint8_t> bytes;
        bytes.reserve(picture.pixels.size() * 3);
        for (const core::Rgb& p : picture.pixels)
            for (int c = 0; c < 3; ++c)
                bytes.push_back(std::isfinite(scale * p[c]) ? core::encode_srgb(a.tone(scale * p[c])) : 0);
        encoder->write(bytes);
    }
    try {
        encoder->finish();
    } catch (const core::InputError& error) {
        throw core::InputError(error.what(), {a.output, 0});
    }
    return exit_ok;
}

}  // namespace mote::apps
