// The walk over an OpenEXR header (layout: "The OpenEXR File Layout", openexr.com).
#include "core/formats/pictures/exr_preflight.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <vector>

#include "core/files/whole_file.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr std::int64_t max_pixels = std::int64_t(1) << 28;
constexpr std::int64_t max_channels = 1024;
constexpr std::int64_t max_plane_bytes = std::int64_t(4) << 30;
constexpr std::int64_t max_chunk_bytes = std::int64_t(1) << 30;
constexpr std::int64_t max_parts = 256;
constexpr std::int64_t max_attributes = 4096;
// A chunk takes eight bytes of the offset table, and eight of a header before its data.
constexpr std::int64_t min_bytes_per_chunk = 16;

struct Compression {
    const char* name;
    std::int64_t lines_per_chunk;
    // How much smaller than its pixels a chunk can be at most. Deflate cannot beat 1032; DWA deflates what it
    // has quantised to nothing before.
    std::int64_t max_ratio;
};
constexpr std::array<Compression, 10> compressions = {{{"none", 1, 1},
                                                       {"rle", 1, 64},
                                                       {"zips", 1, 1100},
                                                       {"zip", 16, 1100},
                                                       {"piz", 32, 8192},
                                                       {"pxr24", 16, 2200},
                                                       {"b44", 32, 64},
                                                       {"b44a", 32, 64},
                                                       {"dwaa", 32, 65536},
                                                       {"dwab", 256, 65536}}};
// Small pictures cost nothing whatever they claim.
constexpr std::int64_t always_allowed_bytes = std::int64_t(64) << 20;

// A file of which every read is checked against its end.
class Walker {
  public:
    explicit Walker(const std::string& path) : path_(path) {
        try {
            require_file(path);
        } catch (const InputError& error) {
            fail(error.what());
        }
        file_.open(path, std::ios::binary | std::ios::ate);
        if (!file_) fail(std::string("cannot be opened: ") + std::strerror(errno));
        size_ = std::int64_t(file_.tellg());
        file_.seekg(0);
        if (size_ < 0 || !file_) fail("cannot be read");
    }
    [[noreturn]] void fail(const std::string& message) const { throw InputError(message, {path_, 0}); }

    std::int64_t size() const { return size_; }
    std::int64_t left() { return size_ - std::int64_t(file_.tellg()); }
    void read(void* data, std::int64_t bytes) {
        if (bytes > left()) fail("damaged OpenEXR file: cut short in its header");
        file_.read(static_cast<char*>(data), bytes);
        if (!file_) fail("damaged OpenEXR file: cannot be read");
    }
    template <typename T>
    T number() {
        T value;
        read(&value, sizeof(value));
        return value;
    }
    /// A text that ends with a zero byte, of at most 255 characters.
    std::string text() {
        std::string s;
        for (char c = number<char>(); c != 0; c = number<char>()) {
            if (s.size() == 255) fail("damaged OpenEXR file: a name without end in its header");
            s += c;
        }
        return s;
    }
    void seek(std::int64_t position) { file_.seekg(position); }
    std::int64_t position() { return std::int64_t(file_.tellg()); }

  private:
    std::string path_;
    std::ifstream file_;
    std::int64_t size_ = 0;
};

struct Part {
    std::optional<std::array<std::int32_t, 4>> data_window;  // x min, y min, x max, y max, inclusive
    std::optional<std::uint8_t> compression;
    std::optional<std::array<std::uint32_t, 2>> tile;
    std::uint8_t tile_mode = 0;
    std::int64_t channels = 0, bytes_per_pixel = 0;
    std::string type;

    std::int64_t width() const { return std::int64_t((*data_window)[2]) - (*data_window)[0] + 1; }
    std::int64_t height() const { return std::int64_t((*data_window)[3]) - (*data_window)[1] + 1; }
};

