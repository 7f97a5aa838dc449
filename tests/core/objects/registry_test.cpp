// Objects made without a scene file: names that do not exist are refused, with the nearest one.
#include "core/objects/registry.h"

#include "core/materials/bsdf.h"
#include "core/objects/properties.h"
#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("The registry makes what properties describe", "[registry]") {
    Registry registry;
    register_core(registry);
    Properties p;
    p.category = Category::bsdf, p.type = "roughplastic", p.where = {"host", 3};
    p.values["alpha"] = {0.2, {"host", 4}};
    CHECK(std::dynamic_pointer_cast<Bsdf>(registry.make(p)));

    p.values["aplha"] = {0.2, {"host", 5}};
    CHECK_THROWS_WITH(registry.make(p),
                      ContainsSubstring("host:5: ") && ContainsSubstring("did you mean 'alpha'"));
    p.type = "roughplastik";
    CHECK_THROWS_WITH(registry.make(p), ContainsSubstring("host:3: unknown bsdf type 'roughplastik'") &&
                                            ContainsSubstring("did you mean 'roughplastic'"));
}
