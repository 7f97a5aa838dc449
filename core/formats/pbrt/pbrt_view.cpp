// pbrt looks along +z with +x to the right; our +x points to the left of the image, so x is mirrored in the
// camera and the world stays as it is.
#include "core/formats/pbrt/pbrt_view.h"

#include <algorithm>
#include <cmath>

#include "core/formats/conversion/scene_xml.h"

namespace mote::core {
namespace {

void report_unknown(const PbrtObject& object, PbrtFiles& files) {
    for (const InputError& error : object.unknown()) files.fault(error, "ignored");
}

void add_integrator(pugi::xml_node scene, const PbrtObject& object, PbrtFiles& files) {
    static const std::vector<std::string> same_picture = {"bdpt",      "mlt",        "sppm",
                                                          "lightpath", "simplepath", "simplevolpath"};
    object.ignore({"lightsampler", "regularize", "samplelights", "samplebsdf", "mutationsperpixel",
                   "bootstrapsamples", "chains", "sigma", "largestepprobability", "photonsperiteration",
                   "radius", "seed", "visualizestrategies", "visualizeweights", "cossample", "maxdistance",
                   "iterations", "imagewritefrequency"});
    const std::string& type = object.type;
    const bool path = type == "path";
    if (std::find(same_picture.begin(), same_picture.end(), type) != same_picture.end())
        files.note("the integrator '" + type + "' is 'volpath' here: the same picture by other samples");
    else if (!path && type != "volpath")
        files.fault(object.where, "the integrator '" + printable(type, 40) + "' has no counterpart here",
                    "'volpath' stands in its place");
    pugi::xml_node integrator = add_object(scene, "integrator", path ? "path" : "volpath");
    // pbrt counts scattering events, ours the segments up to the light.
    add_value(integrator, "integer", "max_depth",
              std::to_string(std::clamp(object.integer("maxdepth", 5), 0, 1 << 20) + 1));
    report_unknown(object, files);
}

void add_filter(pugi::xml_node film, const PbrtObject& object, PbrtFiles& files) {
    const std::string& type = object.type;
    const double x = object.number("xradius", type == "box" ? 0.5 : type == "triangle" ? 2.0 : 1.5);
    const double y = object.number("yradius", x), sigma = object.number("sigma", 0.5);
    object.ignore({"B", "C", "tau"});
    if (x != y) files.note("a pixel filter has one radius here, that along x");
    if (type == "box") {
        if (x > 0.5) files.note("a box filter is one pixel wide here");
        add_object(film, "rfilter", "box");
    } else if (type == "triangle") {
        add_float(add_object(film, "rfilter", "tent"), "radius", x);
    } else {
        if (type != "gaussian")
            files.note("the pixel filter '" + printable(type, 40) + "' is 'gaussian' here");
        add_float(add_object(film, "rfilter", "gaussian"), "stddev", type == "gaussian" ? sigma : 0.5);
    }
    report_unknown(object, files);
}

/// Width over height.
double add_film(pugi::xml_node sensor, const PbrtView& view, PbrtFiles& files) {
    const PbrtObject& film = view.film;
    film.ignore({"filename", "savefp16", "diagonal", "maxcomponentvalue", "coordinatesystem", "nbuckets",
                 "lambdamin", "lambdamax", "sensor", "iso"});
    if (film.find("cropwindow") || film.find("pixelbounds"))
        files.note("the whole picture is rendered: films are not cropped here");
    if (film.find("whitebalance")) files.note("white balance is not computed here: D65 is white");
    if (film.text("sensor", "cie1931") != "cie1931") files.note("the sensor is the CIE 1931 observer here");
    const int width = film.integer("xresolution", 1280), height = film.integer("yresolution", 720);
    if (width < 1 || height < 1) throw InputError("the film has no pixels", film.where);
    pugi::xml_node element = add_object(sensor, "film", "hdrfilm");
    add_value(element, "integer", "width", std::to_string(width)),
        add_value(element, "integer", "height", std::to_string(height));
    add_filter(element, view.filter, files);
    report_unknown(film, files);
    return double(width) / height;
}

void add_sampler(pugi::xml_node sensor, const PbrtObject& object, PbrtFiles& files) {
    object.ignore({"randomization", "seed", "jitter", "dimensions"});
    const int strata = object.integer("xsamples", 4) * object.integer("ysamples", 4);
    const int samples = object.integer("pixelsamples", object.type == "stratified" ? strata : 16);
    pugi::xml_node sampler =
        add_object(sensor, "sampler", object.type == "independent" ? "independent" : "sobol");
    add_value(sampler, "integer", "sample_count", std::to_string(std::clamp(samples, 1, 1 << 20)));
    report_unknown(object, files);
}

/// Half the height of the shorter axis and centre of the screen window, in units of pbrt's screen.
struct Window {
    double half_short = 1.0, half_width = 1.0;
    Vec3d centre{0.0};
};
Window window_of(const PbrtObject& camera, double aspect, PbrtFiles& files) {
    if (std::fabs(camera.number("frameaspectratio", aspect) - aspect) > 1e-3)
        files.fault(camera.where, "pixels that are not square have no counterpart here", "they are square");
    const std::vector<double> w = camera.numbers("screenwindow");
    const bool given = w.size() == 4 && w[1] > w[0] && w[3] > w[2];
    if (!w.empty() && !given) files.fault(camera.where, "a screenwindow is x0 x1 y0 y1", "ignored");
    if (!given) return {1.0, std::fmax(aspect, 1.0), Vec3d(0.0)};
    const double half_width = 0.5 * (w[1] - w[0]), half_height = 0.5 * (w[3] - w[2]);
    if (std::fabs(half_width / half_height / aspect - 1.0) > 1e-3)
        files.fault(camera.where, "pixels that are not square have no counterpart here", "they are square");
    return {
        aspect > 1.0 ? half_height : half_width, half_width, {0.5 * (w[0] + w[1]), 0.5 * (w[2] + w[3]), 0.0}};
}

void add_perspective(pugi::xml_node sensor, const PbrtObject& camera, const Window& window, double fov,
                     PbrtFiles& files) {
    if (!(fov > 0.0 && fov < 180.0)) throw InputError("'fov' must lie between 0 and 180", camera.where);
    if (glm::length(window.centre) > 1e-6)
        files.fault(camera.where, "a screenwindow off the axis has no counterpart here", "it is centred");
    const double half = std::atan(window.half_short * std::tan(0.5 * glm::radians(fov)));
    add_float(sensor, "fov", window.half_short == 1.0 ? fov : glm::degrees(2.0 * half));
    add_value(sensor, "string", "fov_axis", "smaller");
    const double radius = camera.number("lensradius", 0.0), distance = camera.number("focaldistance", 1e6);
    if (!(radius > 0.0)) return;
    sensor.attribute("type") = "thinlens";
    add_float(sensor, "aperture_radius", radius), add_float(sensor, "focus_distance", distance);
}

void add_camera(pugi::xml_node sensor, const PbrtView& view, double aspect, PbrtFiles& files) {
    const PbrtObject& camera = view.camera;
    camera.ignore({"shutteropen", "shutterclose", "mapping", "lensfile", "aperturediameter", "focusdistance",
                   "aperture"});
    const Window window = window_of(camera, aspect, files);
    glm::dmat4 local = glm::scale(glm::dmat4(1.0), {-1.0, 1.0, 1.0});
    if (camera.type == "orthographic") {
        sensor.attribute("type") = "orthographic";
        const double w = window.half_width;
        local = glm::translate(glm::dmat4(1.0), window.centre) * glm::scale(local, {w, w, 1.0});
        if (camera.number("lensradius", 0.0) > 0.0) files.note("an orthographic camera has no lens here");
        camera.ignore({"focaldistance"});
    } else if (camera.type == "perspective") {
        add_perspective(sensor, camera, window, camera.number("fov", 90.0), files);
    } else {
        if (camera.type != "spherical" && camera.type != "realistic")
            throw InputError("unknown camera '" + printable(camera.type, 40) +
                                 "' (known: perspective, orthographic, spherical, realistic)",
                             camera.where);
        const double fov = camera.type == "spherical" ? 90.0 : 40.0;
        camera.ignore({"lensradius", "focaldistance"});
        files.fault(camera.where, "the camera '" + camera.type + "' has no counterpart here",
                    "a perspective one of " + std::to_string(int(fov)) + " degrees stands in its place");
        add_perspective(sensor, camera, Window{}, fov, files);
    }
    add_float(sensor, "near_clip", 1e-5), add_float(sensor, "far_clip", 1e9);
    add_transform(sensor, "to_world", view.camera_to_world * Transform(local));
    report_unknown(camera, files);
}

}  // namespace

PbrtView::PbrtView() {
    camera.type = "perspective", film.type = "rgb", filter.type = "gaussian", sampler.type = "zsobol",
    integrator.type = "volpath";
}

double pbrt_imaging_ratio(const PbrtView& view) {
    const double seconds = view.camera.number("shutterclose", 1.0) - view.camera.number("shutteropen", 0.0);
    const double ratio = seconds * view.film.number("iso", 100.0) / 100.0;
    if (!(ratio > 0.0))
        throw InputError("the shutter does not open, or the film has no sensitivity", view.film.where);
    return ratio;
}

void add_pbrt_view(pugi::xml_node scene, const PbrtView& view, PbrtFiles& files) {
    add_integrator(scene, view.integrator, files);
    if (!view.camera_to_world.valid())
        throw InputError("the transform of the camera is singular", view.camera.where);
    pugi::xml_node sensor = add_object(scene, "sensor", "perspective");
    const double aspect = add_film(sensor, view, files);
    add_sampler(sensor, view.sampler, files);
    add_camera(sensor, view, aspect, files);
    if (!view.medium.empty()) add_ref(sensor, view.medium, "medium");
    if (const double ratio = pbrt_imaging_ratio(view); ratio != 1.0)
        files.note("exposure time and sensitivity of the film are a factor on all lights here");
}

}  // namespace mote::core
