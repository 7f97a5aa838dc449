// A film that continues another one is of the same size, layers, squares and parts, and begins where that
// ends: each alone is refused.
#include "core/film/film.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

const std::vector<Layer> two_parts{{"a", ""}, {"b", "", false, false, "", {}, 1}};

}  // namespace

TEST_CASE("films of other sizes, layers, squares or parts do not continue one", "[film][conjunctions]") {
    const auto refuses = [](const Film& next) {
        Film film(4, 2, two_parts);
        CHECK_THROWS_AS(film.add(next), std::invalid_argument);
    };
    refuses(Film(4, 3, two_parts));
    refuses(Film(5, 2, two_parts));
    refuses(Film(4, 2, {{"a", ""}, {"c", "", false, false, "", {}, 1}}));
    refuses(Film(4, 2, {{"a", ""}, {"b", "", false, true, "", {}, 1}}));
    refuses(Film(4, 2, {{"a", "", false, false, "", {}, 1}, {"b", ""}}));
    refuses(Film(4, 2, {{"a", ""}, {"b", ""}}));
    refuses(Film(4, 2, two_parts, true));
    for (const std::size_t part : {0u, 1u}) {  // each part continues where it ends
        Film later(4, 2, two_parts);
        later.begin_at(part, 3);
        refuses(later);
    }
    // All squares are requested, or those of each layer.
    const std::vector<Layer> squared{{"a", "", false, true}, {"b", "", false, true, "", {}, 1}};
    CHECK_THROWS_AS(Film(4, 2, squared).add(Film(4, 2, squared, true)), std::invalid_argument);
    Film film(4, 2, two_parts);
    CHECK_NOTHROW(film.add(Film(4, 2, two_parts)));
}

TEST_CASE("a layer's passes are those of a layer of its own part", "[film][conjunctions]") {
    CHECK_NOTHROW(Film(2, 2, {{"hit", "", true}, {"Depth", "", true, false, "hit"}}));
    CHECK_THROWS_AS(Film(2, 2, {{"Depth", "", true, false, "hit"}}), std::invalid_argument);
    CHECK_THROWS_AS(Film(2, 2, {{"hit", "", true}, {"Depth", "", true, false, "hit", {}, 1}}),
                    std::invalid_argument);
}
