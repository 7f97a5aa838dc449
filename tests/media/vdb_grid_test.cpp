// Reading VDB files: values, kinds, names, limits, damage.
#include "media/vdb_grid.h"

#include <filesystem>

#include "core/math/random.h"
#include "core/objects/error.h"
#include "tests/media/statistics.h"
#include "tests/media/tools/test_density.h"
#include "tests/media/vdb_test_files.h"
#include "tests/support/catch.h"
#include "tests/support/test_data.h"

using namespace mote;
using core::Vec3d;

namespace {

float value_at(const media::VdbGrid& grid, double x, double y, double z) {
    const Vec3d p(x, y, z);
    float v = 0.0f;
    media::lookup_density(grid, {&p, 1}, {&v, 1});
    return v;
}

/// Trilinear interpolation of the test density, written out.
double reference_at(const Vec3d& p) {
    const int x = int(std::floor(p.x)), y = int(std::floor(p.y)), z = int(std::floor(p.z));
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
        const int a = i & 1, b = (i >> 1) & 1, c = i >> 2;
        const double w =
            (a ? p.x - x : 1 - p.x + x) * (b ? p.y - y : 1 - p.y + y) * (c ? p.z - z : 1 - p.z + z);
        const bool inside =
            std::min({x + a, y + b, z + c}) >= 0 && std::max({x + a, y + b, z + c}) < tests::test_grid_size;
        sum += inside ? w * tests::test_density(x + a, y + b, z + c) : 0.0;
    }
    return sum;
}

}  // namespace

TEST_CASE("a VDB fog volume is read value by value", "[media][vdb]") {
    const tests::GridFolder folder;
    struct Kind {
        const char* name;
        double factor, tolerance;
    };
    // half keeps 11 bits, integers lose up to one unit of a hundred
    for (const Kind& kind :
         {Kind{"lump", 1, 1e-6}, Kind{"half", 1, 2e-3}, Kind{"double", 1, 1e-6}, Kind{"int32", 100, 1.0}}) {
        const auto grid = media::load_vdb_grid(folder.grid(kind.name));
        INFO(kind.name);
        CHECK(grid->name() == "density");
        CHECK(grid->background() == 0.0f);
        CHECK(grid->index_to_world().matrix == glm::dmat4(1.0));
        core::Rng rng(1);
        double worst = 0.0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3d p = 27.0 * Vec3d(rng.next_float(), rng.next_float(), rng.next_float()) - 1.5;
            worst =
                std::max(worst, std::fabs(value_at(*grid, p.x, p.y, p.z) - kind.factor * reference_at(p)));
        }
        CHECK(worst < kind.tolerance * std::max(1.0, kind.factor / 100) * 4.5);
    }
}

TEST_CASE("tiles, backgrounds, single voxels and far lookups", "[media][vdb]") {
    const tests::GridFolder folder;
    const auto tiles = media::load_vdb_grid(folder.grid("tiles"));
    CHECK(tiles->lower() == media::Voxel(-4));
    CHECK(tiles->upper() == media::Voxel(35));
    CHECK(tiles->active_voxels() == 64000);
    CHECK(value_at(*tiles, 10.3, 11.7, 8.2) == 0.75f);
    CHECK(value_at(*tiles, 35.5, 0, 0) == 0.375f);
    CHECK(value_at(*tiles, -5.0, 0, 0) == 0.0f);
    const auto single = media::load_vdb_grid(folder.grid("single"));
    CHECK(single->lower() == media::Voxel(-3, 2, 1000));
    CHECK(value_at(*single, -2.5, 2.5, 1000.0) == 0.5f);
    const auto raised = media::load_vdb_grid(folder.grid("background"));
    CHECK(raised->background() == 0.25f);
    CHECK(value_at(*raised, 1e12, -1e300, 3.0) == 0.25f);
    CHECK(raised->warnings().size() == 1);
    const auto empty = media::load_vdb_grid(folder.grid("empty"));
    CHECK(empty->empty());
    CHECK(empty->warnings().size() == 1);
}

