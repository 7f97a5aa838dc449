// Bitmap and checkerboard textures.
#include "core/formats/register_formats.h"
#include "core/materials/textures.h"

#include <fstream>

#include "core/formats/pictures/image_file.h"
#include "core/materials/register_materials.h"
#include "core/materials/texels.h"
#include "core/materials/texture_slot.h"
#include "core/math/random.h"
#include "core/objects/properties.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;

namespace {

/// Texel (x, y) has red x + 10 y, counted from the top left.
Bitmap numbered(int width, int height) {
    Bitmap b{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) b.pixels.emplace_back(float(x + 10 * y), 0.0f, 1.0f);
    return b;
}

Transform scaling(double x, double y) {
    return Transform(glm::scale(glm::dmat4(1.0), glm::dvec3(x, y, 1.0)));
}

}  // namespace

TEST_CASE("a bitmap's top row lies at v = 0", "[materials][texture]") {
    const auto t = make_bitmap_texture(numbered(4, 2), {.filter = TextureFilter::nearest});
    CHECK(t->eval({0.1f, 0.1f}).x == 0.0f);
    CHECK(t->eval({0.9f, 0.1f}).x == 3.0f);
    CHECK(t->eval({0.1f, 0.9f}).x == 10.0f);
    CHECK(t->mean().x == Approx(6.5f));
    CHECK(t->maximum() == 13.0f);
    CHECK(t->minimum() == 0.0f);
    CHECK_FALSE(t->constant());
}

TEST_CASE("bilinear lookups meet the texels at their centres", "[materials][texture]") {
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp}) {
        const auto t = make_bitmap_texture(numbered(4, 4), {.wrap = wrap});
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x)
                CHECK(t->eval({(float(x) + 0.5f) / 4.0f, (float(y) + 0.5f) / 4.0f}).x ==
                      Approx(float(x + 10 * y)));
        CHECK(t->eval({0.5f, 0.5f}).x == Approx(16.5f));  // between 11, 12, 21 and 22
    }
}

TEST_CASE("outside the unit square", "[materials][texture]") {
    const auto at = [](TextureWrap wrap, TextureFilter filter, float u) {
        return make_bitmap_texture(numbered(4, 1), {.filter = filter, .wrap = wrap})->eval({u, 0.5f}).x;
    };
    constexpr auto nearest = TextureFilter::nearest, bilinear = TextureFilter::bilinear;
    CHECK(at(TextureWrap::repeat, nearest, 1.1f) == 0.0f);
    CHECK(at(TextureWrap::repeat, nearest, -0.1f) == 3.0f);
    CHECK(at(TextureWrap::mirror, nearest, 1.1f) == 3.0f);
    CHECK(at(TextureWrap::mirror, nearest, -0.3f) == 1.0f);
    CHECK(at(TextureWrap::mirror, nearest, 2.3f) == 1.0f);
    CHECK(at(TextureWrap::clamp, nearest, 7.0f) == 3.0f);
    CHECK(at(TextureWrap::clamp, nearest, -7.0f) == 0.0f);
    CHECK(at(TextureWrap::repeat, bilinear, 0.0f) == Approx(1.5f));  // between the last and the first
    CHECK(at(TextureWrap::repeat, bilinear, 1.0f) == Approx(1.5f));
    CHECK(at(TextureWrap::mirror, bilinear, 0.0f) == 0.0f);
    CHECK(at(TextureWrap::clamp, bilinear, 1.0f) == 3.0f);
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::mirror, TextureWrap::clamp})
        for (const TextureFilter filter : {nearest, bilinear})
            for (const float u :
                 {infinity, -infinity, std::nanf(""), 1e30f, -1e30f, -1e-10f, one_minus_epsilon}) {
                const float value = at(wrap, filter, u);
                CHECK((value >= 0.0f && value <= 3.0f));
            }
}

TEST_CASE("to_uv acts before the lookup", "[materials][texture]") {
    BitmapTextureParameters p{.filter = TextureFilter::nearest, .to_uv = scaling(2.0, 1.0)};
    CHECK(make_bitmap_texture(numbered(4, 1), p)->eval({0.3f, 0.0f}).x == 2.0f);
    p.to_uv = Transform(glm::translate(glm::dmat4(1.0), glm::dvec3(0.5, 0.0, 0.0)));
    CHECK(make_bitmap_texture(numbered(4, 1), p)->eval({0.3f, 0.0f}).x == 3.0f);
}

TEST_CASE("a single texel and a single value are constant", "[materials][texture]") {
    const auto t = make_bitmap_texture(Bitmap{1, 1, {Rgb(0.3f)}});
    CHECK(t->constant());
    CHECK(t->eval({0.7f, -3.0f}).x == Approx(0.3f));
    CHECK(TextureSlot(t).eval({0, 0}).x == Approx(0.3f));
    CHECK_FALSE(TextureSlot(t).textured());
}

