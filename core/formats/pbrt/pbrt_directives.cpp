// Each directive of pbrt-v4 (its parser.cpp and scene.cpp).
#include <cmath>

#include "core/formats/pbrt/pbrt_lights.h"
#include "core/formats/pbrt/pbrt_media.h"
#include "core/formats/pbrt/pbrt_reader.h"

namespace mote::core {
namespace {

constexpr std::size_t max_states = 10'000;  // of AttributeBegin inside of AttributeBegin

/// Without the rounding errors that an inverse leaves in the row of perspective.
Transform affine(const glm::dmat4& m) {
    glm::dmat4 a = m / m[3][3];
    a[0][3] = a[1][3] = a[2][3] = 0.0;
    return Transform(a);
}

}  // namespace

/// An object that cannot be read is left out.
template <typename F>
void PbrtReader::attempt(F&& f) {
    try {
        f();
    } catch (const InputError& error) {
        files_.fault(error, "left out");
    }
}

std::string PbrtReader::string(PbrtText& text, const char* what) {
    const PbrtToken token = text.require(what);
    if (!token.quoted)
        throw InputError(std::string(what) + " is expected, not '" + printable(token.text, 40) + "'",
                         text.where(token.line));
    return token.text;
}

std::vector<double> PbrtReader::numbers(PbrtText& text, std::size_t count) {
    std::vector<double> list;
    while (list.size() < count) {
        const PbrtToken token = text.require("a number");
        list.push_back(pbrt_number(token.text, text.where(token.line)));
    }
    return list;
}

PbrtObject PbrtReader::object(PbrtText& text, const SourceLocation& where, const char* attributes) {
    PbrtObject o;
    o.type = string(text, "a type in quotes"), o.where = where;
    o.parameters = read_pbrt_parameters(text, state_.color_space);
    for (const PbrtParameter& p : state_.attributes[attributes]) o.parameters.push_back(p);
    return o;
}

void PbrtReader::concatenate(const glm::dmat4& m) {
    if (start_time_)
        state_.to_world = state_.to_world * Transform(m);
    else
        state_.moves = true;
}

glm::dmat4 PbrtReader::matrix(PbrtText& text) {
    const PbrtToken open = text.require("'['");
    if (open.text != "[") throw InputError("'[' and 16 numbers are expected", text.where(open.line));
    const std::vector<double> n = numbers(text, 16);
    if (text.require("']'").text != "]") throw InputError("']' is expected after 16 numbers", text.where());
    glm::dmat4 m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = n[std::size_t(i)];  // column by column
    if (m[3][3] == 0.0) throw InputError("a matrix is no affine transform", text.where());
    return affine(m).matrix;
}

void PbrtReader::active_transform(PbrtText& text, const SourceLocation& where) {
    const std::string word = text.require("All, StartTime or EndTime").text;
    if (word != "All" && word != "StartTime" && word != "EndTime")
        throw InputError("ActiveTransform takes All, StartTime or EndTime, not '" + printable(word, 40) + "'",
                         where);
    start_time_ = word != "EndTime";
}

void PbrtReader::area_light(PbrtText& text, const SourceLocation& where) {
    state_.light = std::make_shared<const PbrtObject>(object(text, where, "light"));
}

void PbrtReader::attribute(PbrtText& text, const SourceLocation& where) {
    const std::string target = string(text, "a target in quotes");
    static const std::vector<std::string> targets = {"shape", "light", "material", "medium", "texture"};
    std::vector<PbrtParameter> list = read_pbrt_parameters(text, state_.color_space);
    if (std::find(targets.begin(), targets.end(), target) == targets.end())
        return files_.fault(
            where, "Attribute has no target '" + printable(target, 40) + "'" + suggestion(target, targets),
            "ignored");
    for (PbrtParameter& p : list) p.of_attribute = true, state_.attributes[target].push_back(std::move(p));
}

void PbrtReader::attribute_begin(PbrtText&, const SourceLocation& where) {
    if (saved_.size() >= max_states) throw InputError("attributes are nested too deeply", where);
    saved_.push_back(state_);
}

void PbrtReader::attribute_end(PbrtText&, const SourceLocation& where) {
    if (saved_.empty()) return files_.fault(where, "AttributeEnd without AttributeBegin", "ignored");
    state_ = std::move(saved_.back());
    saved_.pop_back();
}

void PbrtReader::camera(PbrtText& text, const SourceLocation& where) {
    view_.camera = object(text, where);
    view_.camera_to_world = affine(state_.to_world.inverse().matrix);
    view_.medium = state_.outside;
    coordinate_systems_["camera"] = view_.camera_to_world;
}

void PbrtReader::color_space(PbrtText& text, const SourceLocation& where) {
    const std::string name = string(text, "a colour space in quotes");
    const auto& known = pbrt_color_spaces();
    if (std::find(known.begin(), known.end(), name) == known.end())
        return files_.fault(
            where, "unknown colour space '" + printable(name, 40) + "'" + suggestion(name, known), "ignored");
    state_.color_space = name;
}

void PbrtReader::concat_transform(PbrtText& text, const SourceLocation&) { concatenate(matrix(text)); }

void PbrtReader::coordinate_system(PbrtText& text, const SourceLocation&) {
    coordinate_systems_[string(text, "a name in quotes")] = state_.to_world;
}

void PbrtReader::coord_sys_transform(PbrtText& text, const SourceLocation& where) {
    const std::string name = string(text, "a name in quotes");
    if (const auto it = coordinate_systems_.find(name); it != coordinate_systems_.end()) {
        state_.to_world = it->second;
        return;
    }
    std::vector<std::string> known;
    for (const auto& [other, t] : coordinate_systems_) known.push_back(other);
    files_.fault(where,
                 "there is no coordinate system '" + printable(name, 40) + "'" + suggestion(name, known),
                 "ignored");
}

void PbrtReader::film(PbrtText& text, const SourceLocation& where) { view_.film = object(text, where); }

void PbrtReader::identity(PbrtText&, const SourceLocation&) {
    if (start_time_) state_.to_world = Transform();
}

void PbrtReader::ignored(PbrtText& text, const SourceLocation& where) { object(text, where); }

void PbrtReader::import(PbrtText& text, const SourceLocation& where) {
    const State before = state_;
    const std::size_t depth = saved_.size();
    read_file(string(text, "a file name in quotes"), where);
    saved_.resize(std::min(saved_.size(), depth));
    state_ = before;
}

void PbrtReader::include(PbrtText& text, const SourceLocation& where) {
    const std::string name = string(text, "a file name in quotes");
    try {
        files_.find(name, where);
    } catch (const InputError& error) {
        return files_.fault(error, "left out");
    }
    read_file(name, where);
}

void PbrtReader::integrator(PbrtText& text, const SourceLocation& where) {
    view_.integrator = object(text, where);
}

void PbrtReader::light_source(PbrtText& text, const SourceLocation& where) {
    const PbrtObject light = object(text, where, "light");
    attempt([&] {
        const std::string medium = light.type == "infinite" || light.type == "distant" ? "" : state_.outside;
        add_pbrt_light(scene_, light, state_.to_world, exposure_, medium, files_);
    });
}

void PbrtReader::look_at(PbrtText& text, const SourceLocation& where) {
    const std::vector<double> n = numbers(text, 9);
    const Vec3d eye(n[0], n[1], n[2]), forward = Vec3d(n[3], n[4], n[5]) - eye, up(n[6], n[7], n[8]);
    const Vec3d right = glm::cross(up, forward);
    if (!(glm::length(right) > 0.0))
        return files_.fault(where, "LookAt has no direction, or 'up' lies along it", "ignored");
    const Vec3d x = glm::normalize(right), z = glm::normalize(forward), y = glm::cross(z, x);
    const glm::dmat4 camera_to_world(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0),
                                     glm::dvec4(eye, 1));
    concatenate(affine(glm::inverse(camera_to_world)).matrix);
}

