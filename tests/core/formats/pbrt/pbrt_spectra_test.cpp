// Spectra, mappings, curves and subdivision of pbrt scenes against closed forms.
#include <cmath>

#include "core/film/bitmap.h"
#include "core/formats/pbrt/pbrt_curves.h"
#include "core/formats/pbrt/pbrt_equal_area.h"
#include "core/formats/pbrt/pbrt_meshes.h"
#include "core/formats/pbrt/pbrt_spectra.h"
#include "core/formats/pictures/image_file.h"
#include "tests/core/formats/pbrt/pbrt_folder.h"

using namespace mote::core;
using namespace mote::tests;
using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;

namespace {

/// A shape with its parameters, from text.
PbrtObject object(const std::string& type, const std::string& parameters) {
    PbrtText text(parameters, "test");
    PbrtObject o;
    o.type = type, o.parameters = read_pbrt_parameters(text, "srgb");
    return o;
}

struct Spectra {
    ConvertedScene scene{{}, ConversionReport("test"), {}};
    ConversionOptions options;
    PbrtFolder folder;
    PbrtFiles files{folder.file("scene.pbrt"), folder.file(""), options, scene};
    Rgb light(const std::string& parameter) {
        return pbrt_light_color(object("light", parameter), "L", files);
    }
    Rgb color(const std::string& parameter) {
        return *pbrt_color(object("material", parameter), "L", files, false);
    }
};

/// CIE chromaticity of linear sRGB (IEC 61966-2-1).
Vec2 chromaticity(const Rgb& c) {
    const Vec3d xyz(0.412456 * c.x + 0.357576 * c.y + 0.180437 * c.z,
                    0.212673 * c.x + 0.715152 * c.y + 0.072175 * c.z,
                    0.019334 * c.x + 0.119192 * c.y + 0.950304 * c.z);
    return Vec2(Vec3(xyz / (xyz.x + xyz.y + xyz.z)));
}

}  // namespace

TEST_CASE("Black bodies have the chromaticities of the Planckian locus", "[pbrt][spectrum]") {
    // Tabulated locus (CIE 1931): Wyszecki and Stiles 1982, Table I(6.5.1). The fit of the matching functions
    // errs by less than 0.005.
    struct Row {
        double kelvin;
        float x, y;
    };
    for (const Row& row : {Row{2856, 0.4476f, 0.4074f}, Row{4000, 0.3805f, 0.3768f},
                           Row{6504, 0.3135f, 0.3237f}, Row{10000, 0.2807f, 0.2884f}}) {
        const Rgb c = pbrt_blackbody(row.kelvin);
        CAPTURE(row.kelvin);
        CHECK_THAT(chromaticity(c).x, WithinAbs(row.x, 0.005));
        CHECK_THAT(chromaticity(c).y, WithinAbs(row.y, 0.005));
        CHECK_THAT(luminance(c), WithinRel(1.0f, 1e-4f));
    }
    // Near D65, which is white.
    const Rgb noon = pbrt_blackbody(6504.0);
    for (int i = 0; i < 3; ++i) CHECK_THAT(noon[i], WithinAbs(1.0, 0.06));
}

TEST_CASE("Lights of pbrt: rgb as it is, everything else of luminance 1", "[pbrt][spectrum]") {
    Spectra s;
    CHECK(s.light("\"rgb L\" [2 3 4]") == Rgb(2, 3, 4));
    CHECK(s.light("\"blackbody L\" 2800") == pbrt_blackbody(2800.0));
    const Rgb white = s.light("\"spectrum L\" \"stdillum-D65\"");
    for (int i = 0; i < 3; ++i) CHECK_THAT(white[i], WithinAbs(1.0, 0.002));
    const Rgb incandescent = s.light("\"spectrum L\" \"stdillum-A\""), body = pbrt_blackbody(2856.0);
    for (int i = 0; i < 3; ++i) CHECK_THAT(incandescent[i], WithinAbs(body[i], 0.05));
    for (const char* scale : {"1", "50"}) {
        const Rgb table = s.light(std::string("\"spectrum L\" [400 ") + scale + " 700 " + scale + "]");
        CHECK_THAT(luminance(table), WithinRel(1.0f, 1e-4f));
    }
    s.folder.write("lamp.spd", "# a lamp\n400 2\n500 2\n700 2\n");
    CHECK_THAT(luminance(s.light("\"spectrum L\" \"lamp.spd\"")), WithinRel(1.0f, 1e-4f));
    CHECK_THROWS_AS(s.light("\"spectrum L\" [500 1 400 1]"), InputError);
    CHECK_THROWS_AS(s.light("\"rgb L\" [1 -1 1]"), InputError);
    CHECK_THROWS_AS(s.light("\"blackbody L\" 0"), InputError);
}

