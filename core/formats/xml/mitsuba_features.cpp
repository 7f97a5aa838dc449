// The names are those of the plugins that Mitsuba 3.9.1 installs (mitsuba/plugins), with the integrators that
// it writes in Python.
#include "core/formats/xml/mitsuba_features.h"

#include <sstream>

#include "core/formats/xml/foreign_integrators.h"
#include "core/formats/xml/foreign_names.h"

namespace mote::core {
namespace {

struct Plugins {
    Category category;
    const char* names;
};

constexpr Plugins plugins[] = {
    {Category::bsdf,
     "blendbsdf bumpmap circular conductor dielectric diffuse hair mask measured measured_polarized "
     "normalmap null plastic polarizer pplastic principled principledthin retarder roughconductor "
     "roughdielectric "
     "roughplastic thindielectric twosided"},
    {Category::texture,
     "bitmap blackbody checkerboard d65 irregular mesh_attribute rawconstant regular srgb uniform volume"},
    {Category::shape,
     "blender bsplinecurve cube cylinder disk ellipsoids ellipsoidsmesh instance linearcurve merge obj ply "
     "rectangle sdfgrid serialized shapegroup sphere"},
    {Category::emitter,
     "area constant directional directionalarea envmap point projector spot sunsky timed_sunsky"},
    {Category::sensor, "batch distant irradiancemeter orthographic perspective radiancemeter thinlens"},
    {Category::film, "hdrfilm specfilm"},
    {Category::rfilter, "box catmullrom gaussian lanczos mitchell tent"},
    {Category::sampler, "independent ldsampler multijitter orthogonal stratified"},
    {Category::medium, "heterogeneous homogeneous"},
    {Category::phase, "blendphase hg isotropic rayleigh sggx tabphase"},
    {Category::volume, "constvolume gridvolume"},
    {Category::integrator,
     "aov depth direct direct_projective moment path prb prb_basic prb_projective prbvolpath ptracer stokes "
     "volpath volpathmis"}};

struct Reason {
    const char *names, *text;
};

constexpr Reason reasons[] = {
    {"circular measured_polarized polarizer pplastic retarder", "light is not polarized here"},
    {"blackbody d65 irregular rawconstant regular srgb uniform",
     "colours are RGB: write <rgb>, or <spectrum> with a table"},
    {"blender ellipsoids ellipsoidsmesh", "made by Mitsuba's own tools, not by scene files"},
    {"batch distant irradiancemeter radiancemeter", "measures no picture"},
    {"specfilm", "colours are RGB"},
    {"catmullrom lanczos mitchell", "has negative parts, which no distribution of samples has"},
    {"depth", "--auxiliary writes the layer Depth with any integrator"}};

bool contains(const std::string& names, const std::string& name) {
    std::istringstream stream(names);
    for (std::string word; stream >> word;)
        if (word == name) return true;
    return false;
}

MitsubaFeature feature_of(Category category, const std::string& type, const Registry& registry) {
    if (registry.find(category, type)) return {category, type, "supported", ""};
    if (category == Category::integrator)
        for (const ForeignIntegrator& f : foreign_integrators())
            if (type == f.from)
                return {category, type, "approximated",
                        (*f.to ? "`" + std::string(f.to) + "`: " : std::string()) + f.note};
    if (const std::string to = replacement_of(category, type); !to.empty())
        return {category, type, "approximated", "`" + to + "`"};
    for (const Reason& reason : reasons)
        if (contains(reason.names, type)) return {category, type, "refused", reason.text};
    return {category, type, "refused", "not built yet"};
}

}  // namespace

std::vector<MitsubaFeature> mitsuba_features(const Registry& registry) {
    std::vector<MitsubaFeature> features;
    for (const Plugins& p : plugins) {
        std::istringstream stream(p.names);
        for (std::string type; stream >> type;) features.push_back(feature_of(p.category, type, registry));
    }
    return features;
}

std::string mitsuba_features_markdown(const Registry& registry) {
    std::string text =
        "\n## Mitsuba's plugins\n\nAll that Mitsuba 3.9.1 has, and what becomes of it here. What is refused "
        "is an error; with\n`--lenient` an unknown BSDF is a grey diffuse, and everything else unknown is "
        "left "
        "out.\n\n"
        "| category | plugin | state | by what, or why not |\n|---|---|---|---|\n";
    for (const MitsubaFeature& f : mitsuba_features(registry))
        text += "| " + category_name(f.category) + " | `" + f.type + "` | " + f.state + " | " +
                (f.remark.empty() ? " " : f.remark) + " |\n";
    return text;
}

}  // namespace mote::core
