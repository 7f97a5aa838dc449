// A plugin with a name that is taken.
#include <mote/core/objects/plugin.h>
#include <mote/core/parameters/add_type.h>

namespace {

void register_types(mote::core::Registry& registry) {
    registry.add(
        {mote::core::Category::integrator, "path", "Another one.", {}, R"(<integrator type="path"/>)"},
        [](const mote::core::Properties&) { return nullptr; });
}

}  // namespace

MOTE_PLUGIN(register_types)
