// The factories of media/: what a scene file can say, and how it is refused.
#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "media/heterogeneous_medium.h"
#include "media/register_media.h"
#include "media/vdb_volume.h"
#include "tests/media/test_media.h"
#include "tests/media/vdb_test_files.h"
#include "tests/support/catch.h"

using namespace mote;
using core::Category, core::Properties, core::PropertyValue, core::Rgb, core::Vec3;

namespace {

class Element {
  public:
    Element(Category category, const std::string& type) {
        p_.category = category, p_.type = type;
        p_.where = {"scene.xml", 7};
        p_.search_paths = {"/"};
        media::register_media(registry_);
    }
    Element& set(const std::string& name, PropertyValue value) {
        p_.values[name] = {std::move(value), {"scene.xml", 8}};
        return *this;
    }
    Element& nest(const std::string& name, Category category, std::shared_ptr<core::Object> object) {
        p_.children.push_back({name, category, std::move(object), {"scene.xml", 9}});
        return *this;
    }
    template <typename T = core::Object>
    std::shared_ptr<T> make() {
        p_.warnings = &warnings_;  // not earlier: elements are copied while they are put together
        return std::dynamic_pointer_cast<T>(registry_.make(p_));
    }
    std::string refusal() {
        try {
            make();
        } catch (const core::InputError& e) {
            return e.what();
        }
        return "";
    }
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    Properties p_;
    std::vector<std::string> warnings_;
    core::Registry registry_;
};

std::shared_ptr<core::Object> constant(const Rgb& v) { return std::make_shared<media::ConstantVolume>(v); }

}  // namespace

TEST_CASE("media/ registers its types with complete manual pages", "[media][registry]") {
    core::Registry registry;
    media::register_media(registry);
    CHECK(registry.types(Category::phase) == std::vector<std::string>{"hg", "isotropic"});
    CHECK(registry.types(Category::volume) ==
          std::vector<std::string>{"constvolume", "gridvolume", "vdbvolume"});
    CHECK(registry.types(Category::medium) == std::vector<std::string>{"heterogeneous", "homogeneous"});
    for (const core::Manual* manual : registry.manuals()) {
        CHECK_FALSE(manual->summary.empty());
        CHECK(manual->example.find("type=\"" + manual->type + "\"") != std::string::npos);
        for (const auto& parameter : manual->parameters) CHECK_FALSE(parameter.description.empty());
    }
}

TEST_CASE("defaults are those of Mitsuba 3", "[media][registry]") {
    CHECK(Element(Category::phase, "hg").make<core::PhaseFunction>()->mean_cosine() == 0.8f);
    for (const char* type : {"homogeneous", "heterogeneous"}) {
        const auto m = Element(Category::medium, type).make<core::Medium>();
        CHECK(m->coefficients(Vec3(0)).sigma_t == Rgb(1.0f));
        CHECK(m->coefficients(Vec3(0)).sigma_s == Rgb(0.75f));
        CHECK(m->phase().isotropic());
        CHECK(m->traits().homogeneous == (std::string(type) == "homogeneous"));
    }
}

TEST_CASE("a homogeneous medium by scattering and absorption", "[media][registry]") {
    const auto make = [] { return Element(Category::medium, "homogeneous"); };
    const auto m = make()
                       .set("sigma_s", Rgb(1, 2, 3))
                       .set("sigma_a", 1.0)
                       .set("scale", 2.0)
                       .set("Le", 3.0)
                       .set("Lescale", 0.5)
                       .make<core::Medium>();
    CHECK(m->coefficients(Vec3(0)).sigma_t == Rgb(4, 6, 8));
    CHECK(m->coefficients(Vec3(0)).sigma_s == Rgb(2, 4, 6));
    CHECK(m->coefficients(Vec3(0)).emission == Rgb(3.0f));
    CHECK(make().set("sigma_s", 1.0).set("albedo", 0.5).refusal().find("scene.xml:7") == 0);
    CHECK_FALSE(make().set("albedo", 1.5).refusal().empty());
    CHECK_FALSE(make().set("sigma_t", -1.0).refusal().empty());
    CHECK_FALSE(make().set("sigma_t", 1e38).set("scale", 1e38).refusal().empty());
    CHECK_FALSE(Element(Category::phase, "hg").set("g", 1.0).refusal().empty());
    CHECK_FALSE(Element(Category::phase, "hg").set("g", -0.99999999999).refusal().empty());  // 1 as a float
}