void read_channels(Walker& walker, Part& part) {
    for (std::string name = walker.text(); !name.empty(); name = walker.text()) {
        const auto type = walker.number<std::int32_t>();
        walker.number<std::uint32_t>();  // linearity and padding
        const auto x_sampling = walker.number<std::int32_t>(), y_sampling = walker.number<std::int32_t>();
        if (type < 0 || type > 2 || x_sampling < 1 || y_sampling < 1)
            walker.fail("damaged OpenEXR file: channel '" + printable(name) + "' of an unknown kind");
        part.bytes_per_pixel += type == 1 ? 2 : 4;
        if (++part.channels > max_channels)
            walker.fail("OpenEXR file with more than " + std::to_string(max_channels) + " channels");
    }
}

void read_attribute(Walker& walker, const std::string& name, std::int64_t size, Part& part) {
    if (name == "channels") {
        read_channels(walker, part);
    } else if (name == "dataWindow" && size == 16) {
        part.data_window.emplace();
        for (std::int32_t& edge : *part.data_window) edge = walker.number<std::int32_t>();
    } else if (name == "compression" && size == 1) {
        part.compression = walker.number<std::uint8_t>();
    } else if (name == "tiles" && size == 9) {
        part.tile.emplace();
        for (std::uint32_t& edge : *part.tile) edge = walker.number<std::uint32_t>();
        part.tile_mode = walker.number<std::uint8_t>();
    } else if (name == "type" && size <= 64) {
        part.type.resize(std::size_t(size));
        walker.read(part.type.data(), size);
    }
}

// Reads one header; nothing when it is the empty one that ends a list of parts.
std::optional<Part> read_part(Walker& walker) {
    Part part;
    std::set<std::string> seen;
    for (std::string name = walker.text(); !name.empty(); name = walker.text()) {
        walker.text();  // the attribute's type
        const auto size = std::int64_t(walker.number<std::int32_t>());
        if (size < 0 || size > walker.left())
            walker.fail("damaged OpenEXR file: attribute '" + printable(name) + "' is longer than the file");
        const std::int64_t end = walker.position() + size;
        if (!seen.insert(name).second)
            walker.fail("damaged OpenEXR file: attribute '" + printable(name) + "' is there twice");
        if (std::int64_t(seen.size()) > max_attributes)
            walker.fail("OpenEXR file with more than " + std::to_string(max_attributes) + " attributes");
        read_attribute(walker, name, size, part);
        if (walker.position() > end)
            walker.fail("damaged OpenEXR file: attribute '" + printable(name) + "' is longer than it says");
        walker.seek(end);
    }
    if (seen.empty()) return std::nullopt;
    return part;
}

std::int64_t tiles_along(std::int64_t length, std::int64_t tile) { return (length + tile - 1) / tile; }

// Tiles of all levels; every level halves the sizes, rounding up (rounding down has fewer).
std::int64_t count_tiles(const Part& part) {
    const std::int64_t tw = (*part.tile)[0], th = (*part.tile)[1];
    std::int64_t w = part.width(), h = part.height();
    const int mode = part.tile_mode & 15;
    std::int64_t columns = tiles_along(w, tw), rows = tiles_along(h, th), count = columns * rows;
    if (mode == 1) {  // mip map: both sizes together
        // The smallest number of chunks that a sound file of this kind can have is wanted, so halves are
        // rounded down here.
        while (w > 1 || h > 1) {
            w = std::max<std::int64_t>(1, w / 2), h = std::max<std::int64_t>(1, h / 2);
            count += tiles_along(w, tw) * tiles_along(h, th);
        }
    } else if (mode == 2) {  // rip map: every combination
        for (std::int64_t v = w; v > 1;) v = std::max<std::int64_t>(1, v / 2), columns += tiles_along(v, tw);
        for (std::int64_t v = h; v > 1;) v = std::max<std::int64_t>(1, v / 2), rows += tiles_along(v, th);
        count = columns * rows;
    }
    return count;
}

