// Field of view and clipping planes after the conventions of Mitsuba 3.
#include "core/cameras/sensors.h"

#include "core/objects/number_text.h"

namespace mote::core {
namespace {

/// "50mm" or "50": a focal length on 35 mm film.
double parse_focal_length(std::string text, const Properties& p) {
    if (text.size() > 2 && text.ends_with("mm")) text.resize(text.size() - 2);
    const double millimetres = parse_number(text, p.where_of("focal_length"));
    if (!(millimetres > 0.0)) throw InputError("'focal_length' must be positive", p.where_of("focal_length"));
    return millimetres;
}

double from_diagonal(double tan_half_diagonal, double aspect) {
    return tan_half_diagonal / std::sqrt(1.0 + 1.0 / (aspect * aspect));
}

}  // namespace

const ParameterList<SensorSettings>& sensor_rows() {
    using S = SensorSettings;
    static const ParameterList<S> list{
        row("to_world", &S::to_world,
            "Camera to world; looks along +Z, +Y is up, +X is to the left of the image."),
        row("near_clip", &S::near_clip, above(0, "m"), "Nothing nearer along the view is seen."),
        row("far_clip", &S::far_clip, above(0, "m"), "Nothing farther along the view is seen."),
        nested("film", &S::film, Category::film, "hdrfilm", "The image."),
        nested("sampler", &S::sampler, Category::sampler, "sobol", "Where samples fall."),
        nested("medium", &S::medium, Category::medium, "automatic",
               "The medium around the camera; when absent, that of the shapes around it, or the outermost "
               "one.")};
    return list;
}

const ParameterList<ViewSettings>& view_rows() {
    using S = ViewSettings;
    static const ParameterList<S> list{
        row("fov", &S::fov, inside(0, 180, "degrees"), "Field of view along fov_axis.")
            .when_absent("from focal_length"),
        row("fov_axis", &S::axis,
            {{"x", FovAxis::x},
             {"y", FovAxis::y},
             {"diagonal", FovAxis::diagonal},
             {"smaller", FovAxis::smaller},
             {"larger", FovAxis::larger}},
            "Axis of the image that fov lies along."),
        row("focal_length", &S::focal_length, "On 35 mm film, along the diagonal; instead of fov.")};
    return list;
}

FilmSettings film_settings(const Properties& properties) {
    const SensorSettings sensor = sensor_rows().read(properties);
    const FilterSettings& filter = sensor.film.filter;
    FilmSettings settings;
    settings.width = sensor.film.width, settings.height = sensor.film.height;
    settings.half = sensor.film.half, settings.interval = sensor.film.interval;
    settings.filter = filter.name;
    settings.filter_radius = filter.radius, settings.filter_stddev = filter.stddev;
    settings.sampler = sensor.sampler.kind, settings.sample_count = sensor.sampler.sample_count;
    return settings;
}

ClipPlanes clip_planes(const SensorSettings& s, const Properties& p) {
    if (!(s.far_clip > s.near_clip))
        throw InputError("'far_clip' must be larger than 'near_clip'", p.where_of("far_clip"));
    return {float(s.near_clip), float(s.far_clip)};
}

double tan_half_fov_x(const ViewSettings& view, double aspect, const Properties& p) {
    if (view.fov && p.has("focal_length"))
        throw InputError("give either 'fov' or 'focal_length'", p.where_of("focal_length"));
    // The diagonal of a 36 mm x 24 mm frame.
    if (!view.fov)
        return from_diagonal(0.5 * std::hypot(36.0, 24.0) / parse_focal_length(view.focal_length, p), aspect);
    const double t = std::tan(glm::radians(0.5 * *view.fov));
    if (!std::isfinite(t) || !(t < 1e6))
        throw InputError("'fov' must lie between 0 and 180 degrees, both excluded", p.where_of("fov"));
    if (view.axis == FovAxis::diagonal) return from_diagonal(t, aspect);
    const bool vertical = view.axis == FovAxis::y || (view.axis == FovAxis::smaller && aspect > 1.0) ||
                          (view.axis == FovAxis::larger && aspect <= 1.0);
    return vertical ? t * aspect : t;
}

Transform rigid_to_world(const Transform& t, const Properties& p) {
    const glm::dmat3 m(t.matrix);
    const glm::dmat3 product = glm::transpose(m) * m;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (std::fabs(product[c][r] - (c == r ? 1.0 : 0.0)) > 1e-3)
                throw InputError("the transform of a camera must not scale or shear", p.where_of("to_world"));
    return t;
}

PinholeView::PinholeView(const FilmFormat& film, const ViewSettings& view, const Properties& p)
    : width(float(film.width)), height(float(film.height)) {
    half_width = float(tan_half_fov_x(view, double(width) / double(height), p));
    half_height = half_width * height / width;
}

}  // namespace mote::core
