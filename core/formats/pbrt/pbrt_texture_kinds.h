// The kinds of textures that a tree is made of.
#pragma once

#include <array>
#include <cmath>

#include "core/film/bitmap.h"
#include "core/formats/pbrt/pbrt_textures.h"

namespace mote::core {

class PbrtConstant final : public PbrtTexture {
  public:
    explicit PbrtConstant(const Rgb& value) : value_(value) {}
    Rgb value(const glm::dvec2&) const override { return value_; }
    bool constant() const override { return true; }

  private:
    Rgb value_;
};

/// Squares of side 1 in (s, t), the first one at the origin.
class PbrtCheckerboard final : public PbrtTexture {
  public:
    PbrtCheckerboard(const PbrtMapping& mapping, PbrtTexturePtr first, PbrtTexturePtr second)
        : mapping_(mapping), first_(std::move(first)), second_(std::move(second)) {
        doubled_ = mapping_, doubled_.scale *= 0.5, doubled_.offset *= 0.5;
    }
    Rgb value(const glm::dvec2& uv) const override {
        const glm::dvec2 st = glm::floor(mapping_.apply(uv));
        return (std::fmod(st.x + st.y, 2.0) == 0.0 ? first_ : second_)->value(uv);
    }
    /// One period is two squares wide.
    const PbrtMapping* mapping() const override { return &doubled_; }
    int texels() const override { return std::max({512, first_->texels(), second_->texels()}); }
    bool add(pugi::xml_node parent, const std::string& name) const override;

  private:
    PbrtMapping mapping_, doubled_;
    PbrtTexturePtr first_, second_;
};

/// A picture, v upwards.
class PbrtImage final : public PbrtTexture {
  public:
    struct Settings {
        PbrtMapping mapping;
        std::string path, in_xml;  ///< the file, and its name in the XML
        bool raw = false, nearest = false, clamp = false;
    };
    explicit PbrtImage(Settings settings) : s_(std::move(settings)) {}
    Rgb value(const glm::dvec2& uv) const override;
    const PbrtMapping* mapping() const override { return &s_.mapping; }
    int texels() const override { return std::max(bitmap().width, bitmap().height); }
    bool add(pugi::xml_node parent, const std::string& name) const override;

  private:
    const Bitmap& bitmap() const;

    Settings s_;
    mutable std::shared_ptr<const Bitmap> bitmap_;  ///< read when a texel is evaluated first
};

class PbrtFunction final : public PbrtTexture {
  public:
    using Function = PbrtTextureFunction;
    PbrtFunction(std::vector<PbrtTexturePtr> inputs, Function function)
        : inputs_(std::move(inputs)), function_(std::move(function)) {}
    Rgb value(const glm::dvec2& uv) const override {
        std::array<Rgb, 3> values;
        for (std::size_t i = 0; i < inputs_.size(); ++i) values[i] = inputs_[i]->value(uv);
        return function_(values);
    }
    const PbrtMapping* mapping() const override {
        for (const PbrtTexturePtr& t : inputs_)
            if (t->mapping()) return t->mapping();
        return nullptr;
    }
    int texels() const override {
        int most = 1;
        for (const PbrtTexturePtr& t : inputs_) most = std::max(most, t->texels());
        return most;
    }
    bool only(const PbrtMapping& m) const override {
        return std::all_of(inputs_.begin(), inputs_.end(),
                           [&](const PbrtTexturePtr& t) { return t->only(m); });
    }

  private:
    std::vector<PbrtTexturePtr> inputs_;
    Function function_;
};

/// A pattern over (s, t): bilinear interpolation of corners, or dots.
class PbrtPattern final : public PbrtTexture {
  public:
    PbrtPattern(const PbrtMapping& mapping, std::function<Rgb(const glm::dvec2& uv, const glm::dvec2& st)> f)
        : mapping_(mapping), function_(std::move(f)) {}
    Rgb value(const glm::dvec2& uv) const override { return function_(uv, mapping_.apply(uv)); }
    const PbrtMapping* mapping() const override { return &mapping_; }
    int texels() const override { return 512; }

  private:
    PbrtMapping mapping_;
    std::function<Rgb(const glm::dvec2&, const glm::dvec2&)> function_;
};

/// Writes <transform name="to_uv">: (u, v) to (s, t), v turned over where `flip`.
void add_pbrt_mapping(pugi::xml_node texture, const PbrtMapping& mapping, bool flip);

}  // namespace mote::core
