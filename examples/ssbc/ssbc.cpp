// Screen-space bias compensation of a picture file, of whatever renderer: reads positions, normals,
// reflectance and light from an EXR, adds what a bound on the geometry term took, writes the result.
//
//   mote render room.xml --passes 4 --auxiliary -o room.exr      (the scene beside this file)
//   ssbc room.exr compensated.exr
#include <mote/core/formats/pictures/image_file.h>
#include <mote/screenspace/ssbc/ssbc.h>
#include <mote/screenspace/ssbc/ssbc_picture.h>

#include <cstdio>
#include <exception>

using namespace mote;

int main(int argc, char** argv) try {
    if (argc != 3) return std::fputs("usage: ssbc IN.exr OUT.exr\n", stderr), 2;
    core::ImageChannels image = core::read_exr(argv[1]);
    const screenspace::SsbcPicture picture = screenspace::read_ssbc_picture(image, {});
    screenspace::SsbcSettings settings;
    settings.bound = std::stof(image.metadata.at("bound"));  // [1/m^2], or a value of your own
    const auto result = screenspace::compensate(picture.surfaces, picture.light, settings);

    std::vector<core::Rgb> beauty = image.rgb("");
    double light = 0.0, added = 0.0;
    for (std::size_t i = 0; i < beauty.size(); ++i) {
        light += double(core::average(beauty[i])), added += double(core::average(result.compensation[i]));
        beauty[i] += result.compensation[i];
    }
    core::ImageChannels out;
    out.width = image.width, out.height = image.height;
    out.add_rgb("", beauty);
    core::write_exr(argv[2], out);
    std::printf("%d x %d pixels: the compensation adds %.2f %% of the picture's light\n", out.width,
                out.height, 100.0 * added / light);
} catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
}
