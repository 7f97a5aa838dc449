// Checks of all files before anything is written: an output is no input, no other output, and nothing that
// the user did not name and mote did not write.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace mote::session {

/// A file that is written or was read, and what it is, for messages: {"the preview", "a.png"}.
struct NamedFile {
    std::string what, path;
    bool named = true;  ///< by the user; a file of another name is replaced only if written_by_mote()
};

/// True when both names lead to one file: by links of either kind, by "..", or, where neither is there yet,
/// by folder and name. Devices and pipes are no such file.
bool same_file(const std::string& a, const std::string& b);

/// True for an EXR, a PNG preview or a partial film that mote wrote.
bool written_by_mote(const std::string& path);

/// Throws InputError when one of the outputs is one of the inputs, two outputs are one file, or an output
/// that was not named would replace a file that mote did not write.
void check_outputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);
/// The extension in lower case, ".exr".
std::string extension_of(const std::string& path);
/// Throws InputError for a name that does not end in .exr.
void require_exr_name(const std::string& path);
/// Throws InputError where one of the outputs is there and `marker`, which is written after them, is not: it
/// is none of an earlier run.
void check_companions(std::span<const NamedFile> outputs, const std::string& marker);
/// Throws InputError where `path` is a folder, or its folder is not there or cannot be written to: hours of
/// rendering must not end with that discovery.
void check_writable(const std::string& path);
/// Files that a scene was read from, as inputs.
std::vector<NamedFile> scene_inputs(std::span<const std::string> files);
/// Write a text atomically, and read one. Throw InputError with the file's name.
void write_text(const std::string& path, const std::string& text);
std::string read_text(const std::string& path);

}  // namespace mote::session
