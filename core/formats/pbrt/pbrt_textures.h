// Textures of pbrt scenes: trees of pictures, colours and operations on them.
//
// What our language has (a colour, a picture, a checkerboard) is written as that; anything else is evaluated
// texel by texel into a new picture.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <pugixml.hpp>

#include "core/formats/pbrt/pbrt_spectra.h"
#include "core/math/transform.h"

namespace mote::core {

/// (s, t) = scale (u, v) + offset.
struct PbrtMapping {
    glm::dvec2 scale{1.0}, offset{0.0};
    bool operator==(const PbrtMapping&) const = default;
    glm::dvec2 apply(const glm::dvec2& uv) const { return scale * uv + offset; }
    glm::dvec2 invert(const glm::dvec2& st) const { return (st - offset) / scale; }
};

class PbrtTexture {
  public:
    virtual ~PbrtTexture() = default;
    virtual Rgb value(const glm::dvec2& uv) const = 0;
    /// True where the value is the same everywhere.
    virtual bool constant() const { return false; }
    /// The mapping of the first picture or pattern below, and the largest number of texels along an axis.
    virtual const PbrtMapping* mapping() const { return nullptr; }
    virtual int texels() const { return 1; }
    /// True where all below have the mapping `m`, or none.
    virtual bool only(const PbrtMapping& m) const { return !mapping() || *mapping() == m; }
    /// Writes it where our language has the same; else returns false.
    virtual bool add(pugi::xml_node, const std::string&) const { return false; }

    /// Mean over the unit square of its mapping.
    Rgb mean() const;
};
using PbrtTexturePtr = std::shared_ptr<const PbrtTexture>;

class PbrtTextures {
  public:
    explicit PbrtTextures(PbrtFiles& files) : files_(files) {}

    /// The directive Texture. `value_type`: "float" or "spectrum".
    void define(const std::string& name, const std::string& value_type, const PbrtObject& object);
    /// A parameter that is a colour, a number or the name of a texture; null where it is not given.
    PbrtTexturePtr find(const PbrtObject& object, const std::string& name, bool spectrum,
                        bool reflectance = true);
    /// find(), or a default value.
    PbrtTexturePtr get(const PbrtObject& object, const std::string& name, double default_value,
                       bool spectrum);
    /// The texture of that name.
    PbrtTexturePtr named(const std::string& name, bool spectrum, const SourceLocation& where) const;
    /// Writes a texture as the child `name` of an element; a constant as a colour, or where `number` as a
    /// float.
    void add(pugi::xml_node parent, const std::string& name, const PbrtTexturePtr& texture, bool number);
    /// A picture file as a texture; `raw`: its 8-bit values are linear.
    PbrtTexturePtr picture(const std::string& file, const SourceLocation& where, bool raw);

  private:
    PbrtTexturePtr make(const PbrtObject& object, bool spectrum);
    PbrtTexturePtr make_image(const PbrtObject& object);
    PbrtTexturePtr make_checkerboard(const PbrtObject& object, bool spectrum);
    PbrtTexturePtr make_pattern(const PbrtObject& object, bool spectrum);
    PbrtTexturePtr replaced(const PbrtObject& object, const std::string& done, PbrtTexturePtr by);
    PbrtMapping mapping_of(const PbrtObject& object);
    std::string bake(const PbrtTexture& texture, const PbrtMapping& mapping, bool reflectance);

    PbrtFiles& files_;
    std::map<std::string, PbrtTexturePtr> floats_, spectra_;
    std::map<std::pair<const PbrtTexture*, bool>, std::string> baked_;  ///< as reflectance, or not
    std::vector<PbrtTexturePtr> kept_;  ///< so that no two in baked_ have one address
};

/// A function of at most three textures, value by value.
using PbrtTextureFunction = std::function<Rgb(const std::array<Rgb, 3>&)>;
PbrtTexturePtr pbrt_function(std::vector<PbrtTexturePtr> inputs, PbrtTextureFunction function);
PbrtTexturePtr pbrt_constant(const Rgb& value);

}  // namespace mote::core
