#include "session/usable_threads.h"

#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace mote::session {

int usable_threads(int wanted) {
    std::mutex mutex;
    std::condition_variable enough;
    bool leave = false;
    std::vector<std::thread> threads;
    threads.reserve(std::size_t(wanted));
    const auto wait = [&] {
        std::unique_lock lock(mutex);
        enough.wait(lock, [&] { return leave; });
    };
    try {
        while (int(threads.size()) < wanted) threads.emplace_back(wait);
    } catch (const std::system_error&) {  // no more of them
    }
    {
        const std::lock_guard lock(mutex);
        leave = true;
    }
    enough.notify_all();
    for (std::thread& t : threads) t.join();
    return std::max(1, int(threads.size()));
}

}  // namespace mote::session
