#include "session/borrowed_arena.h"

#include <map>
#include <mutex>
#include <vector>

namespace mote::session {

namespace {

struct IdleArenas {
    std::mutex mutex;
    std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>> by_threads;
};

/// Never destroyed: oneTBB may be gone before it.
IdleArenas& idle_arenas() {
    static IdleArenas& idle = *new IdleArenas;
    return idle;
}

}  // namespace

BorrowedArena::BorrowedArena(int threads) : threads_(threads) {
    IdleArenas& idle = idle_arenas();
    const std::lock_guard lock(idle.mutex);
    auto& arenas = idle.by_threads[threads];
    if (arenas.empty()) {
        arena_ = std::make_unique<tbb::task_arena>(threads);
        return;
    }
    arena_ = std::move(arenas.back());
    arenas.pop_back();
}

BorrowedArena::~BorrowedArena() {
    IdleArenas& idle = idle_arenas();
    const std::lock_guard lock(idle.mutex);
    idle.by_threads[threads_].push_back(std::move(arena_));
}

}  // namespace mote::session
