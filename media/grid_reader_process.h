// Runs the helper program that reads VDB files, and takes over what it hands back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <string>

namespace mote::media {

struct VdbLoadOptions;

/// Memory aligned for NanoVDB: allocated, or pages of a file.
class AlignedBuffer {
  public:
    AlignedBuffer() = default;
    /// Buffer of so many bytes, not set.
    explicit AlignedBuffer(std::size_t size);
    /// Part of a file, from a whole page on; what is written stays here. Null where it cannot be mapped.
    static AlignedBuffer mapped(int file, std::uint64_t offset, std::size_t size);
    std::byte* data() { return bytes_.get(); }              ///< the first byte, or null
    const std::byte* data() const { return bytes_.get(); }  ///< the first byte, or null
    std::size_t size() const { return size_; }              ///< [bytes]

  private:
    static constexpr std::align_val_t alignment{64};
    struct Free {
        std::size_t mapped;  ///< bytes to unmap; 0: allocated
        Free() : mapped(0) {}
        explicit Free(std::size_t bytes) : mapped(bytes) {}
        void operator()(std::byte* p) const;
    };
    std::unique_ptr<std::byte, Free> bytes_;
    std::size_t size_ = 0;
};

/// Answer of the helper program.
struct GridReaderAnswer {
    std::string text;      ///< JSON, see grid_reader_protocol.h
    AlignedBuffer buffer;  ///< the NanoVDB grid; empty for "list"
};

/// Throws InputError with one line that names the file for every failure of the file's or of the helper's:
/// its own refusal, a crash, too much time or memory, an answer that makes no sense, no helper to run.
GridReaderAnswer run_grid_reader(const std::string& mode, const std::string& path,
                                 const std::string& grid_name, const VdbLoadOptions& options);

/// Where the helper is: the environment variable MOTE_GRID_READER, or `mote_grid_reader` beside this program
/// or the library that holds this code, in ../libexec/mote or ../../libexec/mote from there, where the CMake
/// package says that it was installed, or where it was built. Throws InputError that says what to set where
/// it is in none of them.
std::string grid_reader_path();

}  // namespace mote::media