void PbrtReader::make_named_material(PbrtText& text, const SourceLocation& where) {
    PbrtObject o = object(text, where, "material");
    const std::string name = o.type;
    attempt([&] { materials_.add_named(name, std::move(o)); });
}

void PbrtReader::make_named_medium(PbrtText& text, const SourceLocation& where) {
    PbrtObject o = object(text, where, "medium");
    const std::string name = o.type, id = medium_id(name, where);
    o.type = o.text("type", "");
    if (!media_made_.insert(id).second)
        return files_.fault(where, "the medium '" + printable(name, 60) + "' is defined twice",
                            "the first one counts");
    try {
        add_pbrt_medium(scene_, id, o, state_.to_world, exposure_, files_);
    } catch (const InputError& error) {
        files_.fault(error, "a vacuum stands in its place");
        add_pbrt_vacuum(scene_, id);
    }
}

void PbrtReader::material(PbrtText& text, const SourceLocation& where) {
    state_.material = materials_.add(object(text, where, "material"));
}

std::string PbrtReader::medium_id(const std::string& name, const SourceLocation& where) {
    if (name.empty()) return "";
    std::string& id = media_[name];
    if (id.empty()) id = "medium_" + std::to_string(media_.size() - 1);
    media_wanted_.emplace(id, where);
    return id;
}

