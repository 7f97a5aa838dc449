// Threads for one piece of work, from arenas that are kept: oneTBB 2021.8 never gives back some 7 KB of each
// that it makes, so a process with thousands of renders makes no more of them than run at once. They hold no
// other state.
#pragma once

#include <tbb/task_arena.h>

#include <memory>

namespace mote::session {

class BorrowedArena {
  public:
    /// For `threads` threads, the caller's among them.
    explicit BorrowedArena(int threads);
    ~BorrowedArena();
    BorrowedArena(const BorrowedArena&) = delete;
    BorrowedArena& operator=(const BorrowedArena&) = delete;

    template <typename F>
    auto execute(F&& f) {
        return arena_->execute(std::forward<F>(f));
    }

  private:
    int threads_;
    std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace mote::session
