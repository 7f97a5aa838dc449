// The harness of damaged files: its originals are sound, its damage is the same for a seed, and it notices a
// reader that breaks.
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tools/fuzz/formats.h"
#include "tools/fuzz/mutate.h"
#include "tools/fuzz/seeds.h"

using namespace mote::fuzz;
using mote::tests::TemporaryFolder;

namespace {

std::string write(const TemporaryFolder& folder, const std::string& name, const Bytes& bytes) {
    const std::string path = folder.file(name);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return path;
}

}  // namespace

TEST_CASE("Every format of the harness reads its own originals", "[fuzz]") {
    const TemporaryFolder folder;
    write_neighbours(folder.path());
    std::set<std::string> with_none;
    for (const Format& format : formats()) {
        const std::vector<Bytes> seeds = format.seeds();
        if (seeds.empty()) with_none.insert(format.name);
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            std::string message;
            const Outcome outcome =
                try_file(format, write(folder, std::to_string(i) + format.extension, seeds[i]), message);
            INFO(format.name << " " << i << ": " << message);
            CHECK(outcome == Outcome::read);
        }
    }
    CHECK(with_none == std::set<std::string>{"vdb"});  // written by a program of their own
}

TEST_CASE("Damage depends on the key alone, and does damage", "[fuzz]") {
    const std::vector<Format> all = formats();
    const Format& ply = find_format(all, "ply");
    const std::vector<Bytes> seeds = ply.seeds();
    std::set<Bytes> different;
    for (std::uint64_t key = 0; key < 200; ++key) {
        const Bytes bytes = mutate(seeds, ply, key);
        CHECK(bytes == mutate(seeds, ply, key));
        different.insert(bytes);
    }
    CHECK(different.size() > 180);
    CHECK_THROWS_AS(find_format(all, "plyy"), std::invalid_argument);
}

TEST_CASE("Forged checksums let damage through", "[fuzz]") {
    const TemporaryFolder folder;
    const std::vector<Format> all = formats();
    const Format& checkpoint = find_format(all, "checkpoint");
    Bytes bytes = checkpoint.seeds().front();
    bytes[bytes.size() - 20] ^= 1;  // in the last sum of the film
    std::string message;
    CHECK(try_file(checkpoint, write(folder, "a.checkpoint", bytes), message) == Outcome::refused);
    CHECK_THAT(message, ContainsSubstring("checksum"));
    checkpoint.forge(bytes);
    CHECK(try_file(checkpoint, write(folder, "b.checkpoint", bytes), message) == Outcome::read);
}

TEST_CASE("A reader that throws something else is a defect", "[fuzz][planted]") {
    const TemporaryFolder folder;
    Format broken = formats().front();
    broken.read = [](const std::string&) { throw std::out_of_range("an index"); };
    std::string message;
    CHECK(try_file(broken, folder.file("none"), message) == Outcome::defect);
    CHECK(message == "an index");
}
