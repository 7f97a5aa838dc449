// pbrt scenes of tests: files in a folder, what they are converted to, and their errors.
#pragma once

#include <fstream>

#include "core/formats/pbrt/pbrt_scene.h"
#include "core/formats/xml/scene_loader.h"
#include "tests/core/scene/scene_fixture.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

namespace mote::tests {

class PbrtFolder {
  public:
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_.file(name), std::ios::binary) << text;
    }
    std::string file(const std::string& name) const { return folder_.file(name); }

    /// The file scene.pbrt in our language; meshes and pictures lie in the folder `converted`.
    core::ConvertedScene convert() const {
        std::filesystem::create_directories(file("converted"));
        return core::convert_pbrt(file("scene.pbrt"), file("converted"), {});
    }
    core::ConvertedScene convert(const std::string& scene) const {
        write("scene.pbrt", scene);
        return convert();
    }
    std::unique_ptr<core::Scene> load(const std::string& scene, bool lenient = false) const {
        write("scene.pbrt", scene);
        core::LoadOptions options;
        options.lenient = lenient;
        return core::load_scene(file("scene.pbrt"), registry(), options);
    }
    /// The error of loading, without the folder's name.
    std::string error(const std::string& scene) const {
        try {
            load(scene);
        } catch (const core::InputError& error) {
            std::string text = error.what();
            const std::string path = folder_.path() + "/";
            for (std::size_t at; (at = text.find(path)) != std::string::npos;) text.erase(at, path.size());
            return text;
        }
        return "";
    }

  private:
    TemporaryFolder folder_;
};

/// A world with light and a film of 12 x 12 pixels around `content`.
inline std::string pbrt_world(const std::string& content, const std::string& before = "") {
    return "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12 PixelFilter \"box\"\n" +
           before + "\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n" + content + "\n";
}

}  // namespace mote::tests
