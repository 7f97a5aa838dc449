// Writing and reading checkpoints. The checksum is looked at before anything else in the file is believed.
#include "core/render/checkpoint.h"

#include <cstring>
#include <filesystem>

#include "core/image/checksum.h"
#include "core/image/image_file.h"
#include "core/image/whole_file.h"
#include "core/scene/error.h"

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

// The part of the file that the checksum covers.
std::span<const std::byte> verified(std::span<const std::byte> bytes) {
    if (bytes.size() < sizeof(magic) + sizeof(version) + sizeof(std::uint64_t))
        throw InputError("damaged (cut short)");
    if (std::memcmp(bytes.data(), magic, sizeof(magic)) != 0) throw InputError("not a checkpoint of mote");
    const auto content = bytes.first(bytes.size() - sizeof(std::uint64_t));
    std::uint64_t sum;
    std::memcpy(&sum, bytes.data() + content.size(), sizeof(sum));
    if (sum != checksum(content)) throw InputError("damaged (its checksum is wrong)");
    return content;
}

void read_verified(std::span<const std::byte> content, const CheckpointKey& key, Film& film) {
    Reader reader(content);
    reader.raw(sizeof(magic));
    const auto found_version = reader.number<std::uint32_t>();
    if (found_version != version)
        throw InputError("of format " + std::to_string(found_version) + ", not " + std::to_string(version));
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
    film.deserialize(reader.raw(reader.number<std::uint64_t>()));
}

}  // namespace

void write_checkpoint(const std::string& path, const CheckpointKey& key, const Film& film) {
    Writer writer;
    const std::vector<std::byte> film_bytes = film.serialize();
    writer.bytes().reserve(film_bytes.size() + 4096);
    writer.raw(magic, sizeof(magic));
    writer.number(version);
    writer.number(key.seed);
    writer.number(std::uint32_t(film.width()));
    writer.number(std::uint32_t(film.height()));
    writer.number(std::uint32_t(film.layers().size()));
    for (const Layer& layer : film.layers()) writer.text(layer.name);
    writer.text(key.content_hash);
    writer.number(std::uint64_t(film_bytes.size()));
    writer.raw(film_bytes.data(), film_bytes.size());
    writer.number(checksum(writer.bytes()));
    write_file_atomically(path, writer.bytes());
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
        read_verified(verified(bytes), key, film);
    } catch (const InputError& error) {
        throw InputError(std::string("cannot resume: this checkpoint is ") + error.what(), {path, 0});
    }
    return true;
}

}  // namespace mote::core
