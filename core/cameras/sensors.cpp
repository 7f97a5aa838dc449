// Field of view and clipping planes after the conventions of Mitsuba 3.
#include "core/cameras/sensors.h"

#include "core/cameras/film_objects.h"
#include "core/objects/number_text.h"

namespace mote::core {
namespace {

/// "50mm" or "50": a focal length on 35 mm film.
double parse_focal_length(const Properties& p) {
    std::string text = p.get_string("focal_length", "50mm");
    if (text.size() > 2 && text.ends_with("mm")) text.resize(text.size() - 2);
    const double millimetres = parse_number(text, p.where_of("focal_length"));
    if (!(millimetres > 0.0)) throw InputError("'focal_length' must be positive", p.where_of("focal_length"));
    return millimetres;
}

double from_diagonal(double tan_half_diagonal, double aspect) {
    return tan_half_diagonal / std::sqrt(1.0 + 1.0 / (aspect * aspect));
}

}  // namespace

ClipPlanes clip_planes(const Properties& p) {
    const double near = p.get_float("near_clip", 1e-2), far = p.get_float("far_clip", 1e4);
    if (!(near > 0.0)) throw InputError("'near_clip' must be positive", p.where_of("near_clip"));
    if (!(far > near)) throw InputError("'far_clip' must be larger than 'near_clip'", p.where_of("far_clip"));
    return {float(near), float(far)};
}

void add_common_parameters(std::vector<Parameter>& parameters) {
    parameters.push_back({"to_world", "transform", "identity",
                          "camera to world; looks along +Z, +Y is up, +X is to the picture's left"});
    parameters.push_back({"near_clip", "float", "0.01", "nothing nearer is seen, m along the view"});
    parameters.push_back({"far_clip", "float", "10000", "nothing farther is seen, m along the view"});
    parameters.push_back({"film", "film", "hdrfilm", "the picture"});
    parameters.push_back({"sampler", "sampler", "sobol", "where samples fall"});
    parameters.push_back(
        {"medium", "medium", "",
         "the medium around the camera; when absent, that of the shapes around it, or the outermost one"});
}

void add_view_parameters(std::vector<Parameter>& parameters) {
    parameters.push_back({"fov", "float", "from focal_length", "field of view along fov_axis, degrees"});
    parameters.push_back({"fov_axis", "string", "x", "x, y, diagonal, smaller or larger"});
    parameters.push_back(
        {"focal_length", "string", "50mm", "on 35 mm film, along the diagonal; instead of fov"});
}

double tan_half_fov_x(const Properties& p, double aspect) {
    if (p.has("fov") && p.has("focal_length"))
        throw InputError("give either 'fov' or 'focal_length'", p.where_of("focal_length"));
    const std::string axis = p.get_choice("fov_axis", "x", {"x", "y", "diagonal", "smaller", "larger"});
    // The diagonal of a 36 mm x 24 mm frame.
    if (!p.has("fov")) return from_diagonal(0.5 * std::hypot(36.0, 24.0) / parse_focal_length(p), aspect);
    const double degrees = p.get_float("fov", 0.0);
    if (!(degrees > 0.0 && degrees < 180.0))
        throw InputError("'fov' must lie between 0 and 180 degrees", p.where_of("fov"));
    const double t = std::tan(glm::radians(0.5 * degrees));
    if (!std::isfinite(t) || !(t < 1e6))
        throw InputError("'fov' must lie between 0 and 180 degrees", p.where_of("fov"));
    if (axis == "diagonal") return from_diagonal(t, aspect);
    const bool vertical =
        axis == "y" || (axis == "smaller" && aspect > 1.0) || (axis == "larger" && aspect <= 1.0);
    return vertical ? t * aspect : t;
}

Transform rigid_to_world(const Properties& p) {
    const Transform t = p.get_transform();
    const glm::dmat3 m(t.matrix);
    const glm::dmat3 product = glm::transpose(m) * m;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (std::fabs(product[c][r] - (c == r ? 1.0 : 0.0)) > 1e-3)
                throw InputError("the transform of a camera must not scale or shear", p.where_of("to_world"));
    return t;
}

PinholeView::PinholeView(const Properties& p) {
    const FilmObject film = film_of_sensor(p);
    width = float(film.width), height = float(film.height);
    half_width = float(tan_half_fov_x(p, double(width) / double(height)));
    half_height = half_width * height / width;
}

}  // namespace mote::core
