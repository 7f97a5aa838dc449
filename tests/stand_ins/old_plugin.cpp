// A plugin for headers that are not today's. Nothing may call its second function.
#include <cstdlib>

#define SHOWN extern "C" __attribute__((visibility("default")))

SHOWN const char* mote_plugin_interface() { return "mote 0.0.9, interface 000000000000"; }
SHOWN void mote_register_plugin(void*) { std::abort(); }
