// A plugin: types of the scene language in a shared library of their own, which the option --plugin and the
// variable MOTE_PLUGINS load (docs/plugins.md).
//
//   void register_types(mote::core::Registry& registry) { registry.add(...); }
//   MOTE_PLUGIN(register_types)
//
// It is linked with mote's static libraries: it shares no state with the program, and the layouts of types
// alone must agree. MOTE_INTERFACE represents them: the version, and a checksum of the installed headers.
#pragma once

#include <mote/interface.h>

#include "core/objects/registry.h"

namespace mote::core {

/// Names of the two functions that a plugin has.
inline constexpr const char* plugin_interface_name = "mote_plugin_interface";
inline constexpr const char* plugin_register_name = "mote_register_plugin";  ///< see plugin_interface_name
/// The interface that it was compiled for, as in MOTE_INTERFACE.
using PluginInterface = const char*();
/// Adds its types.
using PluginRegister = void(Registry*);

}  // namespace mote::core

/// Makes the library a plugin; `function(mote::core::Registry&)` adds its types.
#define MOTE_PLUGIN(function)                                                               \
    extern "C" __attribute__((visibility("default"))) const char* mote_plugin_interface() { \
        return MOTE_INTERFACE;                                                              \
    }                                                                                       \
    extern "C" __attribute__((visibility("default"))) void mote_register_plugin(            \
        ::mote::core::Registry* registry) {                                                 \
        function(*registry);                                                                \
    }
