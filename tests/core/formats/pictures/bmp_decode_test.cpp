// BMP files that do not fit themselves are refused; sound ones of every kind are read.
#include <fstream>
#include <string>
#include <vector>

#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;

namespace {

void put(std::string& bytes, std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += char(value >> (8 * i) & 255u);
}

/// A file with a header of 40 bytes; what is not set is sound.
struct Bmp {
    std::int32_t width = 4, height = 2;
    std::uint32_t bits = 8, compression = 0;
    std::string palette =
        std::string("\x00\x00\x00\x00\x00\x00\xff\x00\xff\x00\x00\x00", 12);  // black, red, blue
    std::string pixels = std::string("\0\1\2\0\1\1\1\1", 8);
    std::int64_t colours = -1;  ///< -1: as many as there are
    int gap = 0;                ///< between palette and pixels

    std::string bytes() const {
        const auto begin = std::uint32_t(54 + int(palette.size()) + gap);
        std::string all = "BM";
        put(all, begin + std::uint32_t(pixels.size()), 4), put(all, 0, 4), put(all, begin, 4);
        put(all, 40, 4), put(all, std::uint32_t(width), 4), put(all, std::uint32_t(height), 4);
        put(all, 1, 2), put(all, bits, 2), put(all, compression, 4);
        put(all, std::uint32_t(pixels.size()), 4), put(all, 0, 4), put(all, 0, 4);
        put(all, std::uint32_t(colours < 0 ? std::int64_t(palette.size() / 4) : colours), 4), put(all, 0, 4);
        return all + palette + std::string(std::size_t(gap), '\0') + pixels;
    }
};

Bmp runs(std::uint32_t bits, const std::string& pixels) {
    Bmp bmp;
    bmp.bits = bits, bmp.compression = bits == 4 ? 2 : 1, bmp.pixels = pixels;
    return bmp;
}

Bitmap read(const std::string& bytes) {
    const mote::tests::TemporaryFolder folder;
    const std::string path = folder.file("a.bmp");
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    try {
        return read_bitmap(path, true);
    } catch (const InputError& error) {
        const std::string message = error.what();
        CHECK(message.rfind(path + ": ", 0) == 0);
        CHECK(message.find('\n') == std::string::npos);
        throw;
    }
}

std::string refusal(const std::string& bytes) {
    try {
        read(bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "read";
}

/// The pixels as letters, row by row from the top: K, R, B, or ? for another colour.
std::string letters(const Bitmap& bitmap) {
    std::string text;
    for (const Rgb& p : bitmap.pixels) {
        const Rgb colours[] = {Rgb(0.0f), {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
        char letter = '?';
        for (int i = 0; i < 3; ++i)
            if (p.x == colours[i].x && p.y == colours[i].y && p.z == colours[i].z) letter = "KRB"[i];
        text += letter;
    }
    return text;
}

using namespace std::string_literals;

}  // namespace

TEST_CASE("Runs in a BMP without a palette are refused", "[image][bmp][damaged]") {
    Bmp bmp = runs(24, "\4\1\0\0\4\1\0\1"s);
    bmp.width = 5, bmp.height = 4, bmp.palette = "";
    bmp.pixels += std::string(64, '\0');
    CHECK_THAT(refusal(bmp.bytes()),
               ContainsSubstring("damaged BMP file: compression 1 of 24 bits per pixel"));
}

TEST_CASE("Sound BMP files with a palette are read", "[image][bmp]") {
    Bmp bmp;
    CHECK(letters(read(bmp.bytes())) == "RRRRKRBK");
    bmp.gap = 8;
    CHECK(letters(read(bmp.bytes())) == "RRRRKRBK");
    bmp.height = -2;  // from the top
    CHECK(letters(read(bmp.bytes())) == "KRBKRRRR");
    bmp = Bmp();
    bmp.bits = 4, bmp.width = 3,
    bmp.pixels = "\x01\x2f\0\0\x11\x1f\0\0"s;  // behind the third pixel is no colour
    CHECK(letters(read(bmp.bytes())) == "RRRKRB");
    bmp.bits = 1, bmp.palette.resize(8), bmp.pixels = "\x5f\0\0\0\xef\0\0\0"s;
    CHECK(letters(read(bmp.bytes())) == "RRRKRK");
    // Two runs; four single values; a step over one pixel.
    CHECK(letters(read(runs(8, "\2\1\2\2\0\0\0\4\2\1\0\1\0\1"s).bytes())) == "BRKRRRBB");
    CHECK(letters(read(runs(8, "\0\2\1\0\3\1\0\1"s).bytes())) == "KKKKKRRR");
    CHECK(letters(read(runs(4, "\4\x12\0\0\0\4\x10\x12\0\1"s).bytes())) == "RKRBRBRB");
    bmp = runs(8, "\2\1\2\2\0\0\0\4\2\1\0\1\0\1"s), bmp.gap = 4;
    CHECK(letters(read(bmp.bytes())) == "BRKRRRBB");
    CHECK(letters(read(runs(8, "\0\2\2\1\2\1\0\1"s).bytes())) == "KKRRKKKK");  // two to the right and one up
}

TEST_CASE("Sound BMP files without a palette are read", "[image][bmp]") {
    Bmp bmp;
    bmp.width = 1, bmp.height = 2, bmp.palette = "";
    bmp.bits = 24, bmp.pixels = "\xff\0\0\0\0\0\xff\0"s;
    CHECK(letters(read(bmp.bytes())) == "RB");
    bmp.bits = 32, bmp.pixels = "\xff\0\0\xff\0\0\xff\0"s;
    CHECK(letters(read(bmp.bytes())) == "RB");
    bmp.bits = 16, bmp.pixels = "\x1f\0\0\0\0\x7c\0\0"s;
    CHECK(letters(read(bmp.bytes())) == "RB");
    bmp.compression = 3, bmp.palette = "\0\xf8\0\0\xe0\7\0\0\x1f\0\0\0"s, bmp.colours = 0;  // 5, 6 and 5 bits
    bmp.pixels = "\x1f\0\0\0\0\xf8\0\0"s;
    CHECK(letters(read(bmp.bytes())) == "RB");
}

TEST_CASE("Colours that a BMP's palette has not are refused", "[image][bmp][damaged]") {
    const std::string beyond = "a pixel of colour 3 in a palette of 3";
    Bmp bmp;
    bmp.pixels[5] = 3;
    CHECK_THAT(refusal(bmp.bytes()), ContainsSubstring(beyond));
    bmp.bits = 4, bmp.pixels = "\x01\x20\0\0\x01\x03\0\0"s;
    CHECK_THAT(refusal(bmp.bytes()), ContainsSubstring(beyond));
    bmp = Bmp();
    bmp.bits = 1, bmp.palette.resize(4), bmp.pixels = "\x10\0\0\0\0\0\0\0"s;
    CHECK_THAT(refusal(bmp.bytes()), ContainsSubstring("a pixel of colour 1 in a palette of 1"));
    CHECK_THAT(refusal(runs(8, "\2\3\0\1"s).bytes()), ContainsSubstring(beyond));
    CHECK_THAT(refusal(runs(8, "\0\3\1\2\3\0\0\1"s).bytes()), ContainsSubstring(beyond));
    CHECK_THAT(refusal(runs(4, "\2\x03\0\1"s).bytes()), ContainsSubstring(beyond));
    CHECK(refusal(runs(4, "\1\x03\0\1"s).bytes()) == "read");  // a run of one value
}

TEST_CASE("BMP files that contradict themselves are refused", "[image][bmp][damaged]") {
    const auto check = [](const auto& change, const std::string& expected) {
        Bmp bmp;
        change(bmp);
        CHECK_THAT(refusal(bmp.bytes()), ContainsSubstring(expected));
    };
    check([](Bmp& b) { b.width = 0; }, "a picture of 0 x 2 pixels");
    check([](Bmp& b) { b.width = -4; }, "a picture of -4 x 2 pixels");
    check([](Bmp& b) { b.height = INT32_MIN; }, "a picture of 4 x 2147483648 pixels");
    check([](Bmp& b) { b.width = b.height = INT32_MAX; }, "pixels do not fit in");
    check([](Bmp& b) { b.bits = 32, b.width = b.height = INT32_MAX; }, "pixels do not fit in");
    check([](Bmp& b) { b.height = 3; }, "4 x 3 pixels do not fit in 74 bytes");
    check([](Bmp& b) { b.bits = 7; }, "7 bits per pixel");
    check([](Bmp& b) { b.compression = 2; }, "compression 2 of 8 bits");
    check([](Bmp& b) { b.compression = 3; }, "compression 3 of 8 bits");
    check([](Bmp& b) { b.compression = 4; }, "compression 4, which is not known");  // a JPEG within
    check([](Bmp& b) { b.colours = 257; }, "a palette of 257 colours for 8 bits");
    check([](Bmp& b) { b.colours = 0; }, "a palette of 256 colours does not fit in 74 bytes");
    check([](Bmp& b) { b.colours = 5; }, "its pixels begin within its header or palette");
    check([](Bmp& b) { b = runs(8, "\4\1\0\0\4\1\0\0\1\1\0\1"s); }, "runs beyond its last row");
    check([](Bmp& b) { b = runs(8, "\4\1\0\2\0\2\1\1\0\1"s); }, "runs beyond its last row");
    check([](Bmp& b) { b = runs(8, "\4\1\0\0"s); }, "cut short");
    std::string header = Bmp().bytes();
    header[14] = 41;
    CHECK_THAT(refusal(header), ContainsSubstring("a header of 41 bytes, which is not known"));
}

TEST_CASE("A BMP that is cut short anywhere is refused", "[image][bmp][damaged]") {
    for (const Bmp& bmp :
         {Bmp(), runs(8, "\2\1\2\2\0\0\0\4\2\1\0\1\0\1"s), runs(4, "\4\x12\0\0\0\4\x10\x12\0\1"s)}) {
        const std::string bytes = bmp.bytes();
        REQUIRE(refusal(bytes) == "read");
        for (std::size_t size = 2; size < bytes.size(); ++size) {
            INFO(size);
            CHECK_THAT(refusal(bytes.substr(0, size)), ContainsSubstring("BMP file"));
        }
    }
}
