// Further integrators for a scene that is loaded already, through the checks of a scene file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/objects/error.h"
#include "core/objects/registry.h"

namespace mote::core {

class Integrator;
class Scene;

/// A value as it would stand in a scene file: <tag name="name" value="text"/>. The name of a nested object
/// sets its type, and "compensation.depth" a value of it, as with -D.
struct IntegratorSetting {
    std::string name, tag, text;
    SourceLocation where;
};

/// The integrator `type` with these settings; where they are silent, the parameters of the scene's
/// integrator of this type hold, else those of its own, as with `--integrator`. Adds to `warnings`. Throws
/// InputError with the place of what is unknown or wrong, and the nearest known name.
std::shared_ptr<Integrator> make_integrator(const Registry& registry, const Scene& scene,
                                            const std::string& type,
                                            const std::vector<IntegratorSetting>& settings,
                                            const SourceLocation& where, std::vector<std::string>& warnings);

}  // namespace mote::core
