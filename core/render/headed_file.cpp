#include "core/render/headed_file.h"

#include <fstream>

#include "core/files/atomic_file.h"
#include "core/files/checksum.h"

namespace mote::core {

void ByteWriter::raw(const void* data, std::size_t size) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    if (size > 0) std::memcpy(bytes_.data() + at, data, size);
}

void write_headed_file(const std::string& path, const FileKind& kind, const ByteWriter& fields,
                       std::span<const std::byte> film) {
    ByteWriter head;
    head.raw(kind.magic.data(), kind.magic.size());
    head.number(kind.version);
    // Size of all that stands before the checksum.
    head.number(std::uint32_t(head.bytes().size() + sizeof(std::uint32_t) + fields.bytes().size() +
                              sizeof(std::uint64_t)));
    head.raw(fields.bytes().data(), fields.bytes().size());
    head.number(std::uint64_t(film.size()));
    head.number(checksum(head.bytes()));
    const std::span<const std::byte> pieces[] = {head.bytes(), film};
    write_file_atomically(path, pieces);
}

namespace {

constexpr std::size_t before_fields = sizeof(FileKind::magic) + 2 * sizeof(std::uint32_t);

/// Size of the head without its checksum, which is right. Throws InputError.
std::size_t checked_head(std::span<const std::byte> bytes, const FileKind& kind) {
    if (bytes.size() < before_fields) throw InputError("damaged (cut short)");
    if (std::memcmp(bytes.data(), kind.magic.data(), kind.magic.size()) != 0)
        throw InputError(std::string("not ") + kind.name);
    ByteReader reader(bytes.subspan(kind.magic.size()));
    const auto version = reader.number<std::uint32_t>();
    if (version != kind.version)
        throw InputError("of format " + std::to_string(version) + ", not " + std::to_string(kind.version));
    const std::size_t size = reader.number<std::uint32_t>();
    std::uint64_t sum = 0;
    if (size > bytes.size() || bytes.size() - size < sizeof(sum) ||
        size < before_fields + sizeof(std::uint64_t))
        throw InputError("damaged (cut short)");
    std::memcpy(&sum, bytes.data() + size, sizeof(sum));
    if (sum != checksum(bytes.first(size))) throw InputError("damaged (its checksum is wrong)");
    return size;
}

ByteReader fields_of(std::span<const std::byte> bytes, std::size_t head) {
    return ByteReader(bytes.first(head - sizeof(std::uint64_t)).subspan(before_fields));
}

}  // namespace

HeadedFile read_headed_file(std::span<const std::byte> bytes, const FileKind& kind) {
    const std::size_t head = checked_head(bytes, kind);
    const auto film = bytes.subspan(head + sizeof(std::uint64_t));
    if (ByteReader(bytes.subspan(head - sizeof(std::uint64_t))).number<std::uint64_t>() != film.size())
        throw InputError("damaged (its length is wrong)");
    return {fields_of(bytes, head), film};
}

std::optional<ByteReader> read_head(const std::string& path, const FileKind& kind,
                                    std::vector<std::byte>& beginning) {
    std::ifstream file(path, std::ios::binary);
    beginning.resize(max_head_size);
    file.read(reinterpret_cast<char*>(beginning.data()), std::streamsize(beginning.size()));
    beginning.resize(std::size_t(file.gcount()));
    try {
        return fields_of(beginning, checked_head(beginning, kind));
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace mote::core