void check_sizes(const Walker& walker, const Part& part) {
    if (!part.data_window || !part.compression || part.channels == 0)
        walker.fail("damaged OpenEXR file: a header without channels, dataWindow or compression");
    if (*part.compression >= compressions.size())
        walker.fail("OpenEXR file with unknown compression " + std::to_string(*part.compression));
    for (const std::int32_t edge : *part.data_window)
        if (edge < -(1 << 30) || edge > (1 << 30)) walker.fail("damaged OpenEXR file: absurd dataWindow");
    const std::int64_t width = part.width(), height = part.height();
    const std::string size_text = std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1) walker.fail("damaged OpenEXR file: a picture of " + size_text + " pixels");
    if (width > max_pixels / height)
        walker.fail("OpenEXR file declares " + size_text + " pixels: more than " +
                    std::to_string(max_pixels));
    const std::int64_t pixels = width * height;
    if (pixels * part.channels * 4 > max_plane_bytes)
        walker.fail("OpenEXR file declares " + size_text + " pixels of " + std::to_string(part.channels) +
                    " channels: more than 4 GiB");

    const Compression& compression = compressions[*part.compression];
    std::int64_t chunks = tiles_along(height, compression.lines_per_chunk);
    std::int64_t chunk_pixels = width * compression.lines_per_chunk;
    if (part.tile) {
        const std::int64_t tw = (*part.tile)[0], th = (*part.tile)[1];
        if (tw < 1 || th < 1 || tw > max_pixels / th)
            walker.fail("damaged OpenEXR file: tiles of " + std::to_string(tw) + " x " + std::to_string(th));
        chunks = count_tiles(part);
        chunk_pixels = tw * th;
    }
    if (chunk_pixels * part.bytes_per_pixel > max_chunk_bytes)
        walker.fail("OpenEXR file declares chunks of more than 1 GiB");
    if (chunks > walker.size() / min_bytes_per_chunk)
        walker.fail("damaged OpenEXR file: " + size_text + " pixels in " + std::to_string(chunks) +
                    " chunks do not fit in " + std::to_string(walker.size()) + " bytes");
    const std::int64_t declared = pixels * part.bytes_per_pixel;
    if (declared > always_allowed_bytes && declared / compression.max_ratio > walker.size())
        walker.fail("damaged OpenEXR file: " + size_text + " pixels with compression '" + compression.name +
                    "' do not fit in " + std::to_string(walker.size()) + " bytes");
}

}  // namespace

ExrSummary check_exr_header(const std::string& path) {
    Walker walker(path);
    if (walker.size() < 8 || walker.number<std::uint32_t>() != 20000630u) walker.fail("not an OpenEXR file");
    const auto version = walker.number<std::uint32_t>();
    if ((version & 0xffu) != 2u)
        walker.fail("OpenEXR file of format " + std::to_string(version & 0xffu) + ", which is not known");
    const bool single_tiled = (version & 0x200u) != 0, non_image = (version & 0x800u) != 0,
               multi_part = (version & 0x1000u) != 0;

    std::vector<Part> parts;
    while (std::optional<Part> part = read_part(walker)) {
        parts.push_back(std::move(*part));
        if (!multi_part) break;
        if (std::int64_t(parts.size()) > max_parts)
            walker.fail("OpenEXR file with more than " + std::to_string(max_parts) + " parts");
    }
    if (parts.empty()) walker.fail("damaged OpenEXR file: no header");

    std::optional<ExrSummary> summary;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Part& part = parts[i];
        check_sizes(walker, part);  // also of parts that will not be read: the library opens them all
        const bool deep = part.type.rfind("deep", 0) == 0 || (non_image && !multi_part);
        if (deep || summary) continue;
        const bool tiled = part.type == "tiledimage" || (part.type.empty() && single_tiled);
        if (tiled && !part.tile) walker.fail("damaged OpenEXR file: tiled, but without the size of a tile");
        summary = ExrSummary{int(i),
                             part.width(),
                             part.height(),
                             part.channels,
                             tiled,
                             tiled && (part.tile_mode & 15) != 0,
                             int(parts.size()),
                             compressions[*part.compression].name};
    }
    if (!summary) walker.fail("OpenEXR file of deep data, which is not supported");
    return *summary;
}

}  // namespace mote::core
