// Damaged pictures by others: every one is read or refused with InputError, in less than ten seconds.
#include <chrono>
#include <filesystem>
#include <iostream>

#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"
#include "tests/support/catch.h"
#include "tests/support/test_data.h"

using namespace mote::core;

namespace {

struct Counts {
    std::size_t read = 0, refused = 0;
    double slowest = 0.0;
    std::string slowest_file;
};

// A hang counts as a failure, like a crash.
constexpr double limit_seconds = 10.0;

void try_file(const std::string& path, Counts& counts) {
    const auto start = std::chrono::steady_clock::now();
    try {
        const Bitmap bitmap = read_bitmap(path, false);
        REQUIRE(bitmap.pixels.size() == std::size_t(bitmap.width) * std::size_t(bitmap.height));
        ++counts.read;
    } catch (const InputError& error) {
        const std::string message = error.what();
        INFO(message);
        CHECK(message.find(path) == 0);
        CHECK(message.find('\n') == std::string::npos);
        CHECK(message.size() < path.size() + 300);
        ++counts.refused;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    INFO(path);
    CHECK(seconds < limit_seconds);
    if (seconds > counts.slowest) counts.slowest = seconds, counts.slowest_file = path;
}

}  // namespace

TEST_CASE("Damaged pictures are read or refused", "[damaged]") {
    for (const std::string folder :
         {"damaged/openexr-images/Damaged", "damaged/openexr", "damaged/tinyexr", "damaged/openimageio"}) {
        const auto path = mote::tests::test_data(folder);
        if (!path) continue;
        Counts counts;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*path))
            if (entry.is_regular_file()) try_file(entry.path().string(), counts);
        std::cout << folder << ": " << counts.read << " read, " << counts.refused << " refused, slowest "
                  << counts.slowest << " s ("
                  << std::filesystem::path(counts.slowest_file).filename().string() << ")\n";
        CHECK(counts.read + counts.refused > 0);
        CHECK(counts.refused > 0);
    }
}
