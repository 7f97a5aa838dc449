// Contents of the handles of the C interface, and how C++ errors become status codes.
#pragma once

#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/formats/xml/faults.h"
#include "plugins/c/mote.h"
#include "session/layers.h"
#include "session/loaded_scene.h"
#include "session/render.h"

namespace mote::c {

/// The errors of the last call that failed; none after one that did not.
class LastError {
  public:
    void clear() { errors_.clear(); }
    void set(const core::InputError& error);  ///< all of them, of SceneErrors
    void set(const std::string& text) { errors_.assign(1, core::InputError(text)); }
    const char* text() const { return text_at(0) ? text_at(0) : ""; }
    const char* text_at(std::size_t i) const { return i < errors_.size() ? errors_[i].what() : nullptr; }
    const char* file() const { return errors_.empty() ? "" : errors_.front().where().file.c_str(); }
    int line() const { return errors_.empty() ? 0 : errors_.front().where().line; }
    std::size_t count() const { return errors_.size(); }

  private:
    std::vector<core::InputError> errors_;
};

/// An argument that no caller may give.
struct InvalidArgument : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};
/// A pointer that must not be null.
template <typename T>
T& required(T* pointer, const char* name) {
    if (!pointer) throw InvalidArgument(std::string(name) + " is null");
    return *pointer;
}

inline core::Vec3 vec3(const float* v) { return {v[0], v[1], v[2]}; }

/// Options in this library's own version: from null (defaults), from an older header (the rest is zero), or
/// from a newer one whose further members are zero. `smallest` is the size of the first version. Throws
/// InvalidArgument.
template <typename Options>
Options known_options(const Options* given, std::size_t smallest = sizeof(Options)) {
    Options options{};
    options.struct_size = sizeof options;
    if (!given) return options;
    const std::size_t size = given->struct_size;
    if (size < smallest || size > smallest + 4096)
        throw InvalidArgument("struct_size is " + std::to_string(size) + " where this version has " +
                              std::to_string(sizeof options));
    const char* bytes = reinterpret_cast<const char*>(given);
    for (std::size_t i = sizeof options; i < size; ++i)
        if (bytes[i] != 0)
            throw InvalidArgument(
                "struct_size is that of a newer version, and a field that this one lacks is set");
    std::memcpy(&options, given, std::min(size, sizeof options));
    return options;
}

/// Runs f. What it throws becomes a status, and the text of `error`.
template <typename F>
mote_status guarded(LastError& error, F&& f) noexcept {
    try {
        error.clear();
        try {
            f();
            return MOTE_OK;
        } catch (const core::InputError& e) {
            error.set(e);
            return MOTE_INPUT_ERROR;
        } catch (const std::invalid_argument& e) {
            error.set(e.what());
            return MOTE_INVALID_ARGUMENT;
        } catch (const std::bad_alloc& e) {
            error.set(std::string("there is not enough memory for this: ") + e.what());
            return MOTE_OUT_OF_MEMORY;
        } catch (const std::exception& e) {
            error.set(std::string("internal error: ") + e.what());
            return MOTE_INTERNAL_ERROR;
        }
    } catch (...) {  // no memory for the text either, or something that is no std::exception
        return MOTE_INTERNAL_ERROR;
    }
}

}  // namespace mote::c

struct mote_scene {
    std::optional<mote::session::LoadedScene> loaded;
    mote::session::SceneTree tree;
    std::vector<std::string> warnings;
    std::string plan;
    mote::c::LastError error;
};

struct mote_picture {
    mote::session::Rendered rendered;
    std::vector<mote::session::LayerChannels> layers;
    mote::c::LastError error;
};
