// Stanford PLY, ASCII and binary: vertex positions, normals, texture coordinates, and faces.
//
// Nothing is allocated by what the header declares before the file was found to be long enough to hold it.
#include <algorithm>
#include <bit>
#include <cstring>

#include "core/formats/meshes/mesh_file.h"
#include "core/formats/meshes/ply_attributes.h"
#include "core/formats/meshes/text_scanner.h"
#include "core/geometry/polygon_triangulation.h"

namespace mote::core {
namespace {

enum class Number { i8, u8, i16, u16, i32, u32, f32, f64 };
constexpr std::size_t number_size[] = {1, 1, 2, 2, 4, 4, 4, 8};
constexpr double largest_number[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 0, 0};  // of integers

struct Property {
    std::string name;
    Number type;
    std::optional<Number> count;  // of a list
};
struct Element {
    std::string name;
    std::uint64_t count;
    std::vector<Property> properties;
};

std::optional<Number> number_type(std::string_view name) {
    static constexpr std::pair<std::string_view, Number> names[] = {
        {"char", Number::i8},   {"int8", Number::i8},     {"uchar", Number::u8},   {"uint8", Number::u8},
        {"short", Number::i16}, {"int16", Number::i16},   {"ushort", Number::u16}, {"uint16", Number::u16},
        {"int", Number::i32},   {"int32", Number::i32},   {"uint", Number::u32},   {"uint32", Number::u32},
        {"float", Number::f32}, {"float32", Number::f32}, {"double", Number::f64}, {"float64", Number::f64},
    };
    for (const auto& [known, type] : names)
        if (known == name) return type;
    return std::nullopt;
}

class PlyReader {
  public:
    PlyReader(std::string_view bytes, const std::string& path, bool flip_v)
        : where_{path, 0}, flip_v_(flip_v), rest_(bytes), scanner_({}) {}

    MeshFile read() {
        read_header();
        scanner_ = TextScanner(rest_);
        for (const Element& element : elements_) read_element(element);
        if (!has_normals_) file_.data.normals.clear();
        if (!has_uvs_) file_.data.uvs.clear();
        triangulate();
        return std::move(file_);
    }

    PlyCounts count(std::uint64_t size) {
        read_header();
        PlyCounts counts;
        for (const Element& element : elements_) {
            const std::uint64_t rows =
                std::min(element.count, size / std::max<std::size_t>(min_row_size(element), 1));
            if (element.name == "vertex") counts.vertices = rows;
            if (element.name == "face") counts.faces = rows;
        }
        return counts;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { throw InputError(message, where_); }

    std::string_view header_line() {
        const std::size_t end = rest_.find('\n');
        if (end == std::string_view::npos || end > 4096) fail("the PLY header does not end");
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        ++where_.line;
        return line;
    }

    void read_header() {
        if (header_line() != "ply") fail("not a PLY file");
        bool format_known = false;
        for (;;) {
            TextScanner line(header_line());
            const std::string_view keyword = line.word();
            if (keyword == "end_header") break;
            if (keyword == "format") {
                const std::string_view format = line.word();
                ascii_ = format == "ascii", big_endian_ = format == "binary_big_endian";
                format_known = ascii_ || big_endian_ || format == "binary_little_endian";
                if (!format_known) fail("unknown PLY format '" + printable(format) + "'");
            } else if (keyword == "element") {
                read_element_declaration(line);
            } else if (keyword == "property") {
                read_property_declaration(line);
            } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
                fail("unknown word '" + printable(keyword) + "' in the PLY header");
            }
        }
        if (!format_known) fail("the PLY header names no format");
        where_.line = 0;
    }

    void read_element_declaration(TextScanner& line) {
        Element element{std::string(line.word()), 0, {}};
        const std::string_view count = line.word();
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc() || end != count.data() + count.size() || count.empty())
            fail("malformed count of element '" + printable(element.name) + "'");
        elements_.push_back(std::move(element));
    }

    void read_property_declaration(TextScanner& line) {
        if (elements_.empty()) fail("a property before any element in the PLY header");
        std::string_view word = line.word();
        Property property{};
        if (word == "list") {
            property.count = type_of(line.word());
            word = line.word();
        }
        property.type = type_of(word);
        property.name = std::string(line.word());
        elements_.back().properties.push_back(std::move(property));
    }

    Number type_of(std::string_view name) const {
        const auto type = number_type(name);
        if (!type) fail("unknown number type '" + printable(name) + "' in the PLY header");
        return *type;
    }

    /// The least number of bytes that one row of the element takes.
    std::size_t min_row_size(const Element& element) const {
        std::size_t size = 0;
        for (const Property& p : element.properties)
            size += ascii_ ? 2 : number_size[std::size_t(p.count.value_or(p.type))];
        return size;
    }

