// Pictures of other renderers: surfaces and camera from channels, and what is said of those that lack some.
#include "screenspace/ssbc/ssbc_picture.h"

#include <algorithm>

#include "core/objects/error.h"
#include "tests/screenspace/ssbc_exr.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

const Pinhole camera{{0.2, 0.3, 3.6}, {0.1, 0, 0}, {0.1, 1, 0}, std::tan(0.35), 64, 48};

void rename_layer(ImageChannels& image, const std::string& from, const std::string& to) {
    for (std::string& name : image.names)
        if (name.starts_with(from + ".")) name = to + name.substr(from.size());
}

std::string refusal(const ImageChannels& image, const SsbcChannels& channels = {}) {
    try {
        read_ssbc_picture(image, channels);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Channels give back the surfaces and the light", "[ssbc][picture]") {
    const TestPicture picture = picture_of(room_walls(), camera);
    ImageChannels image = exr_of(picture, camera);
    const auto check = [&](const SsbcPicture& read) {
        for (std::size_t i = 0; i < picture.light.size(); ++i) {
            CHECK(read.surfaces.area[i] == Approx(picture.surfaces.area[i]).epsilon(2e-3));
            CHECK(read.surfaces.facing[i] == Approx(picture.surfaces.facing[i]).epsilon(1e-3).margin(1e-4));
            CHECK(read.light[i].x == Approx(picture.light[i].x).margin(1e-5));
        }
    };
    const SsbcPicture layers = read_ssbc_picture(image, {});
    CHECK(layers.light_from == "direct + indirect_bounded");
    check(layers);
    rename_layer(image, "direct", "other");  // then it is the beauty less the emission
    const SsbcPicture beauty = read_ssbc_picture(image, {});
    CHECK(beauty.light_from == "R, G, B - emission");
    check(beauty);
    rename_layer(image, "P", "Position"), rename_layer(image, "Albedo", "DiffCol");
    check(read_ssbc_picture(image, {"Position", "N", "DiffCol", {"other", "indirect_bounded"}}));
}

TEST_CASE("Positions in camera space are recognised", "[ssbc][picture]") {
    const TestPicture picture = picture_of(room_walls(), camera);
    TestPicture moved = picture;
    const Vec3d f = glm::normalize(camera.target - camera.eye), r = glm::normalize(glm::cross(f, camera.up));
    const glm::dmat3 rotation = glm::transpose(glm::dmat3(r, glm::cross(r, f), -f));  // looking along -z
    for (std::size_t i = 0; i < moved.light.size(); ++i) {
        moved.surfaces.position[i] = Vec3(rotation * (Vec3d(picture.surfaces.position[i]) - camera.eye));
        moved.surfaces.normal[i] = Vec3(rotation * Vec3d(picture.surfaces.normal[i]));
    }
    ImageChannels image = exr_of(moved, camera);
    for (const bool attribute : {true, false}) {
        if (!attribute) image.metadata.clear();
        const SsbcPicture read = read_ssbc_picture(image, {});
        for (std::size_t i = 0; i < picture.light.size(); ++i)
            CHECK(read.surfaces.area[i] == Approx(picture.surfaces.area[i]).epsilon(2e-3));
    }
}

TEST_CASE("What a picture lacks is named", "[ssbc][picture]") {
    const TestPicture picture = picture_of(room_walls(), camera);
    const ImageChannels whole = exr_of(picture, camera);
    CHECK(refusal(whole).empty());
    ImageChannels image = whole;
    rename_layer(image, "Albedo", "Albeda"), rename_layer(image, "N", "Normal");
    CHECK(contains(refusal(image), "lacks 'N' (normal), 'Albedo' (diffuse reflectance)"));
    image = whole;
    rename_layer(image, "Albedo", "Albeda");
    CHECK(contains(refusal(image), "did you mean 'Albeda'?"));
    image = whole, image.metadata.clear();
    CHECK(contains(refusal(image), "no attribute worldToCamera"));
    image = whole;
    for (std::size_t c = 0; c < image.names.size(); ++c)
        if (image.names[c] == "P.X") std::reverse(image.channels[c].begin(), image.channels[c].end());
    CHECK(contains(refusal(image), "pixels off a pinhole camera"));
    image = whole;
    for (std::size_t c = 0; c < image.names.size(); ++c)
        if (image.names[c] == "Albedo.G") image.channels[c][64 + 5] = 1.2f;
    CHECK(contains(refusal(image), "reflectance at pixel (5, 1)"));
    CHECK(contains(refusal(whole, {"P", "N", "Albedo", {"indirect"}}), "there is no layer 'indirect'"));
}
