// How many threads the system grants: where a limit on processes is met, libraries that start one would
// abort.
#pragma once

namespace mote::session {

/// At most `wanted`, this one included; at least 1. Starts and ends that many.
int usable_threads(int wanted);

}  // namespace mote::session
