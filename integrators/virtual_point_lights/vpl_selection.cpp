#include "integrators/virtual_point_lights/vpl_selection.h"

#include "core/objects/properties.h"

namespace mote::integrators {

using namespace core;

namespace {

using Kind = SelectionSettings::Kind;

SelectionSettings common(const Properties& p, Kind kind) {
    SelectionSettings s;
    s.kind = kind;
    s.max_bytes = std::size_t(1e6 * p.get_float_in("max_megabytes", 4096.0, 1e-3, 1e7));
    s.where = p.where;
    return s;
}

std::shared_ptr<Object> make_cut(const Properties& p, Kind kind) {
    SelectionSettings s = common(p, kind);
    s.cut.threshold = float(p.get_float_in("threshold", 0.02, 0.0, 1.0));
    s.cut.max_cut = std::uint32_t(p.get_int_in("max_cut", 1000, 1, 1 << 28));
    s.cut.error = float(p.get_float_in("error", 0.0, 0.0, 1.0));
    s.cut.shared_angle[0] = float(p.get_float_in("shared_angle", 0.0, 0.0, 10.0));
    s.cut.shared_angle[1] = float(p.get_float_in("shared_angle_in_media", 0.0, 0.0, 10.0));
    return std::make_shared<Selection>(s);
}

std::shared_ptr<Object> make_drawn(const Properties& p, Kind kind) {
    SelectionSettings s = common(p, kind);
    s.samples = std::uint32_t(p.get_int_in("samples", s.samples, 1, 1 << 20));
    s.learning = p.get_bool("learning", true);
    return std::make_shared<Selection>(s);
}

constexpr std::uint32_t default_candidates = 256, default_resampled = 32;

std::shared_ptr<Object> make_resampling(const Properties& p, Kind kind) {
    using Proposal = ResamplingSettings::Proposal;
    using lights::SpatialReuse;
    SelectionSettings s = common(p, kind);
    s.samples = std::uint32_t(p.get_int_in("samples", default_resampled, 1, 1 << 16));
    s.resampling.candidates = std::uint32_t(p.get_int_in("candidates", default_candidates, 1, 1 << 20));
    const std::string by = p.get_choice("candidates_by", "cut", {"cut", "groups", "light_tree", "power"});
    s.resampling.proposal = by == "power"        ? Proposal::power
                            : by == "groups"     ? Proposal::groups
                            : by == "light_tree" ? Proposal::light_tree
                                                 : Proposal::cut;
    s.learning = p.get_bool("learning", true);
    const std::string reuse = p.get_choice("reuse", "none", {"none", "unbiased", "biased"});
    s.resampling.reuse = reuse == "unbiased" ? SpatialReuse::unbiased
                         : reuse == "biased" ? SpatialReuse::biased
                                             : SpatialReuse::none;
    return std::make_shared<Selection>(s);
}

std::shared_ptr<Object> make_matrix(const Properties& p, Kind kind) {
    using Rows = lights::RowVisibilitySettings::Kind;
    SelectionSettings s = common(p, kind);
    lights::MatrixSettings& m = s.matrix;
    m.rows = std::uint32_t(p.get_int_in("rows", m.rows, 1, 1 << 16));
    m.columns = std::uint32_t(p.get_int_in("columns", m.columns, 1, 1 << 20));
    m.slices = std::uint32_t(p.get_int_in("slices", m.slices, 1, 1 << 12));
    const std::string rows =
        p.get_choice("row_visibility", "shadow_map", {"rays", "shadow_map", "imperfect_shadow_map"});
    m.visibility.kind = rows == "rays"         ? Rows::rays
                        : rows == "shadow_map" ? Rows::shadow_maps
                                               : Rows::imperfect;
    m.visibility.map_size = int(p.get_int_in("map_size", m.visibility.map_size, 4, 1024));
    m.visibility.imperfect.size = m.visibility.map_size;
    m.max_bytes = s.max_bytes;
    s.shared_passes = std::uint32_t(p.get_int_in("shared_passes", 1, 1, 1 << 20));
    return std::make_shared<Selection>(s);
}

const Parameter most_megabytes{"max_megabytes", "float", "4096",
                               "of the hierarchy while it is built; larger ones are refused"};
const std::vector<Parameter> cut_parameters{
    {"threshold", "float", "0.02",
     "share of a pixel's light that the error of one group may be; 0: all VPLs"},
    {"max_cut", "integer", "1000", "groups that a tile of 4 x 4 pixels is lit by at most"},
    {"error", "float", "0",
     "parting ends where the error of a tile is estimated to be this share of its light; 0: only by "
     "threshold"},
    {"shared_angle", "float", "0",
     "points of a face that a light sees within such an angle share a shadow ray [rad]; 0: none do"},
    {"shared_angle_in_media", "float", "0", "the same of points in media"},
    most_megabytes};
const Parameter learning{"learning", "boolean", "true",
                         "lights that are like those of which little arrived at the tiles before, of 16 x 16 "
                         "pixels, are drawn less often"};
const std::vector<Parameter> drawn_parameters{
    {"samples", "integer", "64", "lights drawn for each tile of 4 x 4 pixels"}, learning, most_megabytes};

const std::vector<Parameter> resampling_parameters{
    {"candidates", "integer", "256",
     "lights that a tile of 4 x 4 pixels looks at without shadow rays, on surfaces and along eye rays "
     "through "
     "media"},
    {"candidates_by", "string", "cut",
     "cut: two from each group of a cut, as stochastic lightcuts draw them, of all points of a pixel at "
     "once; "
     "light_tree: drawn by the hierarchy, alike; groups: eight by power from each group of a cut; power: by "
     "what lights send in all"},
    {"samples", "integer", "32", "of them chosen by each pixel, on surfaces and in media: shadow rays"},
    {"reuse", "string", "none",
     "unbiased, biased: on surfaces what a pixel of the tile before has chosen and sees is a candidate, too; "
     "biased leaves out the weights that make up for what only one of them sees"},
    {learning.name, learning.type, learning.default_value,
     learning.description + "; with cut and light_tree"},
    most_megabytes};
const std::vector<Parameter> matrix_parameters{
    {"rows", "integer", "256",
     "receivers at which all lights are looked at, of all slices; rounded up to 16 for each"},
    {"columns", "integer", "256",
     "groups of lights of a slice; one light of each lights a tile of 4 x 4 pixels"},
    {"slices", "integer", "4", "groups of receivers of like place and normal, each with its own columns"},
    {"row_visibility", "string", "shadow_map",
     "what stands between rows and lights: rays, shadow_map (volumetric, of what a receiver sees) or "
     "imperfect_shadow_map; with maps only the probabilities of lights err"},
    {"map_size", "integer", "32", "texels along an edge of such a map"},
    {"shared_passes", "integer", "1",
     "passes that have the same rows and groups: each pass has new lights, which join the groups of those "
     "that "
     "stand most like them"},
    {"max_megabytes", "float", "4096", "of rows and columns; larger ones are refused"}};

std::string example(const std::string& type) { return "<selection type=\"" + type + "\"/>"; }

}  // namespace

void register_selection(Registry& registry) {
    const auto add = [&](const std::string& type, const std::string& summary,
                         const std::vector<Parameter>& parameters, auto make, Kind kind) {
        registry.add({Category::selection, type, summary, parameters, example(type)},
                     [make, kind](const Properties& p) { return make(p, kind); });
    };
    registry.add({Category::selection,
                  "all",
                  "All virtual point lights at every receiver: brute force.",
                  {},
                  example("all")},
                 [](const Properties&) { return std::make_shared<Selection>(SelectionSettings{}); });
    add("lightcuts",
        "Groups of lights, each by one light that stands for it, as small as their largest error wants: "
        "biased "
        "within its threshold.",
        cut_parameters, make_cut, Kind::lightcuts);
    add("multidimensional_lightcuts",
        "Lightcuts over all points of a pixel at once: along its eye rays through media, on the surface "
        "behind "
        "them, and of all its eye paths.",
        cut_parameters, make_cut, Kind::multidimensional);
    add("stochastic_lightcuts", "One light drawn anew from each group of a cut: unbiased.", drawn_parameters,
        make_drawn, Kind::stochastic);
    add("light_tree", "Lights drawn by the hierarchy in proportion to what they may send: unbiased.",
        drawn_parameters, make_drawn, Kind::light_tree);
    add("resampling",
        "Few lights for each pixel, chosen among many candidates by what they would send if nothing stood "
        "between: unbiased, but for biased reuse.",
        resampling_parameters, make_resampling, Kind::resampling);
    add("matrix",
        "Matrix row-column sampling: groups of lights that send alike to a few receivers, for each slice of "
        "the "
        "picture, and one light drawn anew from each: unbiased.",
        matrix_parameters, make_matrix, Kind::matrix);
}

}  // namespace mote::integrators
