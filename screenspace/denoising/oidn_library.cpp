// The declarations below are those of the public C interface of OpenImageDenoise 2
// (https://www.openimagedenoise.org/documentation.html, "C99 API").
#include "screenspace/denoising/oidn_library.h"

#include <dlfcn.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "core/objects/error.h"

namespace mote::screenspace {

using core::InputError, core::Rgb;

namespace {

using Handle = void*;  // OIDNDevice, OIDNFilter
constexpr int cpu_device = 1, format_float3 = 3;
/// The quality of features: 2.4 times as fast as the high one, for at most a hundredth more error of the
/// picture (docs/methods/denoising.md).
constexpr int balanced_quality = 5;
static_assert(sizeof(Rgb) == 3 * sizeof(float), "pixels are handed over as they lie");

const char* const file_name = "libOpenImageDenoise.so.2";
const char* const how_to_install =
    "'pip install pyoidn' brings it (for the Python of MOTE_PYTHON, of the active environment, or python3), "
    "or "
    "MOTE_OIDN names the file libOpenImageDenoise.so.2";

/// Where Python would find the package, without importing it; "" where there is no Python, or no package. The
/// Python of a virtual environment may be active without being the first on the path.
std::string python_package() {
    FILE* python = ::popen(
        "\"${MOTE_PYTHON:-${VIRTUAL_ENV:+$VIRTUAL_ENV/bin/}python3}\" -c 'import importlib.util as u; "
        "print(u.find_spec(\"pyoidn\").submodule_search_locations[0])' "
        "2>/dev/null",
        "r");
    if (!python) return "";
    std::string folder;
    std::array<char, 256> piece{};
    while (std::fgets(piece.data(), int(piece.size()), python)) folder += piece.data();
    ::pclose(python);
    while (!folder.empty() && folder.back() == '\n') folder.pop_back();
    return folder;
}

std::string loader_error() {
    const char* text = ::dlerror();
    return text ? core::printable(text, 300) : "for no reason that the loader says";
}

}  // namespace

struct OidnLibrary::Functions {
    Handle (*new_device)(int type);
    void (*set_device_int)(Handle device, const char* name, int value);
    void (*set_device_bool)(Handle device, const char* name, bool value);
    int (*get_device_int)(Handle device, const char* name);
    int (*get_device_error)(Handle device, const char** message);
    void (*commit_device)(Handle device);
    void (*release_device)(Handle device);
    Handle (*new_filter)(Handle device, const char* type);
    void (*set_image)(Handle filter, const char* name, void* pixels, int format, std::size_t width,
                      std::size_t height, std::size_t offset, std::size_t pixel_stride,
                      std::size_t row_stride);
    void (*set_filter_bool)(Handle filter, const char* name, bool value);
    void (*set_filter_int)(Handle filter, const char* name, int value);
    void (*commit_filter)(Handle filter);
    void (*execute_filter)(Handle filter);
    void (*release_filter)(Handle filter);

    explicit Functions(void* library) {
        find(library, "oidnNewDevice", new_device), find(library, "oidnSetDeviceInt", set_device_int);
        find(library, "oidnSetDeviceBool", set_device_bool),
            find(library, "oidnGetDeviceInt", get_device_int);
        find(library, "oidnGetDeviceError", get_device_error);
        find(library, "oidnCommitDevice", commit_device), find(library, "oidnReleaseDevice", release_device);
        find(library, "oidnNewFilter", new_filter), find(library, "oidnSetSharedFilterImage", set_image);
        find(library, "oidnSetFilterBool", set_filter_bool);
        find(library, "oidnSetFilterInt", set_filter_int);
        find(library, "oidnCommitFilter", commit_filter), find(library, "oidnExecuteFilter", execute_filter);
        find(library, "oidnReleaseFilter", release_filter);
    }

    template <typename Function>
    static void find(void* library, const char* name, Function*& function) {
        function = reinterpret_cast<Function*>(::dlsym(library, name));
        if (!function)
            throw InputError(std::string("OpenImageDenoise has no function ") + name +
                             ": version 2 is needed");
    }

    /// A filter with images of one size.
    class Run {
      public:
        Run(const Functions& functions, Handle device, int width, int height)
            : f_(functions), filter_(f_.new_filter(device, "RT")), width_(width), height_(height) {}
        ~Run() {
            if (filter_) f_.release_filter(filter_);
        }
        Run(const Run&) = delete;
        Run& operator=(const Run&) = delete;
        /// The library writes to no image but the output, though it does not say so in its types.
        void image(const char* name, std::span<const Rgb> pixels) const {
            if (!pixels.empty() && pixels.size() != std::size_t(width_) * std::size_t(height_))
                throw std::invalid_argument("the picture does not have its size");
            if (filter_ && !pixels.empty())
                f_.set_image(filter_, name, const_cast<Rgb*>(pixels.data()), format_float3,
                             std::size_t(width_), std::size_t(height_), 0, 0, 0);
        }
        void flag(const char* name) const {
            if (filter_) f_.set_filter_bool(filter_, name, true);
        }
        void quality(int quality) const {
            if (filter_) f_.set_filter_int(filter_, "quality", quality);
        }
        std::vector<Rgb> result() const {
            std::vector<Rgb> output(std::size_t(width_) * std::size_t(height_), Rgb(0.0f));
            image("output", output);
            if (filter_) f_.commit_filter(filter_), f_.execute_filter(filter_);
            return output;
        }