void PbrtReader::medium_interface(PbrtText& text, const SourceLocation& where) {
    const std::string inside = string(text, "a medium in quotes");
    auto second = text.next();
    std::string outside = inside;
    if (second && second->quoted)
        outside = second->text;
    else if (second)
        text.put_back(*std::move(second));
    state_.inside = medium_id(inside, where), state_.outside = medium_id(outside, where);
}

void PbrtReader::named_material(PbrtText& text, const SourceLocation& where) {
    state_.material = materials_.named(string(text, "a material in quotes"), where);
}

void PbrtReader::object_begin(PbrtText& text, const SourceLocation& where) {
    attribute_begin(text, where);
    shapes_.begin_object(string(text, "a name in quotes"), where);
}

void PbrtReader::object_end(PbrtText& text, const SourceLocation& where) {
    if (!shapes_.in_object()) return files_.fault(where, "ObjectEnd without ObjectBegin", "ignored");
    shapes_.end_object();
    attribute_end(text, where);
}

void PbrtReader::object_instance(PbrtText& text, const SourceLocation& where) {
    const std::string name = string(text, "a name in quotes");
    attempt([&] { shapes_.add_instance(name, state_.to_world, where); });
}

void PbrtReader::option(PbrtText& text, const SourceLocation&) {
    const std::string name = string(text, "a name in quotes");
    text.require("a value");
    files_.note("the option '" + printable(name, 60) + "' has no effect here");
}

void PbrtReader::pixel_filter(PbrtText& text, const SourceLocation& where) {
    view_.filter = object(text, where);
}

void PbrtReader::reverse_orientation(PbrtText&, const SourceLocation&) {
    state_.reverse_orientation = !state_.reverse_orientation;
}

void PbrtReader::rotate(PbrtText& text, const SourceLocation& where) {
    const std::vector<double> n = numbers(text, 4);
    const Vec3d axis(n[1], n[2], n[3]);
    if (!(glm::length(axis) > 0.0)) return files_.fault(where, "Rotate has no axis", "ignored");
    concatenate(glm::rotate(glm::dmat4(1.0), glm::radians(n[0]), axis));
}

void PbrtReader::sampler(PbrtText& text, const SourceLocation& where) { view_.sampler = object(text, where); }

void PbrtReader::scale(PbrtText& text, const SourceLocation&) {
    const std::vector<double> n = numbers(text, 3);
    concatenate(glm::scale(glm::dmat4(1.0), {n[0], n[1], n[2]}));
}

void PbrtReader::shape(PbrtText& text, const SourceLocation& where) {
    const PbrtObject o = object(text, where, "shape");
    if (state_.moves)
        files_.fault(where, "shapes that move have no counterpart here",
                     "they stand as at the shutter's opening");
    // A scene has one outermost medium here, that of the camera; others are found by the shapes around a
    // point.
    const bool boundary = state_.inside != state_.outside,
               outermost = boundary && state_.outside == view_.medium;
    attempt([&] {
        shapes_.add(o, {state_.to_world, state_.reverse_orientation, state_.material,
                        boundary ? state_.inside : "", outermost ? state_.outside : "", state_.light.get()});
    });
}

void PbrtReader::texture(PbrtText& text, const SourceLocation& where) {
    const std::string name = string(text, "a name in quotes"),
                      value_type = string(text, "\"float\" or \"spectrum\"");
    const PbrtObject o = object(text, where, "texture");
    attempt([&] { textures_.define(name, value_type, o); });
}

void PbrtReader::transform(PbrtText& text, const SourceLocation&) {
    const glm::dmat4 m = matrix(text);
    if (start_time_)
        state_.to_world = Transform(m);
    else
        state_.moves = true;
}

void PbrtReader::transform_times(PbrtText& text, const SourceLocation&) { numbers(text, 2); }

void PbrtReader::translate(PbrtText& text, const SourceLocation&) {
    const std::vector<double> n = numbers(text, 3);
    concatenate(glm::translate(glm::dmat4(1.0), {n[0], n[1], n[2]}));
}

void PbrtReader::world_begin(PbrtText&, const SourceLocation& where) {
    if (in_world_) throw InputError("WorldBegin stands twice", where);
    in_world_ = true, start_time_ = true;
    state_.to_world = Transform();
    coordinate_systems_["world"] = Transform();
    exposure_ = pbrt_imaging_ratio(view_);
    shapes_.set_exposure(exposure_);
    add_pbrt_view(scene_, view_, files_);
}

}  // namespace mote::core
