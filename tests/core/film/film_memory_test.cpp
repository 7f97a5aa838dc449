// Stated memory of a film against that of the allocator.
#include <malloc.h>

#include "core/film/film_image.h"
#include "core/film/film_memory.h"
#include "core/objects/memory_error.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

double allocated() {
    const struct mallinfo2 info = ::mallinfo2();
    return double(info.uordblks) + double(info.hblkhd);
}

constexpr int width = 500, height = 300;

std::vector<Layer> layers(bool auxiliary, std::size_t parts, bool squares = false) {
    std::vector<Layer> list;
    for (std::size_t i = 0; i < 3; ++i) {
        list.push_back({"light" + std::to_string(i), "", false, squares});
        list.back().part = i % parts, list.back().fine = i == 1;  // counts in films of whole passes
    }
    for (int i = 0; auxiliary && i < 4; ++i) list.push_back({"N" + std::to_string(i), "", true, true});
    return list;
}

}  // namespace

TEST_CASE("The memory of films and pictures is known before they are made", "[memory][film]") {
    for (const bool auxiliary : {false, true})
        for (const std::size_t parts : {1, 2})
            for (const std::uint32_t passes : {1u, 6u, 8u}) {
                const PassSplit split = parts == 2    ? PassSplit::halves
                                        : passes == 6 ? PassSplit::whole
                                                      : PassSplit::groups;
                const auto all = layers(auxiliary, parts, auxiliary);  // filtered or not, too
                const FilmMemory said(width, height, all, false, passes, split);
                const double before = allocated();
                Film film(width, height, all, false, split);
                const double begin = allocated() - before;
                for (std::size_t part = 0; part < parts; ++part) {
                    const PassImage image(width, height, film.layers_of(part).size());
                    for (std::uint32_t pass = 0; pass < passes; ++pass) film.add_pass(image, part);
                }
                const double sums = allocated() - before;
                const ImageChannels image = film_image(film);
                const double picture = allocated() - before;
                INFO(auxiliary << " " << parts << " " << passes << ": " << begin << " of " << said.begin()
                               << ", " << sums << " of " << said.sums() << ", " << picture << " of "
                               << said.peak());
                if (before == 0.0) return;  // another allocator, of a sanitizer
                CHECK(begin < 1.01 * said.begin() + 1e5);
                CHECK(begin > 0.99 * said.begin() - 1e5);
                CHECK(sums < 1.01 * said.sums() + 1e5);
                CHECK(sums > 0.9 * said.sums());  // blocks that wait for their other half come and go
                CHECK(picture < said.peak());
                // Or what the noise takes before it, and the error of groups more than that.
                if (split != PassSplit::groups) CHECK(picture > 0.7 * said.peak());
            }
}

TEST_CASE("A film that does not fit is refused with the largest that does", "[memory][film]") {
    const FilmMemory needed(4000, 1000, layers(true, 1));
    CHECK_NOTHROW(needed.require(MemoryBudget(needed.peak())));
    CHECK_THROWS_AS(needed.require(MemoryBudget(needed.peak()), 1.0), OutOfMemory);
    const double quarter = 0.2501 * needed.peak();
    CHECK_THROWS_WITH(needed.require(MemoryBudget(quarter)),
                      ContainsSubstring("a film of 4000 x 1000 pixels and 7 layers (") &&
                          ContainsSubstring("at most 2000 x 500 pixels of this shape fit"));
    CHECK_NOTHROW(FilmMemory(2000, 500, layers(true, 1)).require(MemoryBudget(quarter)));
}
