// Files of ours that hold a film: a head that says what it is, and the film.
//
// Little-endian: magic, version, size of the head, fields, size of the film; a checksum of this head; the
// film, which holds its own checksum. Checksums are verified before anything else in the file is used.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/objects/error.h"

namespace mote::core {

class ByteWriter {
  public:
    void raw(const void* data, std::size_t size);
    template <typename T>
    void number(T value) {
        raw(&value, sizeof(value));
    }
    void text(const std::string& s) {
        number(std::uint64_t(s.size()));
        raw(s.data(), s.size());
    }
    std::vector<std::byte>& bytes() { return bytes_; }
    const std::vector<std::byte>& bytes() const { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
};

/// Throws InputError at the end of the bytes.
class ByteReader {
  public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    bool empty() const { return bytes_.empty(); }  ///< nothing is left
    std::span<const std::byte> raw(std::uint64_t size) {
        if (size > bytes_.size()) throw InputError("damaged (its length is wrong)");
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

/// Distinguishes one kind of file from others.
struct FileKind {
    std::array<char, 8> magic;
    std::uint32_t version;
    const char* name;  ///< "a checkpoint of mote"
};

/// Writes the file atomically. Throws InputError with the system's reason; an older file stays as it was.
void write_headed_file(const std::string& path, const FileKind& kind, const ByteWriter& fields,
                       std::span<const std::byte> film);

/// Views of the file's bytes: valid as long as these.
struct HeadedFile {
    ByteReader fields;
    std::span<const std::byte> film;
};
/// Throws InputError for bytes that are damaged or of another kind; its text completes "this file is ...".
HeadedFile read_headed_file(std::span<const std::byte> bytes, const FileKind& kind);

/// Largest head that read_head() reads [bytes].
inline constexpr std::size_t max_head_size = std::size_t(1) << 20;
/// Fields of a file's undamaged head; the film behind it is not read. Nothing where the file cannot be opened
/// or begins as something else. `beginning` owns the bytes of the result.
std::optional<ByteReader> read_head(const std::string& path, const FileKind& kind,
                                    std::vector<std::byte>& beginning);

}  // namespace mote::core