TEST_CASE("a heterogeneous medium from nested volumes", "[media][registry]") {
    const auto make = [] { return Element(Category::medium, "heterogeneous"); };
    const auto m = make()
                       .nest("density", Category::volume, constant(Rgb(1, 2, 3)))
                       .nest("albedo", Category::volume, constant(Rgb(0.5f)))
                       .set("scale", 10.0)
                       .make<core::Medium>();
    CHECK(m->coefficients(Vec3(0)).sigma_t == Rgb(10, 20, 30));
    CHECK(m->coefficients(Vec3(0)).sigma_s == Rgb(5, 10, 15));
    CHECK(m->traits().chromatic);
    CHECK(make()
              .nest("density", Category::volume, constant(Rgb(1)))
              .set("sigma_t", 1.0)
              .refusal()
              .find("one of them") != std::string::npos);
    CHECK(make().nest("albedo", Category::volume, constant(Rgb(1.5f))).refusal().find("above 1") !=
          std::string::npos);
    CHECK(make().set("sigma_t", 1e38).set("scale", 1e38).refusal().find("too large") != std::string::npos);
    auto empty = make().set("scale", 0.0);
    CHECK(empty.make<core::Medium>()->traits().empty);
    CHECK(empty.warnings().size() == 1);
}

TEST_CASE("media shine by temperature", "[media][registry][emission]") {
    const auto make = [] { return Element(Category::medium, "heterogeneous").set("albedo", 0.5); };
    const auto hot = make()
                         .nest("temperature", Category::volume, constant(Rgb(20.0f)))
                         .set("temperature_offset", 5.0)
                         .set("temperature_scale", 100.0)
                         .set("Lescale", 2.0)
                         .make<core::Medium>();
    CHECK(hot->traits().emissive);
    const Rgb glow = hot->coefficients(Vec3(0)).emission;  // 1500 K: sigma_a = 0.5, Lescale 2
    CHECK(glow.x > 3.0f * glow.y);
    CHECK(glow.x > 0.0f);
    CHECK_FALSE(
        make().nest("temperature", Category::volume, constant(Rgb(20.0f))).set("Le", 1.0).refusal().empty());
    auto alone = make().set("temperature_scale", 2.0);
    CHECK_FALSE(alone.make<core::Medium>()->traits().emissive);
    CHECK(alone.warnings().size() == 1);
}

TEST_CASE("grids from files, with warnings for the user", "[media][registry]") {
    const tests::GridFolder folder;
    media::write_vol_file(folder.file("grid.vol"), tests::vol_grid({2, 2, 2}, 1, [](int x, int, int) {
                              return Rgb(x ? 1.0f : -1.0f);
                          }));
    const auto vol = [&] {
        return Element(Category::volume, "gridvolume").set("filename", folder.file("grid.vol"));
    };
    CHECK(vol().refusal().find("grid.vol") != std::string::npos);
    auto clamped = vol().set("clamp_negative", true);
    CHECK(clamped.make<media::Volume>()->upper_bound() == Rgb(1.0f));
    CHECK(clamped.warnings().size() == 1);
    const core::Transform flat(glm::scale(glm::dmat4(1.0), core::Vec3d(1, 1, 0)));
    CHECK_FALSE(vol().set("clamp_negative", true).set("to_world", flat).refusal().empty());
    CHECK_FALSE(vol().set("filter_type", std::string("nearest")).refusal().empty());

    const auto vdb = [&](const char* kind) {
        return Element(Category::volume, "vdbvolume").set("filename", folder.grid(kind));
    };
    const core::Transform twice(glm::scale(glm::dmat4(1.0), core::Vec3d(2.0)));
    const auto volume = vdb("tiles").set("to_world", twice).make<media::Volume>();
    CHECK(volume->eval(Vec3(60, 60, 60)).x == 0.75f);
    CHECK(volume->eval(Vec3(80, 60, 60)).x == 0.0f);
    CHECK(vdb("lump").set("to_world", flat).refusal().find("singular") != std::string::npos);
    CHECK(vdb("lump").set("grid", std::string("smoke")).refusal().find("grids present: density") !=
          std::string::npos);
    auto three = vdb("three");
    CHECK(three.make<media::Volume>());
    CHECK(three.warnings().size() == 1);
}