    void read_element(const Element& element) {
        const std::size_t row = min_row_size(element);
        if (row == 0) return;
        // The last number of an ASCII file needs no space behind it.
        if (element.count > (remaining() + 1) / row)
            fail("the file is too short for " + std::to_string(element.count) + " rows of element '" +
                 printable(element.name) + "'");
        if (element.name == "vertex") {
            read_vertices(element);
        } else if (element.name == "face") {
            read_faces(element);
        } else {
            for (std::uint64_t i = 0; i < element.count; ++i)
                for (const Property& p : element.properties) skip(p);
        }
    }

    void read_vertices(const Element& element) {
        if (!file_.data.positions.empty()) fail("two vertex elements in one PLY file");
        enum Slot { x, y, z, nx, ny, nz, u, v, slots };
        const auto slot_of = [](std::string_view name) -> int {
            if (name == "s" || name == "texture_u") return u;
            if (name == "t" || name == "texture_v") return v;
            static constexpr std::string_view names[] = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
            return int(std::find(std::begin(names), std::end(names), name) - std::begin(names));
        };
        bool present[slots + 1] = {};
        for (const Property& p : element.properties)
            if (!p.count) present[slot_of(p.name)] = true;
        if (!present[x] || !present[y] || !present[z]) fail("the vertices have no x, y and z");
        has_normals_ = present[nx] && present[ny] && present[nz];
        has_uvs_ = present[u] && present[v];
        std::vector<int> slot;
        for (const Property& p : element.properties) slot.push_back(p.count ? slots : slot_of(p.name));
        const auto attributes =
            find_attributes(element, "vertex_", [&](std::size_t i) { return slot[i] == slots; });
        std::vector<double> row(element.properties.size());
        file_.data.positions.reserve(element.count);
        if (has_normals_) file_.data.normals.reserve(element.count);
        if (has_uvs_) file_.data.uvs.reserve(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            double values[slots + 1] = {};
            read_row(element, row);
            for (std::size_t k = 0; k < row.size(); ++k) values[slot[k]] = row[k];
            add_attributes(attributes, row, vertex_attributes_);
            file_.data.positions.emplace_back(float(values[x]), float(values[y]), float(values[z]));
            if (has_normals_)
                file_.data.normals.emplace_back(float(values[nx]), float(values[ny]), float(values[nz]));
            if (has_uvs_)
                file_.data.uvs.emplace_back(float(values[u]), float(flip_v_ ? 1.0 - values[v] : values[v]));
        }
    }

    void read_faces(const Element& element) {
        if (!corner_counts_.empty()) fail("two face elements in one PLY file");
        const auto attributes = find_attributes(element, "face_", [](std::size_t) { return true; });
        std::vector<double> row(element.properties.size());
        corner_counts_.reserve(element.count);
        corners_.reserve(
            std::min(3 * element.count, remaining() / sizeof(std::uint32_t)));  // mostly triangles
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (std::size_t k = 0; k < row.size(); ++k) {
                const Property& p = element.properties[k];
                if (!p.count)
                    row[k] = number(p.type);
                else if (p.name == "vertex_index" || p.name == "vertex_indices")
                    read_corners(p, i);
                else
                    skip(p);
            }
            if (corner_counts_.size() < i + 1) corner_counts_.push_back(0);
            if (corner_counts_.size() > i + 1)
                fail("face " + std::to_string(i) + " has two lists of vertices");
            add_attributes(attributes, row, face_attributes_);
        }
    }
    void read_corners(const Property& p, std::uint64_t face) {
        const std::size_t count = list_length(p);
        corner_counts_.push_back(std::uint32_t(count));
        for (std::size_t k = 0; k < count; ++k) corners_.push_back(vertex_index(number(p.type), face));
    }

    /// One value for every property; those of lists are left as they are.
    void read_row(const Element& element, std::vector<double>& row) {
        for (std::size_t k = 0; k < row.size(); ++k) {
            const Property& p = element.properties[k];
            if (p.count)
                skip(p);
            else
                row[k] = number(p.type);
        }
    }

