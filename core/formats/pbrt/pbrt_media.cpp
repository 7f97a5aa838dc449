// Media by type: coefficients as colours, grids as .vol files.
#include "core/formats/pbrt/pbrt_media.h"

#include <algorithm>
#include <array>

#include "core/formats/conversion/scene_xml.h"
#include "core/formats/pbrt/pbrt_presets.h"

namespace mote::core {
namespace {

/// pbrt integrates the emission of a black body over the matching function of luminance [nm], ours divides by
/// the integral of that function.
constexpr double luminance_integral = 106.856895;
constexpr int cloud_voxels = 128;

struct Writer {
    pugi::xml_node scene;
    const std::string& id;
    const PbrtObject& object;
    const Transform& to_world;
    double exposure;
    PbrtFiles& files;

    Rgb coefficient(const char* name, const Rgb& default_value) const {
        return pbrt_color(object, name, files, false).value_or(default_value);
    }
    pugi::xml_node element(const char* type) const {
        pugi::xml_node medium = add_object(scene, "medium", type, "", id);
        const double g = object.number("g", 0.0);
        if (g != 0.0) add_float(add_object(medium, "phase", "hg"), "g", g);
        return medium;
    }
    std::array<int, 3> resolution() const {
        const std::array<int, 3> n = {object.integer("nx", 1), object.integer("ny", 1),
                                      object.integer("nz", 1)};
        if (*std::min_element(n.begin(), n.end()) < 1) throw InputError("a grid has no voxels", object.where);
        return n;
    }
    /// Checks that a grid has a value for every voxel.
    void check_size(const char* name, std::size_t values, const std::array<int, 3>& n) const {
        const double voxels = double(n[0]) * n[1] * n[2];
        if (double(values) != voxels)
            throw InputError(std::string("'") + name + "' has " + std::to_string(values) + " values for " +
                                 std::to_string(std::int64_t(voxels)) + " voxels",
                             object.where);
    }
    void add_grid(pugi::xml_node medium, const char* name, const std::vector<float>& values, int channels,
                  const std::array<int, 3>& n) const;
};

/// A grid over the box from p0 to p1 of the medium's space.
void Writer::add_grid(pugi::xml_node medium, const char* name, const std::vector<float>& values, int channels,
                      const std::array<int, 3>& n) const {
    const std::int32_t header[5] = {1, n[0], n[1], n[2], channels};
    const float box[6] = {0, 0, 0, 1, 1, 1};
    std::string bytes = "VOL\x03";
    bytes.append(reinterpret_cast<const char*>(header), sizeof header);
    bytes.append(reinterpret_cast<const char*>(box), sizeof box);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    const std::string file = files.new_name(name, ".vol");
    files.write(file, std::as_bytes(std::span(bytes)));
    pugi::xml_node volume = add_object(medium, "volume", "gridvolume", name);
    add_value(volume, "string", "filename", files.in_xml(file));
    const Vec3d p0 = object.point("p0", Vec3d(0.0)), p1 = object.point("p1", Vec3d(1.0));
    add_transform(volume, "to_world",
                  to_world * Transform(glm::scale(glm::translate(glm::dmat4(1.0), p0), p1 - p0)));
}

/// Up to the rounding of spectra.
bool is_grey(const Rgb& c) { return max_component(c) - min_component(c) < 1e-3f * max_component(c); }

/// Extinction and albedo of a density that is multiplied by two colours.
struct Coefficients {
    double scale;  ///< largest component of the extinction
    Rgb sigma_t;   ///< over scale
    Rgb albedo;
};
Coefficients coefficients(const Writer& w) {
    const Rgb a = w.coefficient("sigma_a", Rgb(1.0f)), s = w.coefficient("sigma_s", Rgb(1.0f)), t = a + s;
    const float most = max_component(t);
    const auto ratio = [](float x, float y) { return y > 0.0f ? x / y : 0.0f; };
    return {double(most) * w.object.number("scale", 1.0),
            most > 0.0f ? t / most : Rgb(1.0f),
            {ratio(s.x, t.x), ratio(s.y, t.y), ratio(s.z, t.z)}};
}

void add_homogeneous(const Writer& w) {
    Rgb a = w.coefficient("sigma_a", Rgb(1.0f)), s = w.coefficient("sigma_s", Rgb(1.0f));
    if (const std::string preset = w.object.text("preset", ""); !preset.empty()) {
        const PbrtPreset& known = pbrt_preset(preset, w.object.find("preset")->where);
        a = known.sigma_a, s = known.sigma_s;
    }
    pugi::xml_node medium = w.element("homogeneous");
    add_rgb(medium, "sigma_a", a), add_rgb(medium, "sigma_s", s);
    add_float(medium, "scale", w.object.number("scale", 1.0));
    if (!w.object.find("Le")) return w.object.ignore({"Lescale"});
    add_rgb(medium, "Le",
            pbrt_light_color(w.object, "Le", w.files) * float(w.exposure * w.object.number("Lescale", 1.0)));
}

void add_temperature_scales(const Writer& w, pugi::xml_node medium, double scale) {
    add_float(medium, "Lescale", scale * w.exposure * luminance_integral);
    add_float(medium, "temperature_scale", w.object.number("temperaturescale", 1.0));
    add_float(medium, "temperature_offset",
              w.object.number("temperatureoffset", w.object.number("temperaturecutoff", 0.0)));
}

/// Density times a colour: one channel where it is grey.
void add_density(const Writer& w, pugi::xml_node medium, const std::vector<float>& density,
                 const std::array<int, 3>& n) {
    const Coefficients c = coefficients(w);
    add_float(medium, "scale", c.scale);
    add_rgb(medium, "albedo", c.albedo);
    if (is_grey(c.sigma_t)) return w.add_grid(medium, "sigma_t", density, 1, n);
    std::vector<float> colored;
    for (const float d : density)
        for (int i = 0; i < 3; ++i) colored.push_back(d * c.sigma_t[i]);
    w.add_grid(medium, "sigma_t", colored, 3, n);
}

std::vector<float> floats(const PbrtObject& object, const char* name) {
    const std::vector<double> numbers = object.numbers(name);
    return {numbers.begin(), numbers.end()};
}

void add_uniform_grid(const Writer& w) {
    const auto n = w.resolution();
    const std::vector<float> density = floats(w.object, "density"),
                             temperature = floats(w.object, "temperature");
    std::vector<float> scales = floats(w.object, "Lescale");
    w.check_size("density", density.size(), n);
    pugi::xml_node medium = w.element("heterogeneous");
    add_density(w, medium, density, n);
    if (!temperature.empty()) {
        w.check_size("temperature", temperature.size(), n);
        w.add_grid(medium, "temperature", temperature, 1, n);
        if (scales.size() > 1)
            w.files.fault(w.object.where, "a grid of factors on black bodies has no counterpart here",
                          "the first one counts");
        return add_temperature_scales(w, medium, scales.empty() ? 1.0 : double(scales[0]));
    }
    w.object.ignore({"temperaturescale", "temperatureoffset", "temperaturecutoff"});
    if (!w.object.find("Le")) return;
    const Rgb light = pbrt_light_color(w.object, "Le", w.files) * float(w.exposure);
    if (scales.empty()) scales.assign(density.size(), 1.0f);
    w.check_size("Lescale", scales.size(), n);
    std::vector<float> colored;
    for (const float s : scales)
        for (int i = 0; i < 3; ++i) colored.push_back(s * light[i]);
    w.add_grid(medium, "Le", colored, 3, n);
}

void add_rgb_grid(const Writer& w) {
    const auto n = w.resolution();
    const std::size_t voxels = std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]);
    const auto grid = [&](const char* name, float missing) {
        std::vector<float> values = floats(w.object, name);
        if (values.empty()) return std::vector<float>(3 * voxels, missing);
        w.check_size(name, values.size() / 3, n);
        return values;
    };
    if (!w.object.find("sigma_a") && !w.object.find("sigma_s"))
        throw InputError("an rgbgrid needs sigma_a or sigma_s", w.object.where);
    std::vector<float> extinction = grid("sigma_a", 1.0f), albedo = grid("sigma_s", 1.0f),
                       light = grid("Le", 0.0f);
    for (std::size_t i = 0; i < extinction.size(); ++i) {
        extinction[i] += albedo[i];
        albedo[i] = extinction[i] > 0.0f ? albedo[i] / extinction[i] : 0.0f;
    }
    pugi::xml_node medium = w.element("heterogeneous");
    add_float(medium, "scale", w.object.number("scale", 1.0));
    w.add_grid(medium, "sigma_t", extinction, 3, n), w.add_grid(medium, "albedo", albedo, 3, n);
    const double scale = w.object.number("Lescale", 1.0) * w.exposure;
    if (!w.object.find("Le")) return;
    for (float& v : light) v *= float(scale);
    w.add_grid(medium, "Le", light, 3, n);
}

