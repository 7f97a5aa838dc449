// Wavefront OBJ: positions, texture coordinates, normals and faces; everything else is passed over.
//
// A vertex of the mesh is a distinct triple of indices (position / texture / normal), numbered in the order
// of first use by a face, as Mitsuba numbers them.
#include <algorithm>

#include "core/formats/meshes/mesh_file.h"
#include "core/formats/meshes/text_scanner.h"
#include "core/geometry/polygon_triangulation.h"

namespace mote::core {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

class ObjReader {
  public:
    ObjReader(const std::string& path, bool flip_v) : where_{path, 0}, flip_v_(flip_v) {}

    MeshFile read(std::string text) {
        if (text.size() >= none) throw InputError("the file is too large", where_);
        if (text.find('\0') != std::string::npos)
            throw InputError("not an OBJ file in ASCII or UTF-8: it holds zero bytes", where_);
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = end_of_line(text, begin);
            read_line(std::string_view(text).substr(begin, end - begin));
            begin = end + 1;
        }
        if (!any_normal_) file_.data.normals.clear();
        if (!any_uv_) file_.data.uvs.clear();
        return std::move(file_);
    }

  private:
    struct Corner {
        std::uint32_t uv, normal, vertex, next;  // next: another vertex at the same position, or none
    };

    /// A backslash at its end joins a line with the next one.
    std::size_t end_of_line(std::string& text, std::size_t begin) {
        for (std::size_t from = begin;;) {
            ++where_.line;
            const std::size_t end = std::min(text.find('\n', from), text.size());
            std::size_t last = end;
            while (last > begin && text[last - 1] == '\r') --last;
            if (last == begin || text[last - 1] != '\\' || end == text.size()) return end;
            std::fill(text.begin() + std::ptrdiff_t(last - 1), text.begin() + std::ptrdiff_t(end) + 1, ' ');
            from = end;
        }
    }

    void read_line(std::string_view line) {
        TextScanner scanner(line);
        const std::string_view word = scanner.word();
        if (word == "v") {
            const double x = number(scanner), y = number(scanner), z = number(scanner);
            positions_.emplace_back(float(x), float(y), float(z));
            first_corner_.push_back(none);
            if (!is_finite(positions_.back()))
                throw InputError("vertex " + std::to_string(positions_.size()) + " is not finite", where_);
        } else if (word == "vt") {
            const double u = number(scanner), v = scanner.number().value_or(0.0);
            uvs_.emplace_back(float(u), float(flip_v_ ? 1.0 - v : v));
        } else if (word == "vn") {
            const double x = number(scanner), y = number(scanner), z = number(scanner);
            normals_.emplace_back(float(x), float(y), float(z));
        } else if (word == "f") {
            read_face(scanner);
        } else if (word == "l" || word == "p") {
            ++file_.other_dropped;
        }
    }

    void read_face(TextScanner& scanner) {
        polygon_.clear();
        for (std::string_view word = scanner.word(); !word.empty() && word[0] != '#'; word = scanner.word())
            polygon_.push_back(corner(word));
        if (polygon_.size() < 3) {
            ++file_.other_dropped;
            return;
        }
        triangulate_polygon(polygon_, file_.data.positions, file_.data.triangles);
    }

    /// The vertex for "p", "p/t", "p//n" or "p/t/n".
    std::uint32_t corner(std::string_view word) {
        std::uint32_t field[3] = {none, none, none};
        const std::size_t sizes[3] = {positions_.size(), uvs_.size(), normals_.size()};
        for (int i = 0; i < 3 && !word.empty(); ++i) {
            const std::size_t slash = std::min(word.find('/'), word.size());
            if (slash > 0) field[i] = index(word.substr(0, slash), sizes[i]);
            word.remove_prefix(std::min(slash + 1, word.size()));
        }
        if (field[0] == none || !word.empty()) throw InputError("a face has a malformed corner", where_);
        return vertex(field[0], field[1], field[2]);
    }

    /// 1-based, or negative: counted from the last element so far.
    std::uint32_t index(std::string_view text, std::size_t size) const {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            throw InputError("a face has a malformed index '" + printable(text, 40) + "'", where_);
        const std::int64_t zero_based = value > 0 ? value - 1 : std::int64_t(size) + value;
        if (value == 0 || zero_based < 0 || zero_based >= std::int64_t(size))
            throw InputError(
                "a face refers to element " + std::to_string(value) + " of " + std::to_string(size), where_);
        return std::uint32_t(zero_based);
    }

    std::uint32_t vertex(std::uint32_t position, std::uint32_t uv, std::uint32_t normal) {
        std::uint32_t* link = &first_corner_[position];
        while (*link != none && !(corners_[*link].uv == uv && corners_[*link].normal == normal))
            link = &corners_[*link].next;
        if (*link != none) return corners_[*link].vertex;
        const auto id = std::uint32_t(file_.data.positions.size());
        *link = std::uint32_t(corners_.size());  // before push_back, which may move what link points to
        corners_.push_back({uv, normal, id, none});
        file_.data.positions.push_back(positions_[position]);
        file_.data.uvs.push_back(uv == none ? Vec2(0.0f) : uvs_[uv]);
        file_.data.normals.push_back(normal == none ? Vec3(0.0f) : normals_[normal]);
        any_uv_ |= uv != none, any_normal_ |= normal != none;
        return id;
    }

    double number(TextScanner& scanner) const {
        const auto value = scanner.number();
        if (!value) throw InputError("expected a number", where_);
        return *value;
    }

    SourceLocation where_;
    bool flip_v_, any_uv_ = false, any_normal_ = false;
    std::vector<Vec3> positions_, normals_;  // as numbered in the file
    std::vector<Vec2> uvs_;
    std::vector<Corner> corners_;
    std::vector<std::uint32_t> first_corner_;  // by position: index into corners_, or none
    std::vector<std::uint32_t> polygon_;
    MeshFile file_;
};

}  // namespace

MeshFile read_obj(std::string text, const std::string& path, bool flip_v) {
    return ObjReader(path, flip_v).read(std::move(text));
}

}  // namespace mote::core