TEST_CASE("what is not a fog volume of numbers is refused by name", "[media][vdb]") {
    const tests::GridFolder folder;
    const auto refuses = [&](const std::string& kind, const std::string& word) {
        const std::string path = folder.grid(kind), message = tests::vdb_refusal(path);
        INFO(kind << ": " << message);
        CHECK(message.find(path) == 0);
        CHECK(message.find(word) != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    };
    refuses("level_set", "level set");
    refuses("vectors", "vec3s");
    refuses("frustum", "frustum");
    refuses("nan", "voxel (5, 6, 7) is NaN");
    refuses("infinite", "voxel (5, 6, 7) is infinite");
    refuses("negative", "clamp_negative");
    refuses("negative_background", "negative");
    refuses("none", "holds no grid");
    refuses("odd_name", "grids present: line?break");
    CHECK(tests::vdb_refusal(folder.grid("lump"), "smoke").find("grids present: density") !=
          std::string::npos);
    CHECK(tests::vdb_refusal(folder.file("absent.vdb")).find("no such file") != std::string::npos);
    CHECK_FALSE(tests::vdb_refusal(folder.file("")).empty());
    tests::write_bytes(folder.file("text.vdb"), "this is no grid");
    CHECK_FALSE(tests::vdb_refusal(folder.file("text.vdb")).empty());

    media::VdbLoadOptions clamp;
    clamp.clamp_negative = true;
    const auto clamped = media::load_vdb_grid(folder.grid("negative"), "density", clamp);
    CHECK(clamped->clamped_voxels() == 1);
    CHECK(value_at(*clamped, 5, 6, 7) == 0.0f);
}

TEST_CASE("of several grids with one name the first is taken, with a warning", "[media][vdb]") {
    const tests::GridFolder folder;
    const std::string path = folder.grid("three");
    const auto first = media::load_vdb_grid(path), second = media::load_vdb_grid(path, "density[1]");
    REQUIRE(first->warnings().size() == 1);
    CHECK(first->warnings()[0].find("density[1]") != std::string::npos);
    CHECK(value_at(*second, 11, 12, 11) == Approx(2.0f * value_at(*first, 11, 12, 11)));
    CHECK(media::load_vdb_grid(path, "heat")->warnings().empty());
    const auto list = media::list_vdb_grids(path);
    REQUIRE(list.size() == 3);
    for (const auto& info : list) {
        CHECK(info.grid_class == "fog volume");
        CHECK(info.active_voxels == first->active_voxels());
        CHECK(info.linear);
    }
}

TEST_CASE("time and memory limits end the reader, not the program", "[media][vdb]") {
    const tests::GridFolder folder;
    const std::string path = folder.grid("lump");
    media::VdbLoadOptions options;
    options.time_limit = 1e-6;
    CHECK(tests::vdb_refusal(path, "density", options).find("seconds") != std::string::npos);
    options = {};
    options.memory_limit = 1 << 20;
    CHECK_FALSE(tests::vdb_refusal(path, "density", options).empty());
    ::setenv("MOTE_GRID_READER", "/nonexistent/reader", 1);
    CHECK(tests::vdb_refusal(path).find("/nonexistent/reader") != std::string::npos);
    ::setenv("MOTE_GRID_READER", "/bin/true", 1);
    CHECK(tests::vdb_refusal(path).find("code 0") != std::string::npos);
    const auto reader_is = [&](const std::string& script) {
        tests::write_bytes(folder.file("reader"), "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(folder.file("reader"), std::filesystem::perms::owner_all);
        ::setenv("MOTE_GRID_READER", folder.file("reader").c_str(), 1);
    };
    reader_is("kill -SEGV $$");
    CHECK(tests::vdb_refusal(path).find("crashed") != std::string::npos);
    reader_is("exec sleep 100");
    options = {};
    options.time_limit = 0.3;
    CHECK(tests::vdb_refusal(path, "density", options).find("seconds") != std::string::npos);
    ::unsetenv("MOTE_GRID_READER");
    CHECK(tests::vdb_refusal(path).empty());
}

TEST_CASE("damaged VDB files never harm the program", "[media][vdb][damage]") {
    const tests::GridFolder folder;
    core::Rng rng(2024);
    int read = 0, refused = 0, crashed = 0;
    media::VdbLoadOptions options;
    options.time_limit = 10.0;
    for (const char* kind : {"lump", "half", "tiles"}) {
        const std::string good = tests::read_bytes(folder.grid(kind));
        const std::string path = folder.file("damaged.vdb");
        for (int i = 0; i < 60; ++i) {
            std::string bytes = good;
            if (i % 8 == 0)
                bytes.resize(rng.next_u32() % bytes.size());
            else
                for (int k = 0; k <= i % 4; ++k) {
                    const std::size_t range =
                        i % 2 ? std::min<std::size_t>(bytes.size(), 2000) : bytes.size();
                    bytes[rng.next_u32() % range] = char(rng.next_u32());
                }
            tests::write_bytes(path, bytes);
            const std::string message = tests::vdb_refusal(path, "density", options);
            message.empty() ? ++read : ++refused;
            crashed += message.find("crashed") != std::string::npos;
            if (!message.empty()) {
                REQUIRE(message.find(path) == 0);
                REQUIRE(message.find('\n') == std::string::npos);
                REQUIRE(message.size() < 1500);
            }
        }
    }
    std::cout << "damaged VDB files: " << read << " read, " << refused
              << " refused, of which the reader crashed on " << crashed << "\n";
    CHECK(refused > 30);  // every truncation at least
}

TEST_CASE("real VDB files are read or refused with a reason", "[media][vdb][data]") {
    const auto folder = tests::test_data("vdb");
    if (!folder) return;
    int files = 0, grids = 0, read = 0, refused = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder)) {
        if (entry.path().extension() != ".vdb") continue;
        ++files;
        const std::string path = entry.path().string();
        for (const auto& info : media::list_vdb_grids(path)) {
            ++grids;
            const std::string message = tests::vdb_refusal(path, info.name);
            message.empty() ? ++read : ++refused;
            INFO(path << " " << info.name << ": " << message);
            const bool fog =
                info.grid_class != "level set" && (info.type.find("float") != std::string::npos ||
                                                   info.type.find("int32") != std::string::npos);
            CHECK(message.empty() == fog);
            if (!message.empty()) std::cout << "refused " << message << "\n";
        }
    }
    std::cout << "real VDB files: " << files << " with " << grids << " grids, " << read << " read, "
              << refused << " refused\n";
    CHECK(files == 12);
    CHECK(read + refused == grids);

    const auto smoke = media::load_vdb_grid(*folder + "/gaffer/GafferVDBTest/data/smoke.vdb");
    CHECK(smoke->max_value() == Approx(5.71).margin(0.01));
    CHECK(smoke->active_voxels() > 1'000'000);
    CHECK(media::load_vdb_grid(*folder + "/openusd/smoke_000001.vdb")->empty());
    CHECK(media::load_vdb_grid(*folder + "/arnold-usd/test_2315/data/grids.vdb")->warnings().size() == 1);
    CHECK(tests::vdb_refusal(*folder + "/arnold-usd/test_17642/data/torus01.vdb").find("voxel_fog_density") !=
          std::string::npos);
}

TEST_CASE("The memory of a grid is known from its file's metadata", "[vdb][memory]") {
    const tests::GridFolder folder;
    const std::string path = folder.grid("lump");
    const double bytes = double(media::load_vdb_grid(path)->bytes());
    const double foretold = media::vdb_grid_memory(path, "density", 0.0);
    INFO(bytes << " and " << foretold << " bytes");
    CHECK(foretold > 0.3 * bytes);
    CHECK(foretold < 1.5 * bytes);
    CHECK(media::vdb_grid_memory(path, "density") == double(std::filesystem::file_size(path)));
    CHECK_THROWS_AS(media::vdb_grid_memory(path, "smoke", 0.0), core::InputError);
    CHECK_THROWS_AS(media::vdb_grid_memory(folder.file("none.vdb"), "density"), core::InputError);
}
