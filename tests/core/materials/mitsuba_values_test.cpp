// BSDFs of the scene language have the values and densities of Mitsuba 3.9.1, kept in mitsuba_values.txt.
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <sstream>

#include "core/scene/scene.h"
#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using core::Rgb;
using core::TransportMode;
using core::Vec2;
using core::Vec3;

namespace {

struct Pair {
    Vec3 wo, wi;
    Vec2 uv;
    TransportMode mode;
    Rgb f;
    float pdf;
};

struct Table {
    std::string type, xml;
    std::vector<Pair> pairs;
};

std::vector<Table> read_tables() {
    std::ifstream file(MOTE_SOURCE_DIR "/tests/core/materials/mitsuba_values.txt");
    std::vector<Table> tables;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("bsdf ")) {
            const auto type = line.find("type=\"") + 6;
            tables.push_back({line.substr(type, line.find('"', type) - type), line.substr(5), {}});
            continue;
        }
        Pair p;
        char mode = ' ';
        std::istringstream words(line);
        for (Vec3* v : {&p.wo, &p.wi}) words >> v->x >> v->y >> v->z;
        words >> p.uv.x >> p.uv.y >> mode >> p.f.x >> p.f.y >> p.f.z >> p.pdf;
        REQUIRE(words);
        p.mode = mode == 'r' ? TransportMode::radiance : TransportMode::power;
        tables.back().pairs.push_back(p);
    }
    return tables;
}

std::shared_ptr<const core::Bsdf> bsdf_from(const std::string& xml) {
    const auto scene = tests::scene_from(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"constant\"/><shape "
        "type=\"sphere\">" +
        xml + "</shape></scene>");
    return scene->parts().shapes.at(0)->bsdf;
}

/// Both are single precision and divide by different small numbers. Mitsuba's masking of Beckmann facets is
/// an approximation within 0.35 %, once for each direction, and the tables of rough plastic are quadratures.
double tolerance_of(const Table& table) {
    if (table.type == "roughplastic") return 0.01;
    return 2e-3;
}

double difference(double ours, double theirs) {
    const double larger = std::max(std::fabs(ours), std::fabs(theirs));
    return larger > 1e-5 ? std::fabs(ours - theirs) / larger : 0.0;
}

/// The largest relative difference among all pairs, of values or of densities.
double worst(const core::Bsdf& bsdf, const Table& table, bool of_density, std::string& where) {
    double result = 0.0;
    for (std::size_t i = 0; i < table.pairs.size(); ++i) {
        const Pair& p = table.pairs[i];
        const Rgb f = bsdf.eval({p.uv}, p.wo, p.wi, p.mode);
        const float pdf = bsdf.pdf_solid_angle({p.uv}, p.wo, p.wi, p.mode);
        // Mitsuba's "principled" claims a density from behind opaque surfaces, though it samples nothing
        // there.
        if (of_density && p.wo.z < 0.0f && !bsdf.traits().transmissive) continue;
        for (int k = 0; k < 3; ++k) {
            const double d = of_density ? difference(double(pdf), double(p.pdf))
                                        : difference(double(f[k]), double(p.f[k]));
            if (d <= result) continue;
            result = d;
            where = fmt::format("{} pair {}: ours {} {} {} pdf {}, Mitsuba's {} {} {} pdf {}", table.xml, i,
                                f.x, f.y, f.z, pdf, p.f.x, p.f.y, p.f.z, p.pdf);
        }
    }
    return result;
}

}  // namespace

TEST_CASE("BSDFs of the scene language have Mitsuba's values", "[materials][mitsuba]") {
    std::map<std::string, int> lit;
    for (const Table& table : read_tables()) {
        const auto bsdf = bsdf_from(table.xml);
        for (const Pair& p : table.pairs) lit[table.type] += p.f.x > 0.0f;
        for (const bool of_density : {false, true}) {
            std::string where;
            const double difference = worst(*bsdf, table, of_density, where);
            CAPTURE(of_density, where);
            CHECK(difference <= tolerance_of(table));
        }
    }
    for (const auto& [type, count] : lit) {
        CAPTURE(type);
        CHECK(count > 20);
    }
}
