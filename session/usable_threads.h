// Number of threads that the system grants: where a limit on processes is met, libraries that start one would
// abort.
#pragma once

namespace mote::session {

/// Threads that may work at once, at most `wanted`, besides one that watches them; at least 1. Starts and
/// ends that many.
int usable_threads(int wanted);

}  // namespace mote::session
