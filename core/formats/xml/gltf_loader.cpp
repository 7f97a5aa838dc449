// Names of temporary files do not reach the user: messages name the glTF file, and it is what a checkpoint
// depends on.
#include "core/formats/xml/gltf_loader.h"

#include "core/formats/gltf/scratch_folder.h"
#include "core/formats/xml/faults.h"
#include "core/formats/xml/scene_making.h"
#include "core/objects/number_text.h"

namespace mote::core {
namespace {

std::string take(std::vector<std::pair<std::string, std::string>>& defines, const std::string& name) {
    std::string value;
    for (const auto& [key, given] : defines)
        if (key == name) value = given;
    std::erase_if(defines, [&](const auto& define) { return define.first == name; });
    return value;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

/// Rethrows what is being handled, under the names that the user gave.
[[noreturn]] void rethrow_renamed(const std::string& from, const std::string& to) {
    try {
        throw;
    } catch (const SceneErrors& errors) {
        std::vector<InputError> renamed;
        for (const InputError& e : errors.all()) renamed.emplace_back(replaced(e.what(), from, to));
        throw SceneErrors(std::move(renamed));
    } catch (const InputError& error) {
        throw InputError(replaced(error.what(), from, to));
    }
}

}  // namespace

GltfOptions take_gltf_options(std::vector<std::pair<std::string, std::string>>& defines) {
    GltfOptions options;
    options.camera = take(defines, "camera");
    if (const std::string emission = take(defines, "emission"); !emission.empty()) {
        options.emission = parse_number(emission, {"-D emission", 0});
        if (options.emission < 0.0) throw InputError("must not be negative", {"-D emission", 0});
    }
    return options;
}

std::vector<std::string> gltf_approximations(const GltfScene& scene, const std::string& path, bool lenient) {
    std::vector<std::string> lines;
    Faults faults;
    for (const GltfFault& fault : scene.report.faults) {
        const InputError error(fault.what, {path, 0});
        faults.add(nullptr, error);
        lines.push_back(std::string(error.what()) + ": " + fault.done);
    }
    if (!lenient) faults.throw_all({});
    return lines;
}

std::unique_ptr<Scene> load_gltf_scene(const std::string& path, const Registry& registry,
                                       const LoadOptions& options) {
    LoadOptions others = options;
    GltfOptions conversion = take_gltf_options(others.defines);
    const ScratchFolder folder;
    const std::string prefix = folder.path() + "/";
    const auto named = [&](const std::string& text) { return replaced(text, prefix, path + ": "); };
    conversion.prefix = prefix;
    try {
        const GltfScene gltf = convert_gltf(path, folder.path(), conversion);
        SceneDefines defines(others.defines);
        SceneDocument document = read_scene_text(gltf.xml, folder.path(), path + " as XML", defines);
        document.approximations = gltf_approximations(gltf, path, options.lenient);
        auto scene =
            make_scene(std::move(document), defines, registry, others, path, [&](Scene::Parts& parts) {
                for (std::string& warning : parts.warnings) warning = named(warning);
                for (const std::string& note : gltf.report.notes)
                    parts.warnings.push_back(path + ": " + note);
                parts.input_files = gltf.files;
            });
        if (options.report)
            for (std::string& line : options.report->approximations) line = named(line);
        return scene;
    } catch (const InputError&) {
        rethrow_renamed(prefix, path + ": ");
    }
}

}  // namespace mote::core
