// The methods file: which integrators take part in a trade, with which settings and limits.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/objects/registry.h"
#include "core/render/integrator.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"

namespace mote::trade {

struct Method {
    std::string name, slug;  ///< slug: the name as a file name
    std::string type;        ///< of the integrator
    /// A nested object is its type and its values under dotted names: "compensation", "compensation.depth".
    nlohmann::json settings = nlohmann::json::object();
    std::shared_ptr<const core::Integrator> integrator;

    /// "bound=2 paths=256"
    std::string settings_text() const;
    /// "-D integrator.paths=256" for `mote render`, which gives the same picture.
    std::vector<std::string> render_options() const;
};

struct MethodsFile {
    std::optional<double> seconds;
    std::optional<std::uint32_t> passes;
    std::uint32_t seeds = 1;
    std::vector<Method> methods;
};

/// A name as a file name: lower-case letters, digits and dashes; may be empty.
std::string slug_of(const std::string& name);

/// Reads the file and makes the integrators for this scene. Throws InputError with file, line and the nearest
/// known word for whatever is unknown, repeated, missing or of the wrong kind.
MethodsFile read_methods_file(const std::string& path, const core::Registry& registry,
                              const core::Scene& scene, std::vector<std::string>& warnings);
/// Reads them from text; `path` is its name in messages.
MethodsFile read_methods(const std::string& text, const std::string& path, const core::Registry& registry,
                         const core::Scene& scene, std::vector<std::string>& warnings);

/// A methods file for a scene that requires this: a path tracer, bounded and unbounded virtual point lights,
/// compensation and photons; in homogeneous media among point-like lights also equi-angular sampling, and
/// spherical lights where there are no media. Twenty seconds for every method and each of two seeds.
std::string default_methods(const core::Requirements& requirements);

}  // namespace mote::trade