    template <typename IsFree>
    static std::vector<PlyAttribute> find_attributes(const Element& element, const std::string& prefix,
                                                     const IsFree& is_free) {
        std::vector<PlyColumn> columns;
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const Property& p = element.properties[i];
            columns.push_back({p.name, largest_number[std::size_t(p.type)], !p.count && is_free(i)});
        }
        return find_ply_attributes(columns, prefix);
    }
    static void add_attributes(const std::vector<PlyAttribute>& attributes, const std::vector<double>& row,
                               std::vector<MeshAttribute>& to) {
        if (to.size() < attributes.size())
            for (const PlyAttribute& a : attributes) to.push_back({a.name, a.name.starts_with("face_"), {}});
        for (std::size_t i = 0; i < attributes.size(); ++i) {
            const auto& [x, y, z] = attributes[i].columns;
            to[i].values.push_back(Rgb(attributes[i].factor * Vec3d(row[x], row[y], row[z])));
        }
    }

    std::uint32_t vertex_index(double value, std::uint64_t face) const {
        if (!(value >= 0.0 && value < 4294967295.0) || value != std::floor(value))
            fail("face " + std::to_string(face) + " has a malformed vertex index");
        return std::uint32_t(value);
    }

    /// After all elements, for faces may stand before the vertices.
    void triangulate() {
        const std::span<const std::uint32_t> all(corners_);
        std::size_t begin = 0;
        file_.data.triangles.reserve(corner_counts_.size());
        std::vector<MeshAttribute> of_triangles;
        for (const MeshAttribute& a : face_attributes_) of_triangles.push_back({a.name, true, {}});
        for (std::size_t face = 0; face < corner_counts_.size(); ++face) {
            const auto polygon = all.subspan(begin, corner_counts_[face]);
            begin += polygon.size();
            for (const std::uint32_t vertex : polygon)
                if (vertex >= file_.data.positions.size())
                    fail("face " + std::to_string(face) + " refers to vertex " + std::to_string(vertex) +
                         " of " + std::to_string(file_.data.positions.size()));
            if (polygon.size() < 3) ++file_.other_dropped;
            triangulate_polygon(polygon, file_.data.positions, file_.data.triangles);
            for (std::size_t i = 0; i < of_triangles.size(); ++i)
                of_triangles[i].values.resize(file_.data.triangles.size(), face_attributes_[i].values[face]);
        }
        file_.data.attributes = std::move(vertex_attributes_);
        for (MeshAttribute& a : of_triangles) file_.data.attributes.push_back(std::move(a));
    }

    std::size_t remaining() const { return ascii_ ? scanner_.remaining() : rest_.size(); }

    std::size_t list_length(const Property& p) {
        const double length = number(*p.count);
        const std::size_t size = ascii_ ? 2 : number_size[std::size_t(p.type)];
        if (!(length >= 0.0) || length != std::floor(length) || length > double((remaining() + 1) / size))
            fail("a list of " + std::to_string(length) + " numbers does not fit into the file");
        return std::size_t(length);
    }
    void skip(const Property& p) {
        const std::size_t count = p.count ? list_length(p) : 1;
        for (std::size_t i = 0; i < count; ++i) number(p.type);
    }

    double number(Number type) {
        if (ascii_) {
            const auto value = scanner_.number();
            if (!value) fail(scanner_.remaining() == 0 ? "the file ends too early" : "expected a number");
            return *value;
        }
        switch (type) {
            case Number::i8:
                return double(raw<std::int8_t>());
            case Number::u8:
                return double(raw<std::uint8_t>());
            case Number::i16:
                return double(raw<std::int16_t>());
            case Number::u16:
                return double(raw<std::uint16_t>());
            case Number::i32:
                return double(raw<std::int32_t>());
            case Number::u32:
                return double(raw<std::uint32_t>());
            case Number::f32:
                return double(raw<float>());
            case Number::f64:
                return raw<double>();
        }
        return 0.0;
    }
    template <typename T>
    T raw() {
        if (rest_.size() < sizeof(T)) fail("the file ends too early");
        char bytes[sizeof(T)];
        std::memcpy(bytes, rest_.data(), sizeof(T));
        rest_.remove_prefix(sizeof(T));
        if (big_endian_ != (std::endian::native == std::endian::big)) std::reverse(bytes, bytes + sizeof(T));
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return value;
    }

    SourceLocation where_;
    bool flip_v_, ascii_ = false, big_endian_ = false, has_normals_ = false, has_uvs_ = false;
    std::string_view rest_;  // header, then binary data
    TextScanner scanner_;    // ASCII data
    std::vector<Element> elements_;
    std::vector<std::uint32_t> corner_counts_, corners_;
    std::vector<MeshAttribute> vertex_attributes_, face_attributes_;
    MeshFile file_;
};

}  // namespace

PlyCounts count_ply(std::string_view head, std::uint64_t size, const std::string& path) {
    return PlyReader(head, path, false).count(size);
}

MeshFile read_ply(std::string_view bytes, const std::string& path, bool flip_v) {
    return PlyReader(bytes, path, flip_v).read();
}

}  // namespace mote::core