      private:
        const Functions& f_;
        Handle filter_;
        int width_, height_;
    };
};

OidnLibrary::OidnLibrary(int threads, const std::string& package) {
    look_everywhere(package);
    try {
        functions_ = std::make_unique<Functions>(library_);
        make_device(threads);
    } catch (...) {
        if (device_) functions_->release_device(device_);
        ::dlclose(library_);
        throw;
    }
}

OidnLibrary::~OidnLibrary() {
    // The library itself stays: its threads may still be about to end.
    functions_->release_device(device_);
}

void OidnLibrary::look_everywhere(std::string package) {
    if (const char* named = std::getenv("MOTE_OIDN"); named && *named) {
        if (std::string_view(named) == "off")
            throw InputError("OpenImageDenoise is not loaded: MOTE_OIDN is 'off'");
        std::filesystem::path path = named;
        std::error_code ignored;
        if (std::filesystem::is_directory(path, ignored)) path /= file_name;
        library_ = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library_)
            throw InputError("OpenImageDenoise cannot be loaded, as MOTE_OIDN says it should: " +
                             loader_error() + "; " + how_to_install);
        return;
    }
    library_ = ::dlopen(file_name, RTLD_NOW | RTLD_LOCAL);
    if (library_) return;
    if (package.empty()) package = python_package();
    if (!package.empty()) {
        library_ = ::dlopen((package + "/oidn/lib/" + file_name).c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library_)
            throw InputError("OpenImageDenoise of the Python package pyoidn cannot be loaded: " +
                             loader_error());
        return;
    }
    throw InputError(std::string("OpenImageDenoise, which denoises, is not installed: ") + how_to_install);
}

void OidnLibrary::make_device(int threads) {
    device_ = functions_->new_device(cpu_device);
    if (!device_) check("it finds no device");
    if (threads > 0) functions_->set_device_int(device_, "numThreads", threads);
    functions_->set_device_bool(device_, "setAffinity", false);  // others render here as well
    functions_->commit_device(device_);
    check("it cannot be started");
    const auto number = [&](const char* name) {
        return std::to_string(functions_->get_device_int(device_, name));
    };
    version_ = number("versionMajor") + "." + number("versionMinor") + "." + number("versionPatch");
}

void OidnLibrary::check(const std::string& what) const {
    const char* message = nullptr;
    const int error = functions_->get_device_error(device_, &message);
    if (error == 0 && device_) return;
    throw InputError("OpenImageDenoise: " + what + ": " +
                     (message ? core::printable(message, 300) : "error " + std::to_string(error)));
}

struct OidnLibrary::Series::Network {
    const OidnLibrary& library;
    int width, height;
    bool features, clean_features;
    Quality quality;
    Functions::Run run;
};

OidnLibrary::Series::Series(const OidnLibrary& library, const Picture& first)
    : network_(new Network{library, first.width, first.height, !first.albedo.empty(), first.clean_features,
                           first.quality,
                           Functions::Run(*library.functions_, library.device_, first.width, first.height)}) {
    network_->run.flag("hdr");
    if (first.quality == Quality::balanced) network_->run.quality(balanced_quality);
    if (network_->features && first.clean_features) network_->run.flag("cleanAux");
}
OidnLibrary::Series::~Series() = default;
OidnLibrary::Series::Series(Series&&) noexcept = default;

std::vector<Rgb> OidnLibrary::Series::denoised(const Picture& picture) {
    const Network& n = *network_;
    if (picture.width != n.width || picture.height != n.height || picture.quality != n.quality ||
        picture.albedo.empty() == n.features || picture.clean_features != n.clean_features)
        throw std::invalid_argument("the picture is not one of this series");
    n.run.image("color", picture.colour);
    n.run.image("albedo", picture.albedo);
    if (n.features) n.run.image("normal", picture.normal);  // it takes no normal alone
    std::vector<Rgb> result = n.run.result();
    n.library.check("a layer was not denoised");
    return result;
}

OidnLibrary::Series OidnLibrary::series(const Picture& first) const { return {*this, first}; }

std::vector<Rgb> OidnLibrary::denoised(const Picture& picture) const {
    return series(picture).denoised(picture);
}

std::vector<Rgb> OidnLibrary::denoised_feature(Feature which, int width, int height,
                                               std::span<const Rgb> values) const {
    if (values.empty()) return {};
    const Functions::Run run(*functions_, device_, width, height);
    run.image(which == Feature::albedo ? "albedo" : "normal", values);
    run.quality(balanced_quality);
    std::vector<Rgb> result = run.result();
    check("a feature was not denoised");
    return result;
}

}  // namespace mote::screenspace
