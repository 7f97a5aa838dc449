// Writing and reading checkpoints. Checksums are looked at before anything else in the file is believed.
#include "core/render/checkpoint.h"

#include <cstring>
#include <filesystem>

#include "core/image/checksum.h"
#include "core/image/image_file.h"
#include "core/image/whole_file.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr char magic[8] = {'m', 'o', 't', 'e', 'c', 'h', 'k', 'p'};
constexpr std::uint32_t version = 1;

class Writer {
  public:
    void raw(const void* data, std::size_t size) {
        const auto* begin = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), begin, begin + size);
    }
    template <typename T>
    void number(T value) {
        raw(&value, sizeof(value));
    }
    void text(const std::string& s) {
        number(std::uint64_t(s.size()));
        raw(s.data(), s.size());
    }
    std::vector<std::byte>& bytes() { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
};

class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::span<const std::byte> raw(std::uint64_t size) {
        if (size > bytes_.size()) throw InputError("its length is wrong");
        const auto result = bytes_.first(std::size_t(size));
        bytes_ = bytes_.subspan(std::size_t(size));
        return result;
    }
    template <typename T>
    T number() {
        T value;
        std::memcpy(&value, raw(sizeof(T)).data(), sizeof(T));
        return value;
    }
    std::string text() {
        const auto chars = raw(number<std::uint64_t>());
        return {reinterpret_cast<const char*>(chars.data()), chars.size()};
    }

  private:
    std::span<const std::byte> bytes_;
};

// The head, after its checksum was found to be right.
std::span<const std::byte> verified_head(std::span<const std::byte> bytes) {
    if (bytes.size() < sizeof(magic) + 2 * sizeof(std::uint32_t)) throw InputError("damaged (cut short)");
    if (std::memcmp(bytes.data(), magic, sizeof(magic)) != 0) throw InputError("not a checkpoint of mote");
    Reader reader(bytes.subspan(sizeof(magic)));
    const auto found_version = reader.number<std::uint32_t>();
    if (found_version != version)
        throw InputError("of format " + std::to_string(found_version) + ", not " + std::to_string(version));
    const std::size_t size = reader.number<std::uint32_t>();
    if (size > bytes.size() || bytes.size() - size < sizeof(std::uint64_t))
        throw InputError("damaged (cut short)");
    std::uint64_t sum;
    std::memcpy(&sum, bytes.data() + size, sizeof(sum));
    if (sum != checksum(bytes.first(size))) throw InputError("damaged (its checksum is wrong)");
    return bytes.first(size);
}

void read_into(std::span<const std::byte> bytes, const CheckpointKey& key, Film& film) {
    const std::span<const std::byte> head = verified_head(bytes);
    Reader reader(head.subspan(sizeof(magic) + 2 * sizeof(std::uint32_t)));
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
    const auto film_bytes = bytes.subspan(head.size() + sizeof(std::uint64_t));
    if (reader.number<std::uint64_t>() != film_bytes.size())
        throw InputError("damaged (its length is wrong)");
    try {
        film.deserialize(film_bytes);
    } catch (const InputError& error) {
        throw InputError(std::string("damaged: ") + error.what());
    }
}

}  // namespace

void write_checkpoint(const std::string& path, const CheckpointKey& key, const Film& film) {
    const std::vector<std::byte> film_bytes = film.serialize();
    Writer head;
    head.raw(magic, sizeof(magic));
    head.number(version);
    head.number(std::uint32_t(0));  // the size of the head, known below
    head.number(key.seed);
    head.number(std::uint32_t(film.width()));
    head.number(std::uint32_t(film.height()));
    head.number(std::uint32_t(film.layers().size()));
    for (const Layer& layer : film.layers()) head.text(layer.name);
    head.text(key.content_hash);
    head.number(std::uint64_t(film_bytes.size()));
    const auto size = std::uint32_t(head.bytes().size());
    std::memcpy(head.bytes().data() + sizeof(magic) + sizeof(version), &size, sizeof(size));
    head.number(checksum(head.bytes()));
    const std::span<const std::byte> pieces[] = {head.bytes(), film_bytes};
    write_file_atomically(path, pieces);
}

bool read_checkpoint(const std::string& path, const CheckpointKey& key, Film& film) {
    if (!std::filesystem::exists(path)) return false;
    std::vector<std::byte> bytes;
    try {
        bytes = read_whole_file(path);
    } catch (const InputError& error) {
        throw InputError(std::string("cannot resume: ") + error.what(), {path, 0});
    }
    try {
        read_into(bytes, key, film);
    } catch (const InputError& error) {
        throw InputError(std::string("cannot resume: this checkpoint is ") + error.what(), {path, 0});
    }
    return true;
}

}  // namespace mote::core
