// Files, the table of directives, and the end of a scene.
#include "core/formats/pbrt/pbrt_reader.h"

#include "core/formats/pbrt/pbrt_media.h"

namespace mote::core {
namespace {

constexpr int max_depth = 32;  // of files that include each other

}  // namespace

const std::map<std::string, PbrtReader::Directive>& PbrtReader::directives() {
    using R = PbrtReader;
    static const std::map<std::string, Directive> table = {{"Accelerator", &R::ignored},
                                                           {"ActiveTransform", &R::active_transform},
                                                           {"AreaLightSource", &R::area_light},
                                                           {"Attribute", &R::attribute},
                                                           {"AttributeBegin", &R::attribute_begin},
                                                           {"AttributeEnd", &R::attribute_end},
                                                           {"Camera", &R::camera},
                                                           {"ColorSpace", &R::color_space},
                                                           {"ConcatTransform", &R::concat_transform},
                                                           {"CoordSysTransform", &R::coord_sys_transform},
                                                           {"CoordinateSystem", &R::coordinate_system},
                                                           {"Film", &R::film},
                                                           {"Identity", &R::identity},
                                                           {"Import", &R::import},
                                                           {"Include", &R::include},
                                                           {"Integrator", &R::integrator},
                                                           {"LightSource", &R::light_source},
                                                           {"LookAt", &R::look_at},
                                                           {"MakeNamedMaterial", &R::make_named_material},
                                                           {"MakeNamedMedium", &R::make_named_medium},
                                                           {"Material", &R::material},
                                                           {"MediumInterface", &R::medium_interface},
                                                           {"NamedMaterial", &R::named_material},
                                                           {"ObjectBegin", &R::object_begin},
                                                           {"ObjectEnd", &R::object_end},
                                                           {"ObjectInstance", &R::object_instance},
                                                           {"Option", &R::option},
                                                           {"PixelFilter", &R::pixel_filter},
                                                           {"ReverseOrientation", &R::reverse_orientation},
                                                           {"Rotate", &R::rotate},
                                                           {"Sampler", &R::sampler},
                                                           {"Scale", &R::scale},
                                                           {"Shape", &R::shape},
                                                           {"Texture", &R::texture},
                                                           {"Transform", &R::transform},
                                                           {"TransformBegin", &R::attribute_begin},
                                                           {"TransformEnd", &R::attribute_end},
                                                           {"TransformTimes", &R::transform_times},
                                                           {"Translate", &R::translate},
                                                           {"WorldBegin", &R::world_begin}};
    return table;
}

/// Words and parameters of a directive that is not known, up to the next one that is.
void PbrtReader::skip_unknown(const std::string& word, PbrtText& text, const SourceLocation& where) {
    std::vector<std::string> known;
    for (const auto& [name, directive] : directives()) known.push_back(name);
    files_.fault(where, "unknown directive '" + printable(word, 40) + "'" + suggestion(word, known),
                 "left out");
    while (auto token = text.next())
        if (!token->quoted && directives().count(token->text)) return text.put_back(*std::move(token));
}

void PbrtReader::read_directive(const PbrtToken& token, PbrtText& text) {
    const SourceLocation where = text.where(token.line);
    if (token.quoted)
        throw InputError("a directive is expected, not the string '" + printable(token.text, 40) + "'",
                         where);
    const auto it = directives().find(token.text);
    if (it == directives().end()) return skip_unknown(token.text, text, where);
    (this->*it->second)(text, where);
}

void PbrtReader::read_file(const std::string& name, const SourceLocation& where) {
    if (depth_ >= max_depth)
        throw InputError("files include each other more than " + std::to_string(max_depth) + " deep", where);
    const std::string path = files_.find(name, where);
    PbrtText text(read_pbrt_file(path), path);
    ++depth_;
    while (const auto token = text.next()) read_directive(*token, text);
    --depth_;
}

void PbrtReader::read(const std::string& file) {
    PbrtObject diffuse;
    diffuse.type = "diffuse";
    state_.material = materials_.add(diffuse);
    read_file(file, {});
    finish();
}

void PbrtReader::finish() {
    if (!in_world_) throw InputError("the scene has no WorldBegin", {files_.scene(), 0});
    if (!saved_.empty()) files_.note("an AttributeBegin or ObjectBegin has no end");
    shapes_.finish();
    materials_.write(scene_);
    for (const auto& [id, where] : media_wanted_) {
        if (media_made_.count(id)) continue;
        std::vector<std::string> known;
        std::string requested;
        for (const auto& [name, other] : media_) {
            if (media_made_.count(other)) known.push_back(name);
            if (other == id) requested = name;
        }
        files_.fault(where,
                     "there is no medium '" + printable(requested, 60) + "'" + suggestion(requested, known),
                     "a vacuum stands in its place");
        add_pbrt_vacuum(scene_, id);
    }
}

}  // namespace mote::core