TEST_CASE("bitmaps with bad values are refused with the first position", "[materials][texture]") {
    Bitmap b = numbered(3, 2);
    b.pixels[4].y = std::nanf("");
    b.pixels[5].x = infinity;
    try {
        make_bitmap_texture(b, {.name = "bad.exr"});
        FAIL("not refused");
    } catch (const InputError& e) {
        CHECK(std::string(e.what()).find("bad.exr") != std::string::npos);
        CHECK(std::string(e.what()).find("2 pixels") != std::string::npos);
        CHECK(std::string(e.what()).find("(1, 1)") != std::string::npos);
    }
    CHECK_THROWS_AS(make_bitmap_texture(Bitmap{}), InputError);
}

TEST_CASE("texels are the bitmap's, in a byte, two or four a number", "[materials][texture][memory]") {
    constexpr int width = 300, height = 260;
    constexpr std::size_t count = std::size_t(width) * height;
    Rng rng(4);
    for (const std::uint32_t values : {1u, 255u, 256u, 257u, 65536u, 70000u})
        for (const bool grey : {true, false}) {
            Bitmap b{width, height, {}};
            const auto number = [&](std::size_t i) { return 1.0f / float(1 + i % values); };
            for (std::size_t i = 0; i < count; ++i) {
                const float x = number(i);
                b.pixels.push_back(grey ? Rgb(x) : Rgb(x, number(i + 1), number(rng.next_u32())));
            }
            b.pixels.front() = Rgb(number(0));
            const Texels texels(b);
            bool same = true;
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    same &= texels(x, y) == b.pixels[std::size_t(y) * width + std::size_t(x)];
            CAPTURE(values, grey);
            CHECK(same);
            const std::size_t numbers = count * (grey || values == 1 ? 1 : 3);
            if (values <= 256)
                CHECK(texels.bytes() == numbers + values * sizeof(float));
            else if (values <= 65536)
                CHECK(texels.bytes() == numbers * 2 + values * sizeof(float));
            else
                CHECK(texels.bytes() == numbers * 4);
        }
    const Bitmap zeros{2, 1, {Rgb(0.0f), Rgb(-0.0f)}};
    CHECK(std::signbit(Texels(zeros)(1, 0).x));
    CHECK_FALSE(std::signbit(Texels(zeros)(0, 0).x));
}

TEST_CASE("a checkerboard has two by two squares in a unit", "[materials][texture]") {
    const auto dark = make_constant_texture(Rgb(0.2f)), light = make_constant_texture(Rgb(0.4f));
    const auto t = make_checkerboard_texture(light, dark);
    CHECK(t->eval({0.1f, 0.1f}).x == 0.4f);
    CHECK(t->eval({0.6f, 0.1f}).x == 0.2f);
    CHECK(t->eval({0.6f, 0.6f}).x == 0.4f);
    CHECK(t->eval({-0.1f, 0.1f}).x == 0.2f);
    CHECK(t->mean().x == Approx(0.3f));
    CHECK((t->maximum() == 0.4f && t->minimum() == 0.2f && !t->constant()));
    CHECK(make_checkerboard_texture(light, dark, scaling(10.0, 10.0))->eval({0.06f, 0.01f}).x == 0.2f);
}

TEST_CASE("bitmaps are read from files, or refused at the line that names them", "[materials][texture]") {
    const mote::tests::TemporaryFolder folder;
    const std::vector<Rgb> pixels = {Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1), Rgb(1, 1, 1)};
    write_png(folder.file("four.png"), 2, 2, pixels);
    std::ofstream(folder.file("broken.png")) << "not a picture";
    Registry registry;
    register_materials(registry), register_assets(registry);
    const auto make = [&](const std::string& file) {
        Properties p;
        p.category = Category::texture, p.type = "bitmap";
        p.search_paths = {folder.path()};
        p.values["filename"] = {file, {"scene.xml", 5}};
        p.values["filter_type"] = {std::string("nearest"), {"scene.xml", 6}};
        return std::dynamic_pointer_cast<Texture>(registry.factory(p.category, p.type)(p));
    };
    const auto t = make("four.png");
    CHECK(glm::length(t->eval({0.9f, 0.1f}) - Rgb(0, 1, 0)) < 1e-5f);
    CHECK(glm::length(t->eval({0.1f, 0.9f}) - Rgb(0, 0, 1)) < 1e-5f);
    CHECK(t->maximum() <= 1.00001f);
    for (const char* bad : {"broken.png", "missing.png"}) try {
            make(bad);
            FAIL_CHECK("not refused");
        } catch (const InputError& e) {
            CHECK(std::string(e.what()).find("scene.xml:5: ") == 0);
            CHECK(std::string(e.what()).find(bad) != std::string::npos);
        }
}
