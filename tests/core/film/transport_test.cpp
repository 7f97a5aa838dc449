// Cells of the transport as sets: what covers what, and their names.
#include "core/film/transport.h"

#include "tests/support/catch.h"

using namespace mote::core;

namespace {

using Names = std::vector<std::string>;
constexpr TransportSet positional = TransportSet::positional_scattering(),
                       other = TransportSet::other_scattering();

}  // namespace

TEST_CASE("light is sorted by its first scattering and their number", "[film][transport]") {
    for (const bool surface : {true, false}) {
        CHECK(transport_layer(0, surface) == Transport::emission);
        CHECK(transport_layer(1, surface) == (surface ? Transport::direct : Transport::single_scattering));
        for (const int more : {2, 3, 9})
            CHECK(transport_layer(more, surface) ==
                  (surface ? Transport::indirect : Transport::multiple_scattering));
    }
}

TEST_CASE("single scattering is both of its elements, and neither alone", "[film][transport][conjunctions]") {
    const TransportSet single = Transport::single_scattering;
    CHECK((positional | other) == single);
    CHECK((positional & other).empty());
    CHECK(single - positional == other);
    for (const TransportSet half : {positional, other}) {
        CHECK_FALSE(half[Transport::single_scattering]);
        CHECK_FALSE(half.contains(single));
        CHECK(single.contains(half));
        CHECK_FALSE((TransportSet(Transport::multiple_scattering) | Transport::direct).contains(half));
    }
}

TEST_CASE("all cells are the five, three of them without media", "[film][transport]") {
    TransportSet all;
    for (std::size_t i = 0; i < transport_count; ++i) {
        const auto cell = Transport(i);
        CHECK((all & cell).empty());
        all = all | cell;
        CHECK(TransportSet::all(false)[cell] == (i < transport_layer_count(false)));
    }
    CHECK(all == TransportSet::all());
    CHECK((TransportSet::all() - all).empty());
    CHECK(TransportSet::all().contains({}));
}

TEST_CASE("names of cells are read as they are written", "[film][transport]") {
    CHECK(transport_names(TransportSet::all()) ==
          Names{"emission", "direct", "indirect", "single_scattering", "multiple_scattering"});
    CHECK(transport_names(other | Transport::direct) == Names{"direct", "single_scattering_other"});
    CHECK(transport_name(positional) == "single_scattering_positional");
    CHECK(transport_name({}).empty());
    for (const TransportSet cells :
         {TransportSet::all(), TransportSet(), Transport::direct | Transport::emission,
          positional | Transport::indirect, other - positional})
        CHECK(read_transport(transport_name(cells)) == cells);
    CHECK(read_transport(" indirect  direct,emission") ==
          (Transport::direct | Transport::emission | Transport::indirect));
    CHECK_THROWS_WITH(read_transport("direct, dierct"),
                      ContainsSubstring("dierct") && ContainsSubstring("direct"));
}
