// mote convert frames/####.exr film.mp4: the frames of a sequence as a film, by ffmpeg.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstring>

#include "apps/command.h"
#include "apps/frame_files.h"
#include "apps/output_files.h"
#include "apps/picture_file.h"
#include "apps/subcommands.h"
#include "core/film/exposure.h"
#include "core/math/srgb.h"
#include "core/objects/error.h"

extern char** environ;

namespace mote::apps {

namespace {

/// A program that reads pictures from its standard input.
class Encoder {
  public:
    explicit Encoder(std::vector<std::string> command) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0)
            throw core::InputError(std::string("no pipe: ") + std::strerror(errno));
        std::vector<char*> arguments;
        for (std::string& word : command) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
        const int problem =
            ::posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(ends[0]);
        input_ = ends[1];
        if (problem != 0) {
            process_ = -1;
            ::close(input_), input_ = -1;
            throw core::InputError("films are made by ffmpeg, which cannot be started (" +
                                   std::string(std::strerror(problem)) + "): install it, or keep the frames");
        }
    }
    ~Encoder() { finish(); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;

    /// Throws InputError where the program no longer listens.
    void write(std::span<const std::uint8_t> bytes) {
        while (!bytes.empty()) {
            const ssize_t n = ::write(input_, bytes.data(), bytes.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) throw core::InputError("ffmpeg ended before the film was complete");
            bytes = bytes.subspan(std::size_t(n));
        }
    }
    /// Waits for its end. Returns whether it was a good one.
    bool finish() {
        if (input_ >= 0) ::close(input_), input_ = -1;
        if (process_ < 0) return good_;
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
        return good_ = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }

  private:
    pid_t process_ = -1;
    int input_ = -1;
    bool good_ = false;
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
    std::signal(SIGPIPE, SIG_IGN);  // an encoder that ends is told by write()
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
                "ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s",
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
                bytes.push_back(std::isfinite(scale * p[c]) ? core::encode_srgb(scale * p[c]) : 0);
        encoder->write(bytes);
    }
    if (!encoder->finish()) throw core::InputError("ffmpeg could not make the film", {a.output, 0});
    return exit_ok;
}

}  // namespace mote::apps