void add_cloud(const Writer& w) {
    const double density = w.object.number("density", 1.0), wispiness = w.object.number("wispiness", 1.0);
    const double frequency = w.object.number("frequency", 5.0);
    const Vec3d p0 = w.object.point("p0", Vec3d(0.0)), p1 = w.object.point("p1", Vec3d(1.0));
    std::vector<float> values;
    const int n = cloud_voxels;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                values.push_back(float(pbrt_cloud_density(
                    glm::mix(p0, p1, (Vec3d(x, y, z) + 0.5) / double(n)), density, wispiness, frequency)));
    w.files.note("a procedural cloud is a grid of " + std::to_string(n) + "^3 voxels");
    add_density(w, w.element("heterogeneous"), values, {n, n, n});
}

void add_vdb(const Writer& w) {
    const PbrtParameter* file = w.object.find("filename");
    if (!file) throw InputError("the medium 'nanovdb' needs a filename", w.object.where);
    const std::string name = w.files.use(w.object.text("filename", ""), file->where);
    const Coefficients c = coefficients(w);
    if (!is_grey(c.sigma_t))
        w.files.fault(w.object.where, "the extinction of a VDB grid has one value here",
                      "the mean of its colour counts");
    const auto grid = [&](pugi::xml_node medium, const char* role, const std::string& grid_name) {
        pugi::xml_node volume = add_object(medium, "volume", "vdbvolume", role);
        add_value(volume, "string", "filename", name), add_value(volume, "string", "grid", grid_name);
        add_value(volume, "boolean", "clamp_negative", "true");
        add_transform(volume, "to_world", w.to_world);
    };
    pugi::xml_node medium = w.element("heterogeneous");
    add_float(medium, "scale", c.scale * double(luminance(c.sigma_t)));
    add_rgb(medium, "albedo", c.albedo);
    grid(medium, "sigma_t", w.object.text("gridname", "density"));
    const double light = w.object.number("Lescale", 1.0);
    const std::string temperature = w.object.text("temperaturename", "temperature");
    // Files without temperatures are usual; only one that sets how they shine is expected to have them.
    if (!w.object.find("temperaturescale") && !w.object.find("temperatureoffset") &&
        !w.object.find("Lescale"))
        return;
    grid(medium, "temperature", temperature);
    add_temperature_scales(w, medium, light);
}

}  // namespace

