// Checkpoints of renders that differ in one thing: each is refused for its own reason.
#include <filesystem>

#include "core/film/film.h"
#include "core/render/checkpoint.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

TEST_CASE("a checkpoint of another width, height, layer or number of them is refused",
          "[checkpoint][conjunctions]") {
    const TemporaryFolder folder;
    const CheckpointKey key{"0123", 7};
    const auto refusal = [&](const Film& written, const CheckpointKey& own) {
        std::filesystem::remove(folder.file("c"));  // those of another render are not replaced
        write_checkpoint(folder.file("c"), own, written);
        Film film(5, 4, {{"a", ""}, {"b", ""}});
        try {
            read_checkpoint(folder.file("c"), key, film);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::vector<Layer> layers{{"a", ""}, {"b", ""}};
    CHECK(refusal(Film(5, 4, layers), key).empty());
    CHECK_THAT(refusal(Film(5, 3, layers), key), ContainsSubstring("its picture is 5 x 3"));
    CHECK_THAT(refusal(Film(6, 4, layers), key), ContainsSubstring("its picture is 6 x 4"));
    CHECK_THAT(refusal(Film(5, 4, {{"a", ""}}), key), ContainsSubstring("layers"));
    CHECK_THAT(refusal(Film(5, 4, {{"a", ""}, {"c", ""}}), key), ContainsSubstring("layers"));
    CHECK_THAT(refusal(Film(5, 4, {{"c", ""}, {"b", ""}}), key), ContainsSubstring("layers"));
    CHECK_THAT(refusal(Film(5, 4, layers), {"0123", 8}), ContainsSubstring("seed"));
    CHECK_THAT(refusal(Film(5, 4, layers), {"0124", 7}), ContainsSubstring("changed"));
}
