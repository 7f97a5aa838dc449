// Sound pictures with one to four changed bytes, or cut short: read or refused, never a crash.
//
// The number of mutations of each file is MOTE_MUTATIONS, 400 by default.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "core/formats/pictures/image_file.h"
#include "core/math/random.h"
#include "core/objects/error.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

using namespace mote::core;

namespace {

std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string mutate(std::string bytes, Rng& rng) {
    const auto position = [&] {
        // Half of the changes hit the first 400 bytes, where the headers are.
        const std::size_t range =
            rng.next_float() < 0.5f ? std::min<std::size_t>(400, bytes.size()) : bytes.size();
        return std::size_t(rng.next_u32()) % range;
    };
    const int changes = 1 + int(rng.next_u32() % 4);
    for (int i = 0; i < changes; ++i) bytes[position()] = char(rng.next_u32());
    if (rng.next_float() < 0.1f) bytes.resize(position());
    return bytes;
}

}  // namespace

TEST_CASE("Mutated pictures are read or refused", "[damaged]") {
    const mote::tests::TemporaryFolder folder;
    std::vector<Rgb> pixels(24 * 20);
    Rng rng(12);
    for (Rgb& p : pixels) p = {rng.next_float(), 5.0f * rng.next_float(), 0.0f};
    ImageChannels image;
    image.width = 24, image.height = 20;
    image.add_rgb("", pixels);
    image.add_rgb("direct", pixels);
    image.metadata["command"] = "mote render a.xml";
    write_exr(folder.file("float.exr"), image);
    write_exr(folder.file("half.exr"), image, true);
    write_png(folder.file("a.png"), 24, 20, pixels);
    std::ofstream(folder.file("a.ppm"), std::ios::binary) << "P6\n24 20\n255\n"
                                                          << std::string(24 * 20 * 3, 'x');
    std::string scan_line("\x02\x02\x00\x18", 4);  // run-length coded: four runs of 24 equal bytes
    for (int channel = 0; channel < 4; ++channel) scan_line += "\x98\x81";
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20 +X 24\n";
    for (int y = 0; y < 20; ++y) hdr += scan_line;
    std::ofstream(folder.file("a.hdr"), std::ios::binary) << hdr;
    std::vector<std::string> files;
    for (const char* name : {"float.exr", "half.exr", "a.png", "a.ppm", "a.hdr"})
        files.push_back(folder.file(name));
    for (const char* name : {"damaged/tinyexr/unit/regression/issue-160-piz-decode.exr",
                             "damaged/tinyexr/unit/regression/tiled_half_1x1_alpha.exr",
                             "damaged/openimageio/jpeg-corrupt/src/corrupt-exif.jpg"})
        if (const auto path = mote::tests::test_data(name)) files.push_back(*path);

    const char* wanted = std::getenv("MOTE_MUTATIONS");
    const int mutations = wanted ? std::atoi(wanted) : 400;
    for (const std::string& file : files) {
        const std::string sound = read_text(file);
        CHECK_NOTHROW(read_bitmap(file, false));
        int read = 0, refused = 0;
        for (int i = 0; i < mutations; ++i) {
            std::ofstream(folder.file("mutated"), std::ios::binary) << mutate(sound, rng);
            try {
                read_bitmap(folder.file("mutated"), false);
                ++read;
            } catch (const InputError&) {
                ++refused;
            }
        }
        std::cout << std::filesystem::path(file).filename().string() << ": " << read << " read, " << refused
                  << " refused\n";
        CHECK(refused > 0);
    }
}
