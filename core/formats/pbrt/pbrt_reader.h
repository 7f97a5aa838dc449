// The directives of a pbrt scene in order, and the graphics state that they change.
#pragma once

#include <pugixml.hpp>

#include "core/formats/pbrt/pbrt_shapes.h"
#include "core/formats/pbrt/pbrt_view.h"

namespace mote::core {

class PbrtReader {
  public:
    /// Elements are added to `scene`.
    PbrtReader(pugi::xml_node scene, PbrtFiles& files)
        : scene_(scene),
          files_(files),
          textures_(files),
          materials_(textures_, files),
          shapes_(scene, textures_, materials_, files) {}

    /// Reads the file, found beside the scene, and all that it includes. Throws InputError where a file
    /// breaks the grammar; what is wrong with an object is reported, and the object left out.
    void read(const std::string& file);

  private:
    struct State {
        Transform to_world;
        bool reverse_orientation = false, moves = false;
        std::string material, inside, outside, color_space = "srgb";
        std::shared_ptr<const PbrtObject> light;
        std::map<std::string, std::vector<PbrtParameter>> attributes;  ///< by target: "shape", "light", ...
    };
    using Directive = void (PbrtReader::*)(PbrtText& text, const SourceLocation& where);
    static const std::map<std::string, Directive>& directives();

    void read_file(const std::string& name, const SourceLocation& where);
    void read_directive(const PbrtToken& token, PbrtText& text);
    void skip_unknown(const std::string& word, PbrtText& text, const SourceLocation& where);
    PbrtObject object(PbrtText& text, const SourceLocation& where, const char* attributes = "");
    std::string string(PbrtText& text, const char* what);
    std::vector<double> numbers(PbrtText& text, std::size_t count);
    void concatenate(const glm::dmat4& m);
    glm::dmat4 matrix(PbrtText& text);
    std::string medium_id(const std::string& name, const SourceLocation& where);
    void finish();
    template <typename F>
    void attempt(F&& f);

    void active_transform(PbrtText&, const SourceLocation&);
    void area_light(PbrtText&, const SourceLocation&);
    void attribute(PbrtText&, const SourceLocation&);
    void attribute_begin(PbrtText&, const SourceLocation&);
    void attribute_end(PbrtText&, const SourceLocation&);
    void camera(PbrtText&, const SourceLocation&);
    void color_space(PbrtText&, const SourceLocation&);
    void concat_transform(PbrtText&, const SourceLocation&);
    void coordinate_system(PbrtText&, const SourceLocation&);
    void coord_sys_transform(PbrtText&, const SourceLocation&);
    void film(PbrtText&, const SourceLocation&);
    void identity(PbrtText&, const SourceLocation&);
    void ignored(PbrtText&, const SourceLocation&);
    void import(PbrtText&, const SourceLocation&);
    void include(PbrtText&, const SourceLocation&);
    void integrator(PbrtText&, const SourceLocation&);
    void light_source(PbrtText&, const SourceLocation&);
    void look_at(PbrtText&, const SourceLocation&);
    void make_named_material(PbrtText&, const SourceLocation&);
    void make_named_medium(PbrtText&, const SourceLocation&);
    void material(PbrtText&, const SourceLocation&);
    void medium_interface(PbrtText&, const SourceLocation&);
    void named_material(PbrtText&, const SourceLocation&);
    void object_begin(PbrtText&, const SourceLocation&);
    void object_end(PbrtText&, const SourceLocation&);
    void object_instance(PbrtText&, const SourceLocation&);
    void option(PbrtText&, const SourceLocation&);
    void pixel_filter(PbrtText&, const SourceLocation&);
    void reverse_orientation(PbrtText&, const SourceLocation&);
    void rotate(PbrtText&, const SourceLocation&);
    void sampler(PbrtText&, const SourceLocation&);
    void scale(PbrtText&, const SourceLocation&);
    void shape(PbrtText&, const SourceLocation&);
    void texture(PbrtText&, const SourceLocation&);
    void transform(PbrtText&, const SourceLocation&);
    void transform_times(PbrtText&, const SourceLocation&);
    void translate(PbrtText&, const SourceLocation&);
    void world_begin(PbrtText&, const SourceLocation&);

    pugi::xml_node scene_;
    PbrtFiles& files_;
    PbrtTextures textures_;
    PbrtMaterials materials_;
    PbrtShapes shapes_;
    PbrtView view_;
    State state_;
    std::vector<State> saved_;
    std::map<std::string, Transform> coordinate_systems_;
    std::map<std::string, SourceLocation> media_wanted_;  ///< by id, and where each was requested
    std::map<std::string, std::string> media_;            ///< ids by name
    std::set<std::string> media_made_;
    bool in_world_ = false, start_time_ = true;
    int depth_ = 0;
    double exposure_ = 1.0;
};

}  // namespace mote::core
