// Mitsuba's serialized meshes: a header, then one zlib stream for each mesh, then a table of where they
// begin.
//
//   file  = mesh... table; little-endian throughout
//   mesh  = u16 0x041C, u16 version (3 or 4), zlib of:
//           u32 flags, [version 4: name, ends in 0], u64 vertices, u64 triangles,
//           positions, [normals], [texture coordinates], [colours]: all float or all double; u32 corners
//   table = the meshes' offsets, u32 (version 3) or u64 (version 4); u32 count
//
// Nothing is allocated by what the stream declares before it is known that the file can hold as much.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "core/formats/meshes/mesh_file.h"

namespace mote::core {
namespace {

constexpr std::uint16_t file_identifier = 0x041c;
enum Flag : std::uint32_t {
    has_normals = 0x0001,
    has_uvs = 0x0002,
    has_colours = 0x0008,
    face_normals_requested = 0x0010,
    double_precision = 0x2000
};
/// zlib packs at most 1032 bytes into one. Meshes get nowhere near: large ones that claim to are refused.
constexpr std::uint64_t max_packed = 1032, max_packed_large = 100, large = 256u << 20;
constexpr std::size_t longest_name = 4096;

template <typename T>
T number_at(std::string_view bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

/// Bytes out of a zlib stream, as many as are requested.
class Inflater {
  public:
    Inflater(std::string_view packed, const SourceLocation& where) : where_(where) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
        stream_.avail_in = uInt(std::min<std::size_t>(packed.size(), 0xffffffffu));
        if (inflateInit(&stream_) != Z_OK) throw InputError("zlib cannot start", where_);
    }
    ~Inflater() { inflateEnd(&stream_); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    void read(void* to, std::size_t size) {
        for (auto* bytes = static_cast<Bytef*>(to); size > 0;) {
            const auto part = uInt(std::min<std::size_t>(size, 1u << 30));
            stream_.next_out = bytes, stream_.avail_out = part;
            const int status = inflate(&stream_, Z_SYNC_FLUSH);
            const uInt got = part - stream_.avail_out;
            if (got == 0)
                throw InputError(status == Z_STREAM_END || status == Z_BUF_ERROR
                                     ? "the file ends too early"
                                     : "the compressed data of the mesh are damaged",
                                 where_);
            bytes += got, size -= got;
        }
    }
    template <typename T>
    T number() {
        T value;
        read(&value, sizeof(T));
        return value;
    }

  private:
    z_stream stream_{};
    SourceLocation where_;
};

class SerializedReader {
  public:
    SerializedReader(std::string_view bytes, const std::string& path) : bytes_(bytes), where_{path, 0} {}

    MeshFile read(std::int64_t shape_index) {
        const std::string_view packed = mesh_at(shape_index);
        Inflater stream(packed, where_);
        flags_ = stream.number<std::uint32_t>();
        if (version_ == 4) skip_name(stream);
        const auto vertices = stream.number<std::uint64_t>(), triangles = stream.number<std::uint64_t>();
        check_sizes(vertices, triangles, packed.size());
        read_arrays(stream, std::size_t(vertices), std::size_t(triangles));
        if (flags_ & face_normals_requested)
            file_.notes.push_back(
                "the file requests face normals, which has no effect (nor has it in Mitsuba 3): set "
                "face_normals");
        return std::move(file_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError(message, where_); }

    void check_header(std::size_t at) {
        if (at + 4 > bytes_.size() || number_at<std::uint16_t>(bytes_, at) != file_identifier)
            fail(at == 0 ? "not a file of serialized meshes" : "the table of meshes points to no mesh");
        version_ = number_at<std::uint16_t>(bytes_, at + 2);
        if (version_ != 3 && version_ != 4)
            fail("version " + std::to_string(version_) + " of serialized meshes is not known, 3 and 4 are");
    }

    /// The compressed bytes of a mesh and all that follows it.
    std::string_view mesh_at(std::int64_t index) {
        check_header(0);
        std::size_t at = 0;
        if (index > 0) {
            const std::size_t entry = version_ == 4 ? 8 : 4;
            if (bytes_.size() < 8) fail("the file ends too early");
            const std::uint64_t count = number_at<std::uint32_t>(bytes_, bytes_.size() - 4);
            if (count > (bytes_.size() - 4) / entry) fail("the table of meshes is damaged");
            if (std::uint64_t(index) >= count)
                fail("there is no mesh " + std::to_string(index) + ": the file holds " +
                     std::to_string(count));
            const std::size_t place = bytes_.size() - 4 - entry * std::size_t(count - std::uint64_t(index));
            const std::uint64_t offset = version_ == 4 ? number_at<std::uint64_t>(bytes_, place)
                                                       : number_at<std::uint32_t>(bytes_, place);
            if (offset > bytes_.size() - 4) fail("the table of meshes is damaged");
            at = std::size_t(offset);
            check_header(at);
        }
        return bytes_.substr(at + 4);
    }

    void skip_name(Inflater& stream) const {
        for (std::size_t i = 0; stream.number<char>() != '\0'; ++i)
            if (i >= longest_name) fail("the name of the mesh does not end");
    }

    void check_sizes(std::uint64_t vertices, std::uint64_t triangles, std::uint64_t packed) const {
        constexpr std::uint64_t most = 0xfffffffeu;
        if (vertices > most || triangles > most)
            fail("a mesh of " + std::to_string(vertices) + " vertices and " + std::to_string(triangles) +
                 " triangles is too large");
        const std::uint64_t numbers = 3u + (flags_ & has_normals ? 3u : 0u) + (flags_ & has_uvs ? 2u : 0u) +
                                      (flags_ & has_colours ? 3u : 0u);
        const std::uint64_t size =
            vertices * numbers * (flags_ & double_precision ? 8u : 4u) + triangles * 12u;
        if (size > packed * max_packed || (size > large && size > packed * max_packed_large))
            fail("the file is too short for " + std::to_string(vertices) + " vertices and " +
                 std::to_string(triangles) + " triangles");
    }

    void read_arrays(Inflater& stream, std::size_t vertices, std::size_t triangles) {
        MeshData& data = file_.data;
        read_vectors(stream, data.positions, vertices);
        if (flags_ & has_normals) read_vectors(stream, data.normals, vertices);
        if (flags_ & has_uvs) read_vectors(stream, data.uvs, vertices);
        if (flags_ & has_colours)
            read_vectors(stream,
                         data.attributes.emplace_back(MeshAttribute{"vertex_color", false, {}}).values,
                         vertices);
        data.triangles.resize(triangles);
        stream.read(data.triangles.data(), triangles * sizeof(data.triangles[0]));
    }

    template <typename Vec>
    void read_vectors(Inflater& stream, std::vector<Vec>& to, std::size_t count) const {
        to.resize(count);
        if (!(flags_ & double_precision)) {
            stream.read(to.data(), count * sizeof(Vec));
            return;
        }
        glm::vec<Vec::length(), double> value;
        for (Vec& v : to) {
            stream.read(&value, sizeof(value));
            v = Vec(value);
        }
    }

    std::string_view bytes_;
    SourceLocation where_;
    std::uint16_t version_ = 0;
    std::uint32_t flags_ = 0;
    MeshFile file_;
};

}  // namespace

MeshFile read_serialized(std::string_view bytes, const std::string& path, std::int64_t shape_index) {
    return SerializedReader(bytes, path).read(shape_index);
}

}  // namespace mote::core