TEST_CASE("Coefficients by name and table", "[pbrt][spectrum]") {
    Spectra s;
    CHECK_THAT(s.color("\"spectrum L\" \"metal-Au-k\"").x, WithinRel(3.983f, 1e-4f));
    CHECK(s.color("\"spectrum L\" \"glass-BK7\"") == Rgb(1.5168f));
    const Rgb flat = s.color("\"spectrum L\" [300 1.33 900 1.33]");
    for (int i = 0; i < 3; ++i) CHECK_THAT(flat[i], WithinRel(1.33f, 1e-4f));
    CHECK(pbrt_index_of_refraction(object("material", "\"float eta\" 1.7"), "eta", 1.5, s.files) == 1.7f);
    CHECK(pbrt_index_of_refraction(object("material", ""), "eta", 1.5, s.files) == 1.5);
}

TEST_CASE("White is white in every colour space, and primaries differ", "[pbrt][spectrum]") {
    Spectra s;
    for (const std::string& space : pbrt_color_spaces()) {
        PbrtObject o = object("light", "\"rgb L\" [1 1 1]");
        o.parameters[0].color_space = space;
        CAPTURE(space);
        for (int i = 0; i < 3; ++i) CHECK_THAT(pbrt_light_color(o, "L", s.files)[i], WithinAbs(1.0, 1e-3));
    }
    PbrtObject red = object("light", "\"rgb L\" [1 0 0]");
    red.parameters[0].color_space = "rec2020";
    CHECK(pbrt_light_color(red, "L", s.files).x > 1.5f);
}

TEST_CASE("The equal-area mapping is its inverse's inverse, and keeps areas", "[pbrt]") {
    Vec3d sum(0.0);
    double above = 0.0;
    const int n = 64;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const glm::dvec2 p((i + 0.3) / n, (j + 0.6) / n);
            const Vec3d d = equal_area_direction(p);
            CHECK_THAT(glm::length(d), WithinAbs(1.0, 1e-12));
            CHECK(glm::length(equal_area_square(d) - p) < 1e-9);
            sum += d * d;
            above += d.z > 0.5;
        }
    for (int i = 0; i < 3; ++i) CHECK_THAT(sum[i] / (n * n), WithinAbs(1.0 / 3.0, 0.01));
    CHECK_THAT(above / (n * n), WithinAbs(0.25, 0.01));  // of the sphere lies above z = 1/2
    CHECK(glm::length(equal_area_direction({0.5, 0.5}) - Vec3d(0, 0, 1)) < 1e-12);
}

TEST_CASE("Pictures of infinite lights are turned into the world", "[pbrt]") {
    const PbrtFolder folder;
    ImageChannels image;
    image.width = image.height = 64;
    std::vector<Rgb> texels;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec3d d = equal_area_direction({(x + 0.5) / 64.0, (y + 0.5) / 64.0});
            texels.push_back(Rgb(glm::max(d, Vec3d(0.0))));
        }
    image.add_rgb("", texels);
    write_exr(folder.file("sky.exr"), image);
    folder.convert("WorldBegin Rotate 90 1 0 0 LightSource \"infinite\" \"string filename\" \"sky.exr\"");
    const Bitmap turned = read_bitmap(folder.file("converted/environment_0.exr"), false);
    REQUIRE(turned.width == 128);
    // The light's +z (blue) is the world's -y: the bottom row; its +y (green) is +z: u = 1/2.
    CHECK_THAT(turned.pixels.back().z, WithinAbs(1.0, 0.02));
    const Rgb green = turned.pixels[32 * 128 + 64], red = turned.pixels[32 * 128 + 32];
    CHECK_THAT(green.y, WithinAbs(1.0, 0.02));
    CHECK_THAT(red.x, WithinAbs(1.0, 0.02));  // +x: u = 1/4
    CHECK(folder.error(pbrt_world("Shape \"sphere\" LightSource \"infinite\" \"string filename\" "
                                  "\"converted/environment_0.exr\"")) ==
          "scene.pbrt:5: the picture of an infinite light is square, in the equal-area mapping; this one is "
          "128 x 64");
}

