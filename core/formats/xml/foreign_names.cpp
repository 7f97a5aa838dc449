// Tables of Mitsuba's parameters and types that have no effect or another name here.
#include "core/formats/xml/foreign_names.h"

#include <algorithm>
#include <array>

namespace mote::core {
namespace {

struct NoEffect {
    Category category;
    const char* name;
    const char* harmless = "";  ///< the only value that changes nothing; "" when none does
    bool legacy_only = false;
};

constexpr NoEffect no_effect[] = {
    {Category::integrator, "emitter_samples"},
    {Category::integrator, "bsdf_samples"},
    {Category::integrator, "shading_samples"},
    {Category::integrator, "use_spectral_mis"},
    {Category::integrator, "use_nee"},
    {Category::integrator, "version"},               // of lajolla: which of its estimators of one picture
    {Category::integrator, "sample_num", "", true},  // of Rainbow: the sampler's sample_count counts
    {Category::integrator, "delta", "", true},       // of Rainbow: samples between two pictures
    {Category::integrator, "strict_normals", "", true},
    {Category::integrator, "timeout"},
    {Category::integrator, "samples_per_pass"},
    {Category::integrator, "block_size"},
    {Category::film, "banner", "", true},
    {Category::film, "attach_log", "", true},
    {Category::film, "file_format"},
    {Category::film, "pixel_format"},
    {Category::film, "component_format"},
    {Category::film, "sample_border"},
    {Category::film, "high_quality_edges", "", true},
    {Category::film, "compensate"},
    {Category::film, "filename", "", true},
    {Category::film, "gamma", "", true},
    {Category::film, "exposure", "", true},
    {Category::film, "tonemap_method", "", true},
    {Category::sampler, "seed"},
    {Category::sampler, "jitter"},
    {Category::sampler, "dimension", "", true},
    {Category::sampler, "scramble", "", true},
    {Category::sensor, "shutter_open"},
    {Category::sensor, "shutter_close"},
    {Category::sensor, "focus_distance"},
    {Category::emitter, "sampling_weight"},
    {Category::texture, "accel"},
    {Category::texture, "format"},
    {Category::texture, "cache", "", true},
    {Category::texture, "max_anisotropy", "", true},
    {Category::volume, "accel"},
    {Category::medium, "sample_emitters"},
    {Category::medium, "has_spectral_extinction"},
    {Category::medium, "step_size", "", true},
    {Category::medium, "method", "", true},
    {Category::bsdf, "sample_visible"},
    {Category::bsdf, "ext_eta", "1", true},
    {Category::shape, "subdiv", "", true},  // of a sphere: how finely to tessellate; ours is exact
    {Category::shape, "max_smooth_angle", "0", true},
    {Category::shape, "collapse", "false", true},
    {Category::shape, "subdiv", "", true},  // of Rainbow: triangles of a sphere, which is exact here
};

struct Replacement {
    Category category;
    const char *from, *to;
    bool legacy_only;
};

constexpr Replacement replacements[] = {
    {Category::sampler, "ldsampler", "sobol", false},  {Category::sampler, "multijitter", "sobol", false},
    {Category::sampler, "stratified", "sobol", false}, {Category::sampler, "orthogonal", "sobol", false},
    {Category::sampler, "halton", "sobol", true},      {Category::sampler, "hammersley", "sobol", true},
    {Category::film, "ldrfilm", "hdrfilm", true},
};

bool known(const Manual& manual, const std::string& name) {
    return std::any_of(manual.parameters.begin(), manual.parameters.end(),
                       [&](const Parameter& p) { return p.name == name; });
}

const NoEffect* find_no_effect(const Element& parameter, Category category) {
    const std::string name = parameter.get("name");
    for (const NoEffect& entry : no_effect)
        if (entry.category == category && entry.name == name && (parameter.legacy || !entry.legacy_only))
            return &entry;
    return nullptr;
}

/// "1" and "1.0" are the same number.
bool same_value(const std::string& a, const std::string& b) {
    if (a == b) return true;
    return a.find_first_not_of("0123456789.") == std::string::npos && !a.empty() &&
           std::strtod(a.c_str(), nullptr) == std::strtod(b.c_str(), nullptr);
}

}  // namespace

void drop_foreign_parameters(Element& e, const Manual& manual, std::vector<std::string>& warnings) {
    std::string dropped;
    int count = 0;
    std::erase_if(e.children, [&](Element& c) {
        if (c.fault || known(manual, c.get("name"))) return false;
        const NoEffect* entry = find_no_effect(c, manual.category);
        if (!entry) return false;
        if (*entry->harmless && !same_value(c.get("value"), entry->harmless))
            return c.guard([&] {
                throw InputError("'" + c.get("name") + "' is not supported unless it is " + entry->harmless,
                                 c.where);
            });
        dropped += (count++ == 0 ? "'" : ", '") + c.get("name") + "'";
        return true;
    });
    if (count > 0)
        warnings.push_back(InputError(dropped + " of " + category_name(manual.category) + " '" + manual.type +
                                          (count == 1 ? "' has" : "' have") + " no effect here",
                                      e.where)
                               .what());
}

void drop_foreign_elements(Element& scene, std::vector<std::string>& warnings) {
    // Rainbow: final picture or preview; and what its author switched off.
    for (const auto& foreign : {std::pair("mode", "a mode of another renderer has no effect"),
                                std::pair("hide", "a hidden element is left out")})
        std::erase_if(scene.children, [&](const Element& e) {
            if (e.tag != foreign.first) return false;
            warnings.push_back(InputError("<" + e.tag + ">: " + foreign.second, e.where).what());
            return true;
        });
    for (Element& e : scene.children) drop_foreign_elements(e, warnings);
}

void replace_foreign_types(Element& scene, const Registry& registry, std::vector<std::string>& warnings) {
    for (Element& e : scene.children) {
        replace_foreign_types(e, registry, warnings);
        const auto category = find_category(e.tag);
        if (!category || registry.find(*category, e.get("type"))) continue;
        for (const Replacement& r : replacements) {
            if (r.category != *category || e.get("type") != r.from || (r.legacy_only && !e.legacy)) continue;
            e.set("type", r.to);
            warnings.push_back(
                InputError(e.tag + " '" + r.from + "' is replaced by '" + r.to + "'", e.where).what());
            break;
        }
    }
}

std::string replacement_of(Category category, const std::string& type) {
    for (const Replacement& r : replacements)
        if (r.category == category && r.from == type) return r.to;
    return "";
}

}  // namespace mote::core
