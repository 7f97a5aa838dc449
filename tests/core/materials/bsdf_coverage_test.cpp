// Every BSDF that a scene file can name has a case in bsdf_cases.h, whose chi-square test is
// chi2_bsdf_test.cpp; those without a smooth part have no density to test.
#include <set>

#include "tests/core/materials/bsdf_cases.h"
#include "tests/support/catch.h"
#include "tests/support/registered_cases.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;
using core::Category;

namespace {

/// Cases are named by the type, an underscore and what is special about them.
std::set<std::string> tested_types() {
    std::set<std::string> types;
    for (const BsdfCase& c : all_cases()) types.insert(c.name.substr(0, c.name.find('_')));
    return types;
}

}  // namespace

TEST_CASE("every registered BSDF has a chi-square case", "[materials][bsdf][chi2][coverage]") {
    for (const std::string& complaint : untested_types(registry(), Category::bsdf, tested_types()))
        FAIL_CHECK(complaint);
}

TEST_CASE("cases without a chi-square test have no smooth part", "[materials][bsdf][chi2][coverage]") {
    for (const BsdfCase& c : smooth_cases()) {
        INFO(c.name);
        CHECK(c.bsdf->traits().smooth);
    }
    for (const BsdfCase& c : delta_cases()) {
        INFO(c.name);
        CHECK_FALSE(c.bsdf->traits().smooth);
    }
}

TEST_CASE("a BSDF registered without a case is found", "[materials][bsdf][chi2][planted]") {
    core::Registry larger = registry();
    larger.add({Category::bsdf, "velvet", "", {}, ""},
               [](const core::Properties&) { return core::make_diffuse(); });
    CHECK(untested_types(larger, Category::bsdf, tested_types()) ==
          std::vector<std::string>{"no chi² case for bsdf 'velvet'"});
    std::set<std::string> misspelt = tested_types();
    misspelt.erase("plastic"), misspelt.insert("plastik");
    CHECK(untested_types(registry(), Category::bsdf, misspelt).size() == 2);
}