TEST_CASE("Curves: B-splines pass through the ends of Bezier segments", "[pbrt]") {
    Spectra s;
    const auto curve = [&](const std::string& parameters) {
        std::istringstream text(pbrt_curve_text(object("curve", parameters), Transform(), s.files));
        std::vector<double> numbers;
        for (double v; text >> v;) numbers.push_back(v);
        return numbers;
    };
    const std::vector<double> n =
        curve("\"float width0\" 2 \"float width1\" 1 \"point3 P\" [0 0 0 1 2 0 3 2 0 4 0 0]");
    REQUIRE(n.size() == 16);
    const auto knot = [&](int first, int k) {
        return (n[4 * first + k] + 4 * n[4 * (first + 1) + k] + n[4 * (first + 2) + k]) / 6.0;
    };
    CHECK_THAT(knot(0, 0), WithinAbs(0.0, 1e-7));
    CHECK_THAT(knot(1, 0), WithinAbs(4.0, 1e-7));
    CHECK_THAT(knot(0, 3), WithinAbs(1.0, 1e-7));  // half the width
    CHECK_THAT(knot(1, 3), WithinAbs(0.5, 1e-7));
    CHECK(curve("\"integer degree\" 2 \"point3 P\" [0 0 0 1 2 0 3 2 0 4 0 0 5 5 5]").size() == 32);
    CHECK(curve("\"string basis\" \"bspline\" \"point3 P\" [0 0 0 1 2 0 3 2 0 4 0 0 5 5 5]").size() == 32);
    CHECK_THROWS_AS(curve("\"point3 P\" [0 0 0 1 2 0 3 2 0 4 0 0 5 5 5]"), InputError);
}

TEST_CASE("Loop subdivision of a regular net keeps a plane, and makes four of each triangle", "[pbrt]") {
    const MeshData mesh =
        pbrt_loop_subdivision(object("loopsubdiv",
                                     "\"integer levels\" 2 \"integer indices\" [0 1 2 0 2 3 0 3 4 0 4 1] "
                                     "\"point3 P\" [0 0 0 1 0 0 0 1 0 -1 0 0 0 -1 0]"));
    CHECK(mesh.triangles.size() == 64);
    for (const Vec3& p : mesh.positions) CHECK(p.z == 0.0f);
    CHECK(glm::length(mesh.positions[0]) < 1e-6f);  // the centre stays, by symmetry
    for (const Vec3& n : mesh.normals) CHECK_THAT(n.z, WithinAbs(1.0, 1e-5));
    // A tetrahedron shrinks: the limit of each corner is that of its ring, valence 3 (Loop 1987).
    const MeshData ball =
        pbrt_loop_subdivision(object("loopsubdiv",
                                     "\"integer levels\" 0 \"integer indices\" [0 2 1 0 1 3 0 3 2 1 2 3] "
                                     "\"point3 P\" [1 1 1 1 -1 -1 -1 1 -1 -1 -1 1]"));
    CHECK_THAT(ball.positions[0].x, WithinAbs(1.0 - 3 * 0.2 + 0.2 * -1.0, 1e-6));
}

TEST_CASE("Cut quadrics of pbrt have their areas and face outwards", "[pbrt]") {
    const auto area = [](const std::string& type, const std::string& parameters) {
        return mesh_area(pbrt_quadric(object(type, parameters)));
    };
    CHECK_THAT(area("sphere", "\"float phimax\" 180"), WithinRel(2.0 * M_PI, 0.002));
    CHECK_THAT(area("sphere", "\"float zmin\" 0"), WithinRel(2.0 * M_PI, 0.002));
    CHECK_THAT(area("disk", "\"float innerradius\" 0.5"), WithinRel(0.75 * M_PI, 0.002));
    CHECK_THAT(area("cylinder", "\"float phimax\" 90 \"float zmin\" 0 \"float zmax\" 3"),
               WithinRel(1.5 * M_PI, 0.002));
    for (const char* type : {"sphere", "disk", "cylinder"}) {
        MeshData mesh = pbrt_quadric(object(type, "\"float phimax\" 200"));
        const auto triangles = mesh.triangles;
        turn_to_normals(mesh);
        CHECK(mesh.triangles == triangles);
    }
}
