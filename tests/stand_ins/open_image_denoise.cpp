// Functions of OpenImageDenoise with results that a test can predict. A feature becomes itself plus 1; a
// colour with both features, denoised before (above 0, or above -1 + 1 for normals) where they are said to be
// clean, twice itself; without any three times; with anything else, or without the option for HDR, an error.
// MOTE_STAND_IN_FAILS: the error of every run. MOTE_STAND_IN_LOG: a file that gets a line for each colour
// that was denoised. MOTE_STAND_IN_SHARP: normals are clean as they are.
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

namespace {

struct Image {
    float* pixels = nullptr;
    std::size_t width = 0, height = 0;
    std::size_t numbers() const { return 3 * width * height; }
};
struct Device {
    bool committed = false;
    std::string error;
};
struct Filter {
    Device* device;
    std::map<std::string, Image> images;
    std::map<std::string, bool> flags;
    int quality = 0;
    bool committed = false;
    bool has(const std::string& name) const { return images.count(name) > 0; }
};

/// True where no number is below the least that a feature has after it.
bool denoised_before(const Image& feature, float least) {
    for (std::size_t i = 0; i < feature.numbers(); ++i)
        if (feature.pixels[i] < least) return false;
    return true;
}

bool is_zero(const Image& feature) {
    for (std::size_t i = 0; i < feature.numbers(); ++i)
        if (feature.pixels[i] != 0.0f) return false;
    return true;
}

/// Rule of the stand-in: output = factor * input + more. Returns "" or an error.
std::string rule(const Filter& f, std::string& input, float& factor, float& more) {
    if (!f.committed || !f.device->committed || !f.has("output")) return "not committed";
    if (!f.has("color")) {
        input = f.has("albedo") ? "albedo" : "normal", factor = 1.0f, more = 1.0f;
        if (f.quality != 5) return "a feature of other than balanced quality";
        return f.has(input) ? "" : "no input";
    }
    input = "color", more = 0.0f;
    if (f.quality != 0 && f.quality != 5) return "colour of other than the default or balanced quality";
    if (!f.flags.count("hdr")) return "colour without hdr";
    if (!f.has("albedo") && !f.has("normal")) return factor = 3.0f, "";
    if (!f.has("albedo") || !f.has("normal")) return "half of the features";
    factor = f.quality == 5 ? 4.0f : 2.0f;
    const bool clean =
        denoised_before(f.images.at("albedo"), 1.0f) && denoised_before(f.images.at("normal"), 0.0f);
    if (!f.flags.count("cleanAux")) return clean ? "clean features that are said to be noisy" : "";
    const float least = std::getenv("MOTE_STAND_IN_SHARP") ? -1.0f : 0.0f;
    return denoised_before(f.images.at("albedo"), 0.0f) && denoised_before(f.images.at("normal"), least)
               ? ""
               : "noisy features";
}

}  // namespace

extern "C" {

void* oidnNewDevice(int type) { return type == 1 ? new Device : nullptr; }
void oidnSetDeviceInt(void*, const char*, int) {}
void oidnSetDeviceBool(void*, const char*, bool) {}
int oidnGetDeviceInt(void*, const char* name) {
    const std::string n = name;
    return n == "versionMajor" ? 9 : n == "versionMinor" ? 8 : n == "versionPatch" ? 7 : -1;
}
int oidnGetDeviceError(void* device, const char** message) {
    static thread_local std::string last;
    last = static_cast<Device*>(device)->error;
    static_cast<Device*>(device)->error.clear();
    *message = last.c_str();
    return last.empty() ? 0 : 3;
}
void oidnCommitDevice(void* device) { static_cast<Device*>(device)->committed = true; }
void oidnReleaseDevice(void* device) { delete static_cast<Device*>(device); }
void* oidnNewFilter(void* device, const char* type) {
    return std::string(type) == "RT" ? new Filter{static_cast<Device*>(device), {}, {}, 0} : nullptr;
}
void oidnSetSharedFilterImage(void* filter, const char* name, void* pixels, int format, std::size_t width,
                              std::size_t height, std::size_t, std::size_t, std::size_t) {
    if (format == 3)
        static_cast<Filter*>(filter)->images[name] = {static_cast<float*>(pixels), width, height};
}
void oidnSetFilterBool(void* filter, const char* name, bool value) {
    if (value) static_cast<Filter*>(filter)->flags[name] = true;
}
void oidnSetFilterInt(void* filter, const char* name, int value) {
    if (std::string(name) == "quality") static_cast<Filter*>(filter)->quality = value;
}
void oidnCommitFilter(void* filter) { static_cast<Filter*>(filter)->committed = true; }
void oidnExecuteFilter(void* filter) {
    const Filter& f = *static_cast<Filter*>(filter);
    std::string input;
    float factor = 0.0f, more = 0.0f;
    f.device->error = rule(f, input, factor, more);
    if (const char* fails = std::getenv("MOTE_STAND_IN_FAILS")) f.device->error = fails;
    if (!f.device->error.empty()) return;
    if (const char* log = std::getenv("MOTE_STAND_IN_LOG"); log && input == "color")
        std::ofstream(log, std::ios::app)
            << "quality " << f.quality << (f.flags.count("cleanAux") ? "" : ", noisy features")
            << (f.has("normal") && is_zero(f.images.at("normal")) ? ", no normals" : "")
            << (f.images.at("color").width > 24 ? ", quarters" : "") << '\n';
    if (const char* light = std::getenv("MOTE_STAND_IN_LIGHT"); light && input == "color")
        more += std::strtof(light, nullptr);
    const Image &from = f.images.at(input), &to = f.images.at("output");
    for (std::size_t i = 0; i < to.numbers(); ++i) to.pixels[i] = factor * from.pixels[i] + more;
}
void oidnReleaseFilter(void* filter) { delete static_cast<Filter*>(filter); }
}
