// Twelve thousand damaged scene files: each loads or ends in an InputError of one line, nothing else.
#include "core/math/random.h"
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

const char* const original = R"(<?xml version="1.0" encoding="utf-8"?>
<!-- a scene with a little of everything -->
<scene version="0.6.0">
    <default name="depth" value="5"/>
    <integrator type="fake"><integer name="maxDepth" value="$depth"/><float name="bound" value="1e-3"/>
        <rgb name="colour" value="0.1, 0.2, 0.3"/><spectrum name="picture" value="400:0.1, 550:0.3, 700:0.2"/>
    </integrator>
    <sensor type="perspective"><float name="fov" value="39.3077"/>
        <transform name="toWorld"><lookAt origin="0, 1, -8" target="0, 1, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="64"/><rfilter type="box"/></film>
        <sampler type="ldsampler"><integer name="sampleCount" value="4"/></sampler><ref id="fog"/>
    </sensor>
    <medium type="homogeneous" id="fog"><rgb name="sigma_t" value="0.5"/></medium>
    <bsdf type="twosided" id="wall"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
        <float name="uscale" value="8"/></texture></bsdf></bsdf>
    <shape type="cube"><transform name="toWorld"><scale x="2" y="1" z="0.5"/><rotate y="1" angle="30"/>
        <translate x="1"/></transform><ref id="wall"/></shape>
    <shape type="sphere"><point name="center" x="0" y="1" z="0"/><float name="radius" value="0.5"/>
        <bsdf type="null"/><ref name="interior" id="fog"/></shape>
    <alias id="wall" as="floor"/>
    <shape type="rectangle"><ref id="floor"/><emitter type="area"><rgb name="radiance" value="4"/></emitter></shape>
</scene>
)";

/// One to four changes: a byte set, removed or doubled, a stretch removed, or words swapped.
std::string mutate(std::string text, Rng& rng) {
    static const std::string bytes = "<>/\"'=&;$!?-. ,:0123456789eEnaif#\n\t\x01\x7f\xff\xc3";
    const auto at = [&] { return std::size_t(rng.next_u32()) % text.size(); };
    const int changes = 1 + int(rng.next_u32() % 4);
    for (int i = 0; i < changes && !text.empty(); ++i) {
        const std::size_t p = at();
        switch (rng.next_u32() % 6) {
            case 0:
                text[p] = bytes[rng.next_u32() % bytes.size()];
                break;
            case 1:
                text[p] = char(rng.next_u32());
                break;
            case 2:
                text.erase(p, 1 + rng.next_u32() % 12);
                break;
            case 3:
                text.insert(p, 1, bytes[rng.next_u32() % bytes.size()]);
                break;
            case 4:
                text.insert(p, text.substr(at(), rng.next_u32() % 60));
                break;
            default:
                text.resize(p < text.size() / 2 ? text.size() - 1 : p);
                break;
        }
    }
    return text;
}

}  // namespace

TEST_CASE("Damaged scene files load or are refused in one line", "[scene][mutation]") {
    REQUIRE(load_error(original) == "");
    Rng rng(20240501);
    int loaded = 0, refused = 0;
    for (int i = 0; i < 12000; ++i) {
        const std::string text = mutate(original, rng);
        try {
            load(text);
            ++loaded;
        } catch (const InputError& error) {
            const std::string message = error.what();
            ++refused;
            INFO(message);
            REQUIRE(message.find('\n') == std::string::npos);
            REQUIRE(message.find("test.xml") != std::string::npos);
        }
        // Anything else fails the test by leaving it.
    }
    CHECK(loaded > 200);
    CHECK(refused > 4000);
}
