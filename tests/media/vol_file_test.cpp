// .vol files: what is read, and that damage is refused in one line that names the file.
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/objects/error.h"
#include "tests/media/test_media.h"
#include "tests/support/catch.h"
#include "tests/support/test_data.h"

using namespace mote;
using core::Rgb, core::Vec3;

namespace {

class TemporaryFile {
  public:
    explicit TemporaryFile(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / ("mote_" + std::to_string(getpid()) + "_" + name)) {}
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    std::string path() const { return path_.string(); }
    void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
    std::string read() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

  private:
    std::filesystem::path path_;
};

std::string refusal(const std::string& path, bool clamp = false) {
    try {
        media::read_vol_file(path, clamp);
    } catch (const core::InputError& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a .vol file survives writing and reading", "[media][vol]") {
    const TemporaryFile file("roundtrip.vol");
    const auto grid = tests::random_grid({3, 4, 5}, 3, 1);
    media::write_vol_file(file.path(), grid);
    const auto read = media::read_vol_file(file.path(), false);
    CHECK(read.values == grid.values);
    CHECK(read.resolution == grid.resolution);
    CHECK(read.channels == 3);
}

TEST_CASE("voxels are cell-centred in the unit cube, clamped outside", "[media][vol]") {
    auto file = tests::vol_grid({4, 1, 1}, 1, [](int x, int, int) { return Rgb(float(x)); });
    file.bounds = {Vec3(10, 0, 0), Vec3(14, 1, 1)};
    const media::GridVolume unit(file, {}, false, "x");
    CHECK(unit.eval(Vec3(0.125f, 0.5f, 0.5f)).x == Approx(0.0).margin(1e-6));
    CHECK(unit.eval(Vec3(0.375f, 0.5f, 0.5f)).x == Approx(1.0));
    CHECK(unit.eval(Vec3(0.5f, 0.1f, 0.9f)).x == Approx(1.5));
    CHECK(unit.eval(Vec3(-5.0f, 0.5f, 0.5f)).x == 0.0f);
    CHECK(unit.eval(Vec3(5.0f, 0.5f, 0.5f)).x == 3.0f);
    const media::GridVolume boxed(file, {}, true, "x");
    CHECK(boxed.eval(Vec3(12.0f, 0.5f, 0.5f)).x == Approx(1.5));
    const core::Transform shift(glm::translate(glm::dmat4(1.0), core::Vec3d(1, 0, 0)));
    CHECK(media::GridVolume(file, shift, false, "x").eval(Vec3(1.5f, 0.5f, 0.5f)).x == Approx(1.5));
    CHECK_THROWS_AS(media::GridVolume(
                        file, core::Transform(glm::scale(glm::dmat4(1.0), core::Vec3d(1, 0, 1))), false, "x"),
                    core::InputError);
}

TEST_CASE("bad .vol files are refused by name", "[media][vol]") {
    const TemporaryFile file("bad.vol");
    media::write_vol_file(file.path(), tests::random_grid({3, 3, 3}, 1, 1));
    const std::string good = file.read();
    const auto with = [&](std::size_t offset, const auto& value) {
        std::string bytes = good;
        std::memcpy(bytes.data() + offset, &value, sizeof value);
        file.write(bytes);
        return refusal(file.path());
    };
    CHECK(with(0, 'X').find("VOL") != std::string::npos);
    CHECK(with(3, char(4)).find("version 4") != std::string::npos);
    CHECK(with(4, std::int32_t(3)).find("uint8") != std::string::npos);
    CHECK(with(8, std::int32_t(-3)).find("-3") != std::string::npos);
    CHECK(with(8, std::int32_t(1 << 15)).find("bytes") != std::string::npos);
    CHECK(with(20, std::int32_t(2)).find("2 channels") != std::string::npos);
    CHECK(with(24, std::nanf("")).find("bounding box") != std::string::npos);
    CHECK(with(48 + 4 * 14, std::nanf("")).find("(2, 1, 1)") != std::string::npos);
    CHECK(with(48, core::infinity).find("(0, 0, 0)") != std::string::npos);
    CHECK(with(48 + 4, -0.5f).find("clamp_negative") != std::string::npos);
    CHECK(with(48 + 4, -0.5f).find(file.path()) == 0);
    const auto clamped = media::read_vol_file(file.path(), true);
    CHECK(clamped.clamped == 1);
    CHECK(clamped.lowest == -0.5f);
    CHECK(clamped.values[1] == 0.0f);
    for (std::size_t length = 0; length < good.size(); length += 3) {
        file.write(good.substr(0, length));
        REQUIRE_FALSE(refusal(file.path()).empty());
    }
    CHECK_FALSE(refusal("/nonexistent/file.vol").empty());
    CHECK_FALSE(refusal(std::filesystem::temp_directory_path().string()).empty());
}

TEST_CASE("mutated .vol files are read or refused", "[media][vol][damage]") {
    const TemporaryFile file("mutated.vol");
    media::write_vol_file(file.path(), tests::random_grid({3, 3, 3}, 1, 1));
    const std::string good = file.read();
    core::Rng rng(77);
    int read = 0, refused = 0;
    for (int i = 0; i < 500; ++i) {
        std::string bytes = good;
        for (int k = 0; k < 1 + i % 4; ++k) {
            const std::size_t range = i % 2 ? 48 : bytes.size();  // half of them in the header
            bytes[rng.next_u32() % range] = char(rng.next_u32());
        }
        file.write(bytes);
        const std::string message = refusal(file.path());
        message.empty() ? ++read : ++refused;
        if (!message.empty()) {
            REQUIRE(message.find(file.path()) == 0);
            REQUIRE(message.find('\n') == std::string::npos);
        }
    }
    CHECK(read > 0);
    CHECK(refused > 150);
}

TEST_CASE("real .vol files are read or refused with a reason", "[media][vol][data]") {
    const auto folder = tests::test_data("scenes/lajolla/volpath_test");
    if (!folder) return;
    const auto smoke = media::read_vol_file(*folder + "/smoke.vol", false);
    CHECK(smoke.resolution == glm::ivec3(128, 128, 50));
    CHECK(refusal(*folder + "/colored_density.vol").find("negative") != std::string::npos);
    CHECK(media::read_vol_file(*folder + "/colored_density.vol", true).clamped > 0);
    CHECK(refusal(*folder + "/albedo.vol").empty());
}
