// render_scene SCENE OUT.exr PASSES [NAME=VALUE...]: `mote render SCENE -o OUT.exr --passes PASSES -D
// NAME=VALUE`, to the bit, as two calls.
#include <mote/core/formats/pictures/image_file.h>
#include <mote/core/objects/error.h>
#include <mote/session/loaded_scene.h>
#include <mote/session/render.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

using namespace mote;

/// Prints how many passes there are.
struct Passes final : session::RenderObserver {
    void progress(const core::RenderProgress& p) override { std::fprintf(stderr, "\r%u passes", p.passes); }
};

int main(int argc, char** argv) {
    if (argc < 4) return std::fputs("render_scene SCENE OUT.exr PASSES [NAME=VALUE...]\n", stderr), 2;
    try {
        session::SceneChanges changes;
        for (int i = 4; i < argc; ++i) {
            const std::string text = argv[i];
            const std::size_t equals = std::min(text.find('='), text.size());
            changes.defines.emplace_back(text.substr(0, equals),
                                         text.substr(std::min(equals + 1, text.size())));
        }
        const session::LoadedScene scene = session::LoadedScene::from_file(argv[1], changes);
        for (const std::string& warning : scene.warnings()) std::fprintf(stderr, "%s\n", warning.c_str());

        session::RenderSettings settings;
        settings.stop.passes = std::uint32_t(std::atoi(argv[3]));
        Passes passes;
        const session::Rendered rendered = session::render(scene, settings, passes);
        core::write_exr(argv[2], rendered.image);
        std::printf("\n%s: %d x %d pixels, %u passes\n", argv[2], rendered.image.width, rendered.image.height,
                    rendered.passes);
    } catch (const core::InputError& error) {  // with file and line
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
