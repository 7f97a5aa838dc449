// Integrators of Mitsuba as ours.
#pragma once

#include <string>
#include <vector>

#include "core/formats/xml/xml_reader.h"
#include "core/objects/registry.h"

namespace mote::core {

/// Replaces the integrators that Mitsuba has and `registry` has not by what computes the same picture,
/// each with a warning: a nested one of aov, moment and stokes takes their place. The `aovs` of aov go to
/// document.features.
void replace_foreign_integrators(SceneDocument& document, const Registry& registry);
/// --integrator: the type that the command line names, with those parameters of the file that it has.
/// Whatever is wrong with an integrator of another type is a warning. Throws InputError for an unknown type.
void override_integrator(SceneDocument& document, const std::string& type, const Registry& registry);

/// Sets the type where the file has no integrator, or one that is not known.
void complete_integrator(SceneDocument& document, const std::string& type, const Registry& registry);

/// Replacement of an integrator of Mitsuba, for the table of documentation.
struct ForeignIntegrator {
    const char *from, *to, *note;
    int max_depth = 0;  ///< above 0: set
};
const std::vector<ForeignIntegrator>& foreign_integrators();

}  // namespace mote::core
