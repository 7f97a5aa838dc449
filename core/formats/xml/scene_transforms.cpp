// <transform>: translate, rotate, scale, lookat and matrix, multiplied from the left in order.

#include "core/formats/xml/scene_values.h"

namespace mote::core {
namespace {

/// x, y and z as attributes, or all of them in `value`; what is left out is `missing`.
Vec3d components(const Element& e, double missing) {
    if (const std::string* value = e.find("value")) {
        if (e.find("x") || e.find("y") || e.find("z"))
            throw InputError("give either 'value' or x, y and z", e.where);
        const std::vector<double> v = parse_numbers(*value, e.where);
        if (v.size() == 1 && e.tag == "scale") return Vec3d(v[0]);
        return parse_vector(*value, e.where);
    }
    const auto part = [&](const char* name) {
        return e.find(name) ? parse_number(e.require(name), e.where) : missing;
    };
    return {part("x"), part("y"), part("z")};
}

glm::dmat4 rotation(const Element& e) {
    e.check_attributes({"x", "y", "z", "value", "angle"});
    const Vec3d axis = components(e, 0.0);
    if (!(glm::length(axis) > 0.0)) throw InputError("a rotation needs an axis", e.where);
    const double degrees = parse_number(e.require("angle"), e.where);
    return glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis);
}

/// The camera's frame: +Z towards the target, +X to the left of the picture.
glm::dmat4 look_at(const Element& e) {
    e.check_attributes({"origin", "target", "up"});
    const Vec3d origin = parse_vector(e.require("origin"), e.where);
    const Vec3d target = parse_vector(e.require("target"), e.where);
    const Vec3d towards = target - origin;
    if (!(glm::length(towards) > 0.0)) throw InputError("lookat: origin and target are the same", e.where);
    const Vec3d direction = glm::normalize(towards);
    Vec3d up = e.find("up") ? parse_vector(e.require("up"), e.where) : Vec3d(0, 1, 0);
    if (!(glm::length(up) > 0.0)) throw InputError("lookat: up is zero", e.where);
    up = glm::normalize(up);
    const Vec3d left = glm::cross(up, direction);
    if (!(glm::length(left) > 1e-6)) throw InputError("lookat: up is parallel to the view", e.where);
    const Vec3d x = glm::normalize(left);
    const Vec3d y = glm::cross(direction, x);
    return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(direction, 0), glm::dvec4(origin, 1)};
}

/// Sixteen numbers row by row, or nine for the linear part alone.
glm::dmat4 matrix(const Element& e) {
    e.check_attributes({"value"});
    const std::vector<double> v = parse_numbers(e.require("value"), e.where);
    if (v.size() != 16 && v.size() != 9)
        throw InputError("a matrix has 16 (or 9) numbers, not " + std::to_string(v.size()), e.where);
    const int n = v.size() == 16 ? 4 : 3;
    glm::dmat4 m(1.0);
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) m[column][row] = v[std::size_t(row * n + column)];
    if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0)
        throw InputError("the last row of a matrix must be 0 0 0 1", e.where);
    return m;
}

glm::dmat4 operation(const Element& e) {
    if (!e.children.empty())
        throw InputError("<" + printable(e.tag) + "> holds no other elements", e.children.front().where);
    if (e.tag == "rotate") return rotation(e);
    if (e.tag == "lookat") return look_at(e);
    if (e.tag == "matrix") return matrix(e);
    if (e.tag == "translate") {
        e.check_attributes({"x", "y", "z", "value"});
        return glm::translate(glm::dmat4(1.0), components(e, 0.0));
    }
    if (e.tag == "scale") {
        e.check_attributes({"x", "y", "z", "value"});
        return glm::scale(glm::dmat4(1.0), components(e, 1.0));
    }
    static const std::vector<std::string> known = {"translate", "rotate", "scale", "lookat", "matrix"};
    throw InputError("unknown transformation <" + printable(e.tag) + ">" + suggestion(e.tag, known), e.where);
}

}  // namespace

Transform parse_transform(const Element& element) {
    element.check_attributes({"name"});
    Transform result;
    for (const Element& e : element.children) {
        result = Transform(operation(e)) * result;
        if (!result.valid()) throw InputError("the transform is singular or not finite", e.where);
    }
    return result;
}

}  // namespace mote::core
