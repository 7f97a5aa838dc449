// Files of pictures: round trips, refusals, and places that cannot be written to.
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/files/atomic_file.h"
#include "core/formats/pictures/image_file.h"
#include "core/math/random.h"
#include "core/objects/error.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using mote::tests::TemporaryFolder;

namespace {

ImageChannels sample_image(int width, int height) {
    ImageChannels image;
    image.width = width, image.height = height;
    Rng rng(5);
    const auto n = std::size_t(width) * std::size_t(height);
    std::vector<Rgb> beauty(n), direct(n);
    std::vector<float> depth(n);
    for (std::size_t i = 0; i < n; ++i) {
        beauty[i] = {rng.next_float(), 1e6f * rng.next_float(), -rng.next_float()};
        direct[i] = {1e-30f, rng.next_float(), 3.0f};
        depth[i] = 1000.0f + rng.next_float();
    }
    image.add_rgb("", beauty);
    image.add_rgb("direct", direct);
    image.add("Depth.Z", depth);
    image.metadata = {{"seed", "42"}, {"command", "mote render a.xml -o \"b c.exr\""}, {"empty", ""}};
    return image;
}

void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string message_of(const std::string& path) {
    try {
        read_bitmap(path, false);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("All channels and metadata survive an EXR file", "[exr]") {
    const TemporaryFolder folder;
    for (const auto& [w, h] :
         {std::pair(33, 17), std::pair(1, 1), std::pair(1, 65535), std::pair(65535, 1)}) {
        const ImageChannels image = sample_image(w, h);
        write_exr(folder.file("a.exr"), image);
        const ImageChannels back = read_exr(folder.file("a.exr"));
        REQUIRE(back.width == w);
        REQUIRE(back.height == h);
        REQUIRE(back.names.size() == image.names.size());
        for (std::size_t i = 0; i < image.names.size(); ++i) {
            const auto* plane = back.find(image.names[i]);
            REQUIRE(plane);
            CHECK(*plane == image.channels[i]);
        }
        for (const auto& [key, value] : image.metadata) CHECK(back.metadata.at(key) == value);
        CHECK(back.rgb("direct") == image.rgb("direct"));
        CHECK(back.rgb("nothing").empty());
    }
    CHECK(folder.size() == 1);
}

TEST_CASE("NaN and infinity survive an EXR file", "[exr]") {
    const TemporaryFolder folder;
    ImageChannels image;
    image.width = 3, image.height = 1;
    image.add("Y", {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity});
    write_exr(folder.file("a.exr"), image);
    const auto back = read_exr(folder.file("a.exr"));
    CHECK(std::isnan(back.channels[0][0]));
    CHECK(back.channels[0][1] == infinity);
    CHECK(back.channels[0][2] == -infinity);
}

TEST_CASE("Half files keep eleven bits, stay finite, and keep depths in full", "[exr]") {
    const TemporaryFolder folder;
    const ImageChannels image = sample_image(20, 10);
    write_exr(folder.file("a.exr"), image, true);
    const ImageChannels back = read_exr(folder.file("a.exr"));
    CHECK(*back.find("Depth.Z") == *image.find("Depth.Z"));
    for (std::size_t i = 0; i < 200; ++i) {
        const float wanted = image.find("R")->at(i);
        CHECK(std::fabs(back.find("R")->at(i) - wanted) <= std::fabs(wanted) * 0x1p-11f + 0x1p-25f);
        CHECK(back.find("G")->at(i) <= 65504.0f);
    }
}

TEST_CASE("worldToCamera is written as OpenEXR's matrix and read back", "[exr]") {
    const TemporaryFolder folder;
    ImageChannels image = sample_image(2, 2);
    image.metadata["worldToCamera"] = "1 0 0 0 0 0.5 0 0 0 0 -1 0 0.25 3 4 1";
    write_exr(folder.file("a.exr"), image);
    CHECK(read_exr(folder.file("a.exr")).metadata.at("worldToCamera") == image.metadata["worldToCamera"]);
    CHECK(read_text(folder.file("a.exr")).find(std::string("worldToCamera\0m44f", 18)) != std::string::npos);
}

TEST_CASE("Tiled, mip-mapped, integer and offset EXR files are read", "[exr]") {
    const TemporaryFolder folder;
    const int w = 37, h = 23;
    std::vector<std::uint32_t> numbers(std::size_t(w * h));
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = std::uint32_t(i);
    for (const auto mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), Imath::Box2i({-5, 11}, {-5 + w - 1, 11 + h - 1}));
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        header.setTileDescription(Imf::TileDescription(16, 8, mode));
        Imf::TiledOutputFile file(folder.file("t.exr").c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("id", Imf::Slice::Make(Imf::UINT, numbers.data(), header.dataWindow(), 4, 4 * w));
        file.setFrameBuffer(frame);
        for (int ly = 0; ly < file.numYLevels(); ++ly)
            for (int lx = 0; lx < file.numXLevels(); ++lx)
                if (mode == Imf::RIPMAP_LEVELS || lx == ly)
                    file.writeTiles(0, file.numXTiles(lx) - 1, 0, file.numYTiles(ly) - 1, lx, ly);
    }
    const ImageChannels back = read_exr(folder.file("t.exr"));
    REQUIRE(back.width == w);
    REQUIRE(back.height == h);
    for (std::size_t i = 0; i < numbers.size(); ++i) REQUIRE(back.channels[0][i] == float(i));
}

TEST_CASE("A PNG preview is sRGB, and shows what is not finite in magenta", "[png]") {
    const TemporaryFolder folder;
    const std::vector<Rgb> pixels = {Rgb(0.0f), Rgb(1.0f), Rgb(0.2f, 0.5f, 4.0f),
                                     Rgb(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f)};
    write_png(folder.file("a.png"), 2, 2, pixels);
    const Bitmap back = read_bitmap(folder.file("a.png"), false);
    REQUIRE(back.pixels.size() == 4);
    CHECK(back.pixels[0] == Rgb(0.0f));
    CHECK(back.pixels[1] == Rgb(1.0f));
    // One step of eight bits is at most 2.4/255 of the value's own size near white.
    CHECK(back.pixels[2].x == Approx(0.2f).margin(0.004));
    CHECK(back.pixels[2].y == Approx(0.5f).margin(0.004));
    CHECK(back.pixels[2].z == 1.0f);
    CHECK(back.pixels[3] == Rgb(1.0f, 0.0f, 1.0f));
    // 0.5 encodes to 0.7354 = 187.5 / 255.
    CHECK(read_bitmap(folder.file("a.png"), true).pixels[2].y == Approx(188.0 / 255.0).margin(1e-6));

    write_png(folder.file("b.png"), 2, 2, pixels, -1.0f);
    CHECK(read_bitmap(folder.file("b.png"), false).pixels[1].x == Approx(0.5f).margin(0.004));
    CHECK(folder.size() == 2);
}

TEST_CASE("Bitmaps of other kinds are read as linear RGB", "[bitmap]") {
    const TemporaryFolder folder;
    write_text(folder.file("a.pgm"), "P2\n2 1\n255\n255 0\n");
    CHECK(read_bitmap(folder.file("a.pgm"), false).pixels == std::vector<Rgb>{Rgb(1.0f), Rgb(0.0f)});
    const float row[3] = {0.25f, 2.5f, 100.0f};
    write_text(folder.file("a.pfm"),
               "PF\n1 1\n-1.0\n" + std::string(reinterpret_cast<const char*>(row), sizeof(row)));
    CHECK(read_bitmap(folder.file("a.pfm"), false).pixels == std::vector<Rgb>{Rgb(0.25f, 2.5f, 100.0f)});
    write_text(folder.file("a.hdr"),
               "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x40\x20\x81"));
    // Mantissas of 128, 64 and 32 (and perhaps half a step) of 256, times 2^(129-128).
    CHECK(read_bitmap(folder.file("a.hdr"), false).pixels[0].x == Approx(1.0).margin(0.005));
    ImageChannels grey;
    grey.width = 2, grey.height = 1;
    grey.add("Y", {0.5f, 7.0f});
    write_exr(folder.file("y.exr"), grey);
    CHECK(read_bitmap(folder.file("y.exr"), false).pixels == std::vector<Rgb>{Rgb(0.5f), Rgb(7.0f)});
}

TEST_CASE("What is no picture, or too large a one, is refused in one line that names the file", "[bitmap]") {
    const TemporaryFolder folder;
    write_text(folder.file("a.png"), "hello");
    write_text(folder.file("empty.exr"), "");
    for (const std::string name : {"a.png", "empty.exr", "missing.jpg", "."}) {
        const std::string message = message_of(folder.file(name));
        INFO(name << ": " << message);
        CHECK(message.find(folder.file(name)) == 0);
        CHECK(message.find('\n') == std::string::npos);
    }
    const std::vector<Rgb> pixels(12, Rgb(0.5f));
    write_png(folder.file("b.png"), 4, 3, pixels);
    CHECK_THROWS_AS(read_bitmap(folder.file("b.png"), false, 11), InputError);
    CHECK(read_bitmap(folder.file("b.png"), false, 12).pixels.size() == 12);
    ImageChannels image = sample_image(4, 3);
    write_exr(folder.file("b.exr"), image);
    CHECK_THROWS_AS(read_bitmap(folder.file("b.exr"), false, 11), InputError);

    // Every truncation of both.
    for (const std::string name : {"b.png", "b.exr"}) {
        const std::string whole = read_text(folder.file(name));
        for (std::size_t size = 0; size < whole.size(); ++size) {
            write_text(folder.file("cut"), whole.substr(0, size));
            REQUIRE_THROWS_AS(read_bitmap(folder.file("cut"), false), InputError);
        }
    }
}

TEST_CASE("Places that cannot be written to are errors, and nothing is left behind", "[atomic]") {
    const TemporaryFolder folder;
    const ImageChannels image = sample_image(64, 64);
    write_text(folder.file("plain"), "file");
    CHECK_THROWS_AS(write_exr(folder.file("plain/a.exr"), image), InputError);
    CHECK_THROWS_AS(write_exr(folder.file("no/such/folder/a.exr"), image), InputError);
    CHECK_THROWS_AS(write_exr(folder.path(), image), InputError);
    CHECK_THROWS_AS(write_png(folder.file("plain/a.png"), 1, 1, std::vector<Rgb>(1)), InputError);
    CHECK(folder.size() == 1);
    CHECK(read_text(folder.file("plain")) == "file");
    if (std::filesystem::exists("/dev/full")) {
        CHECK_THROWS_AS(write_exr("/dev/full", image), InputError);
        // The device itself must survive.
        CHECK(std::filesystem::is_character_file("/dev/full"));
        std::filesystem::create_symlink("/dev/full", folder.file("full.exr"));
        CHECK_THROWS_AS(write_exr(folder.file("full.exr"), image), InputError);
        CHECK(std::filesystem::is_symlink(folder.file("full.exr")));
    }
}

TEST_CASE("A link's target is replaced, not the link", "[atomic]") {
    const TemporaryFolder folder;
    write_text(folder.file("target"), "old");
    std::filesystem::create_symlink(folder.file("target"), folder.file("link"));
    const std::string text = "new";
    write_file_atomically(folder.file("link"), std::as_bytes(std::span(text.data(), text.size())));
    CHECK(std::filesystem::is_symlink(folder.file("link")));
    CHECK(read_text(folder.file("target")) == "new");
    CHECK(folder.size() == 2);
}
