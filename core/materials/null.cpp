// BSDF "null": an invisible surface, for boundaries between media. Light passes straight through.
#include "core/materials/bsdfs.h"
#include "core/materials/register_materials.h"

namespace mote::core {
namespace {

class Null final : public Bsdf {
  public:
    BsdfTraits traits() const override { return {.delta = true, .transmissive = true, .null = true}; }
    Rgb eval(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override { return Rgb(0.0f); }
    float pdf_solid_angle(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override {
        return 0.0f;
    }
    std::optional<BsdfSample> sample(const BsdfPoint&, const Vec3& wo, float, const Vec2&,
                                     TransportMode) const override {
        BsdfSample s{.wi = -wo, .weight = Rgb(1.0f), .pdf_solid_angle = 0.0f};
        s.delta = s.transmitted = true;
        return s;
    }
    StraightPassage straight_passage(const BsdfPoint&, const Vec3&) const override {
        return {0.0f, Rgb(1.0f)};
    }
    Rgb albedo(const BsdfPoint&, const Vec3&) const override { return Rgb(1.0f); }
};

}  // namespace

std::shared_ptr<Bsdf> make_null() { return std::make_shared<Null>(); }

void register_null(Registry& registry) {
    add_type(registry, Category::bsdf, "null", "An invisible surface: the boundary of a medium.",
             R"(<bsdf type="null"/>)", [] { return make_null(); });
}

}  // namespace mote::core
