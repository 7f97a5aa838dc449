// Shapes "bsplinecurve" and "linearcurve": control points from text files in Mitsuba's format, one a line
// with its radius; an empty line ends a curve.
#include "core/files/whole_file.h"
#include "core/formats/meshes/text_scanner.h"
#include "core/formats/register_formats.h"
#include "core/geometry/curves.h"
#include "core/geometry/shape_plugins.h"

namespace mote::core {
namespace {

class CurveReader {
  public:
    CurveReader(CurveBasis basis, const std::string& path, const Transform& to_world)
        : order_(basis == CurveBasis::linear ? 2 : 4), where_{path, 0}, to_world_(to_world) {
        data_.basis = basis;
    }

    CurveData read(std::string_view text) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++where_.line;
            read_line(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        end_curve();
        where_.line = 0;
        if (data_.segments.empty()) throw InputError("the file holds no curve", where_);
        return std::move(data_);
    }

  private:
    void read_line(std::string_view line) {
        TextScanner scanner(line);
        double values[4];
        for (int i = 0; i < 4; ++i) {
            const std::string_view word = scanner.word();
            if (word.empty() && i == 0) return end_curve();
            const auto value = TextScanner::parse_number(word);
            if (!value || !std::isfinite(*value))
                throw InputError("a control point is x y z and a radius" +
                                     (word.empty() ? "" : ", not '" + printable(word) + "'"),
                                 where_);
            values[i] = *value;
        }
        if (values[3] < 0.0) throw InputError("the radius of a control point is negative", where_);
        data_.points.emplace_back(Vec3(to_world_.point({values[0], values[1], values[2]})), float(values[3]));
    }

    void end_curve() {
        const std::size_t count = data_.points.size() - begin_;
        if (count > 0 && count < order_)
            throw InputError("a curve needs " + std::to_string(order_) + " control points and has " +
                                 std::to_string(count),
                             where_);
        for (std::size_t i = 0; i + order_ <= count; ++i) data_.segments.push_back(std::uint32_t(begin_ + i));
        begin_ = data_.points.size();
    }

    std::size_t order_, begin_ = 0;
    SourceLocation where_;
    Transform to_world_;
    CurveData data_;
};

struct CurveFileSettings {
    FileName file;
    Transform to_world;
};

template <CurveBasis Basis>
std::shared_ptr<Object> make_curves(const CurveFileSettings& s) {
    try {
        const std::vector<std::byte> bytes = read_whole_file(s.file.path);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        return std::make_shared<Curves>(CurveReader(Basis, s.file.path, s.to_world).read(text));
    } catch (const InputError& error) {
        if (!error.where().file.empty()) throw;
        throw InputError(error.what(), {s.file.path, 0});
    }
}

template <CurveBasis Basis>
void add_curves(Registry& registry, const std::string& type, const std::string& summary) {
    add_type<CurveFileSettings>(
        registry, Category::shape, type,
        summary +
            " The file holds a control point a line, x y z and the radius, and an empty line between curves. "
            "Curves are met from outside only; they take no light and no medium.",
        {row("filename", &CurveFileSettings::file, "The file, relative to the scene file.").required(),
         row("to_world", &CurveFileSettings::to_world,
             "Any affine transform of the control points; radii stay as they are.")},
        "<shape type=\"" + type + R"(">
    <string name="filename" value="hair.txt"/>
</shape>)",
        make_curves<Basis>);
}

}  // namespace

void register_curve_files(Registry& registry) {
    add_curves<CurveBasis::b_spline>(
        registry, "bsplinecurve",
        "Round tubes along uniform cubic B-splines, at least four control points each, cut off at the ends.");
    add_curves<CurveBasis::linear>(
        registry, "linearcurve",
        "Round tubes along straight pieces, at least two control points, with round joints and ends. Pieces "
        "shorter than about 0.01 are met inexactly near their joints (by Embree).");
}

}  // namespace mote::core
