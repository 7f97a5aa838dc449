// Names of temporary files do not reach the user: messages name the foreign scene, and it is what a
// checkpoint depends on.
#include "core/formats/xml/converted_scenes.h"

#include "core/formats/conversion/scratch_folder.h"
#include "core/formats/gltf/gltf_scene.h"
#include "core/formats/pbrt/pbrt_scene.h"
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

bool is_foreign_scene(const std::string& path) { return is_gltf(path) || is_pbrt(path); }

ConvertedScene convert_foreign_scene(const std::string& path, const std::filesystem::path& folder,
                                     const ConversionOptions& options) {
    return is_pbrt(path) ? convert_pbrt(path, folder, options) : convert_gltf(path, folder, options);
}

ConversionOptions take_conversion_options(const std::string& path,
                                          std::vector<std::pair<std::string, std::string>>& defines) {
    ConversionOptions options;
    if (!is_gltf(path)) return options;
    options.camera = take(defines, "camera");
    if (const std::string emission = take(defines, "emission"); !emission.empty()) {
        options.emission = parse_number(emission, {"-D emission", 0});
        if (options.emission < 0.0) throw InputError("must not be negative", {"-D emission", 0});
    }
    return options;
}

std::vector<std::string> approximations_of(const ConvertedScene& scene, bool lenient) {
    std::vector<std::string> lines;
    Faults faults;
    for (const ConversionFault& fault : scene.report.faults) {
        if (!lenient) faults.add(nullptr, fault.error);
        lines.push_back(std::string(fault.error.what()) + ": " + fault.done);
    }
    faults.throw_all(scene.files);
    return lines;
}

std::unique_ptr<Scene> load_converted_scene(const std::string& path, const Registry& registry,
                                            const LoadOptions& options) {
    LoadOptions others = options;
    ConversionOptions conversion = take_conversion_options(path, others.defines);
    const ScratchFolder folder;
    const std::string prefix = folder.path() + "/";
    const auto named = [&](const std::string& text) { return replaced(text, prefix, path + ": "); };
    conversion.prefix = prefix;
    try {
        const ConvertedScene converted = convert_foreign_scene(path, folder.path(), conversion);
        SceneDefines defines(others.defines);
        SceneDocument document = read_scene_text(converted.xml, folder.path(), path + " as XML", defines);
        document.approximations = approximations_of(converted, options.lenient);
        auto scene =
            make_scene(std::move(document), defines, registry, others, path, [&](Scene::Parts& parts) {
                for (std::string& warning : parts.warnings) warning = named(warning);
                for (const std::string& note : converted.report.notes)
                    parts.warnings.push_back(path + ": " + note);
                parts.input_files = converted.files;
            });
        if (options.report)
            for (std::string& line : options.report->approximations) line = named(line);
        return scene;
    } catch (const InputError&) {
        rethrow_renamed(prefix, path + ": ");
    }
}

}  // namespace mote::core
