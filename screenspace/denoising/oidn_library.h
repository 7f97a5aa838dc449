// OpenImageDenoise (https://www.openimagedenoise.org), found and loaded at run time: the few functions of its
// C interface that a picture needs. mote is built and runs without it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace mote::screenspace {

class OidnLibrary {
  public:
    /// Where MOTE_OIDN is set it names the library's file, or the folder that holds it, or is 'off', and
    /// nothing else is tried; else the loader's own path, then Python's package pyoidn in the folder
    /// `package`, or "": where the Python of MOTE_PYTHON, of the active environment (VIRTUAL_ENV), or else
    /// `python3` has it. `threads` 0: as many as it likes. Throws InputError, which says how to install it.
    explicit OidnLibrary(int threads = 0, const std::string& package = "");
    ~OidnLibrary();
    OidnLibrary(const OidnLibrary&) = delete;
    OidnLibrary& operator=(const OidnLibrary&) = delete;

    const std::string& version() const { return version_; }  ///< "2.5.1"

    /// Quality of colours; features always have the balanced one.
    enum class Quality { high, balanced };
    /// Time of the high quality over that of the balanced one, with clean features; with others it is the
    /// same network (640 x 400 and 960 x 600, two cores).
    static constexpr double high_per_balanced = 2.4;
    /// Features of the pixels; empty: none.
    struct Picture {
        int width = 0, height = 0;
        std::span<const core::Rgb> colour;  ///< radiance
        std::span<const core::Rgb> albedo, normal;
        bool clean_features = true;  ///< without noise: those of denoised_feature()
        Quality quality = Quality::high;
    };
    /// Throws InputError where the library fails.
    std::vector<core::Rgb> denoised(const Picture& picture) const;
    class Series;
    /// For pictures of the size, the quality and the features of this one.
    Series series(const Picture& first) const;
    enum class Feature { albedo, normal };
    std::vector<core::Rgb> denoised_feature(Feature which, int width, int height,
                                            std::span<const core::Rgb> values) const;

  private:
    struct Functions;
    void look_everywhere(std::string package);
    void make_device(int threads);
    void check(const std::string& what) const;

    std::unique_ptr<Functions> functions_;
    void *library_ = nullptr, *device_ = nullptr;
    std::string version_;
};

/// Denoises pictures one after the other. The library builds its network once, which takes as long as a small
/// picture, and keeps its buffers until the end. For one thread at a time; the library must outlive it.
class OidnLibrary::Series {
  public:
    ~Series();
    Series(Series&&) noexcept;
    /// As OidnLibrary::denoised(), to the bit. Throws std::invalid_argument for a picture of another size,
    /// quality or set of features, and InputError where the library fails.
    std::vector<core::Rgb> denoised(const Picture& picture);

  private:
    friend class OidnLibrary;
    Series(const OidnLibrary& library, const Picture& first);
    struct Network;
    std::unique_ptr<Network> network_;
};

}  // namespace mote::screenspace
