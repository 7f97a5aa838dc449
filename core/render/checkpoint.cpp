// Writing and reading checkpoints.
#include "core/render/checkpoint.h"

#include <filesystem>

#include "core/files/whole_file.h"
#include "core/objects/error.h"
#include "core/render/headed_file.h"

namespace mote::core {

namespace {

constexpr FileKind checkpoint_file{{'m', 'o', 't', 'e', 'c', 'h', 'k', 'p'}, 2, "a checkpoint of mote"};

/// Content hash in the head of the checkpoint at `path`; nothing where that is no checkpoint.
std::optional<std::string> content_of_checkpoint(const std::string& path) {
    std::vector<std::byte> beginning;
    std::optional<ByteReader> reader = read_head(path, checkpoint_file, beginning);
    if (!reader) return std::nullopt;
    reader->number<std::uint64_t>();                                            // seed
    reader->number<std::uint32_t>(), reader->number<std::uint32_t>();           // width, height
    for (auto n = reader->number<std::uint32_t>(); n > 0; --n) reader->text();  // layers
    return reader->text();
}

void read_into(std::span<const std::byte> bytes, const CheckpointKey& key, Film& film,
               ControlPasses& controls) {
    HeadedFile file = read_headed_file(bytes, checkpoint_file);
    ByteReader& reader = file.fields;
    const auto seed = reader.number<std::uint64_t>();
    if (seed != key.seed)
        throw InputError("of another render: its seed is " + std::to_string(seed) + ", not " +
                         std::to_string(key.seed));
    const auto width = reader.number<std::uint32_t>(), height = reader.number<std::uint32_t>();
    if (width != std::uint32_t(film.width()) || height != std::uint32_t(film.height()))
        throw InputError("of another render: its picture is " + std::to_string(width) + " x " +
                         std::to_string(height) + ", not " + std::to_string(film.width()) + " x " +
                         std::to_string(film.height()));
    const auto layers = reader.number<std::uint32_t>();
    bool same_layers = layers == film.layers().size();
    for (std::uint32_t i = 0; i < layers; ++i) {
        const std::string name = reader.text();
        same_layers = same_layers && name == film.layers()[i].name;
    }
    if (!same_layers) throw InputError("of another render: its layers are different");
    if (reader.text() != key.content_hash)
        throw InputError("of another render: the scene, a file that it names, or an option has changed");
    try {
        ControlPasses read = controls;
        if (!reader.empty()) {
            const auto of_controls = reader.raw(reader.number<std::uint64_t>());
            if (controls.can_choose()) read.deserialize(of_controls);
        }
        film.deserialize(file.film);
        controls = std::move(read);
    } catch (const InputError& error) {
        throw InputError(std::string("damaged: ") + error.what());
    }
}

}  // namespace

void require_own_checkpoint(const std::string& path, const std::string& content_hash) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    if (!fs::exists(status)) return;
    const auto content = fs::is_regular_file(status) ? content_of_checkpoint(path) : std::nullopt;
    if (!content)
        throw InputError(
            "is no checkpoint of mote, and is not replaced by one: move it or choose another name",
            {path, 0});
    if (*content != content_hash)
        throw InputError(
            "is a checkpoint of another render (the scene, a file that it names, or an option differs), and "
            "is not replaced: move it, remove it, or choose another name",
            {path, 0});
}

void remove_checkpoint(const std::string& path, const std::string& content_hash) {
    try {
        require_own_checkpoint(path, content_hash);
    } catch (const InputError&) {
        return;
    }
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
}

void write_checkpoint(const std::string& path, const CheckpointKey& key, const Film& film,
                      const MemoryBudget& memory, const ControlPasses& controls) {
    require_own_checkpoint(path, key.content_hash);
    ByteWriter head;
    head.number(key.seed);
    head.number(std::uint32_t(film.width()));
    head.number(std::uint32_t(film.height()));
    head.number(std::uint32_t(film.layers().size()));
    for (const Layer& layer : film.layers()) head.text(layer.name);
    head.text(key.content_hash);
    if (!controls.empty()) {
        const std::vector<std::byte> bytes = controls.serialize();
        head.number(std::uint64_t(bytes.size())), head.raw(bytes.data(), bytes.size());
    }
    write_headed_file(path, checkpoint_file, head, film.serialize(memory));
}

bool read_checkpoint(const std::string& path, const CheckpointKey& key, Film& film) {
    ControlPasses none;
    return read_checkpoint(path, key, film, none);
}

bool read_checkpoint(const std::string& path, const CheckpointKey& key, Film& film, ControlPasses& controls) {
    if (!std::filesystem::exists(path)) return false;
    std::vector<std::byte> bytes;
    try {
        bytes = read_whole_file(path);
    } catch (const InputError& error) {
        throw InputError(std::string("cannot resume: ") + error.what(), {path, 0});
    }
    try {
        read_into(bytes, key, film, controls);
    } catch (const InputError& error) {
        throw InputError(std::string("cannot resume: this checkpoint is ") + error.what(), {path, 0});
    }
    return true;
}

}  // namespace mote::core
