// Partial films made to do harm: their checksums are right, and what they say is not. Each
// is refused with its name, before memory is requested that the file cannot fill.
#include <cstring>
#include <fstream>

#include "apps/partial_render.h"
#include "core/objects/error.h"
#include "core/render/partial_film.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "tools/fuzz/seeds.h"

using namespace mote;
using namespace mote::fuzz;
using tests::TemporaryFolder;

namespace {

/// Where the head's fields begin: magic, version, size.
constexpr std::size_t fields_at = 16;

struct Forged {
    TemporaryFolder folder;
    Bytes bytes = partial_film(0, 5);

    /// `old` is once in the file; what comes instead has as many bytes.
    void replace(const std::string& old, const std::string& text) {
        const std::string all(bytes.begin(), bytes.end());
        REQUIRE((old.size() == text.size() && all.find(old) != std::string::npos));
        std::memcpy(bytes.data() + all.find(old), text.data(), text.size());
    }
    template <typename T>
    void put(std::size_t at, T value) {
        std::memcpy(bytes.data() + at, &value, sizeof(value));
    }
    std::size_t about_size() const {
        std::uint64_t size = 0;
        std::memcpy(&size, bytes.data() + fields_at, sizeof(size));
        return std::size_t(size);
    }
    std::size_t width_at() const { return fields_at + sizeof(std::uint64_t) + about_size(); }
    std::size_t film_at() const {
        std::uint32_t head = 0;
        std::memcpy(&head, bytes.data() + 12, sizeof(head));
        return head + sizeof(std::uint64_t);
    }
    std::string write(const std::string& name) const {
        const std::string path = folder.file(name);
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        return path;
    }
    /// Message of the InputError that reading ends with; it must name the file.
    std::string refusal() {
        forge_checkpoint(bytes);
        const std::string path = write("bad.film");
        try {
            apps::merge_partials({path});
        } catch (const core::InputError& error) {
            CHECK(error.where().file == path);
            return error.what();
        }
        return "read";
    }
};

}  // namespace

TEST_CASE("partial films that lie are refused", "[partial_film]") {
    Forged forged;
    SECTION("sound") { CHECK(forged.refusal() == "read"); }
    SECTION("a film of 2^40 pixels") {
        forged.put(forged.width_at(), std::uint32_t(1) << 20);
        forged.put(forged.width_at() + 4, std::uint32_t(1) << 20);
        CHECK_THAT(forged.refusal(), ContainsSubstring("its length is wrong"));
    }
    SECTION("ten thousand layers") {
        forged.put(forged.width_at() + 9, std::uint32_t(10000));
        CHECK_THAT(forged.refusal(), ContainsSubstring("this file is damaged"));
    }
    SECTION("more passes than there are bytes for") {
        forged.put(forged.film_at() + 40 + 4, std::uint32_t((1u << 23) - 1));
        CHECK_THAT(forged.refusal(), ContainsSubstring("its length is wrong"));
    }
    SECTION("texts that say something else") {
        const auto [old, other, what] = GENERATE(table<std::string, std::string, std::string>(
            {{"[0,5]", "[0,-]", "cannot be read"},
             {"[0,5]", "[0.5]", "no whole number"},
             {"[0,5]", "[0,6]", "other passes"},
             {"[0,5]", "[5,0]", "other passes"},
             {"[0,5]", "[5,5]", "other passes"},
             {"t\":12", "\":9e9", "no whole number"},
             {"t\":12", "\":-12", "no whole number"},
             {"\"0123456789ab\"", "[[[[[1]]]]]   ", "cannot be read"},
             {"[\"a=1\"]", "[0,1,2]", "cannot be read"},
             {"\"lenient\":false", "\"lenient\":[[]] ", "cannot be read"}}));
        forged.replace(old, other);
        CHECK_THAT(forged.refusal(), ContainsSubstring(what));
    }
}

TEST_CASE("a film of another size does not continue where one ends, whatever its text says",
          "[partial_film]") {
    Forged first, next;
    next.bytes = partial_film(5, 8);
    const std::string a = first.write("a.film"), b = first.folder.file("b.film");
    CHECK(apps::merge_partials({next.write("c.film"), a}).end == 8);
    core::Film larger(5, 3, {core::Layer{"direct", ""}, core::Layer{"indirect", ""}});
    larger.begin_at(0, 5);
    for (int i = 0; i < 3; ++i) larger.add_pass(core::PassImage(5, 3, 2));
    core::write_partial_film(b, {core::read_partial_film(next.write("c.film")).about, larger});
    CHECK_THROWS_WITH(apps::merge_partials({a, b}), ContainsSubstring("does not continue"));
}