void add_pbrt_medium(pugi::xml_node scene, const std::string& id, const PbrtObject& medium,
                     const Transform& to_world, double exposure, PbrtFiles& files) {
    static const std::map<std::string, void (*)(const Writer&)> table = {{"homogeneous", add_homogeneous},
                                                                         {"uniformgrid", add_uniform_grid},
                                                                         {"rgbgrid", add_rgb_grid},
                                                                         {"cloud", add_cloud},
                                                                         {"nanovdb", add_vdb}};
    medium.ignore({"type"});
    const auto it = table.find(medium.type);
    if (it == table.end()) {
        std::vector<std::string> known;
        for (const auto& [name, add] : table) known.push_back(name);
        throw InputError(
            "unknown medium '" + printable(medium.type, 40) + "'" + suggestion(medium.type, known),
            medium.where);
    }
    pugi::xml_document written;
    it->second({written, id, medium, to_world, exposure, files});
    for (const pugi::xml_node node : written) scene.append_copy(node);
    for (const InputError& error : medium.unknown()) files.fault(error, "ignored");
}

void add_pbrt_vacuum(pugi::xml_node scene, const std::string& id) {
    add_float(add_object(scene, "medium", "homogeneous", "", id), "scale", 0.0);
}

}  // namespace mote::core
