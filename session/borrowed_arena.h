// Threads for one piece of work, from arenas that are kept: oneTBB 2021.8 never gives back some 7 KB of each
// that it makes, so a process with thousands of renders makes no more of them than run at once. They hold no
// other state.
#pragma once

#include <tbb/task_arena.h>

#include <memory>
#include <utility>

namespace mote::session {

/// Gives the calling thread's own arena that arithmetic, for programs that need no other one. Must come
/// before their first parallel loop.
void settle_arithmetic();

/// The control word of a thread outside of parallel loops, from construction to destruction.
class PlainArithmetic {
  public:
    PlainArithmetic();
    ~PlainArithmetic();
    PlainArithmetic(const PlainArithmetic&) = delete;
    PlainArithmetic& operator=(const PlainArithmetic&) = delete;

  private:
    unsigned before_;
};

class BorrowedArena {
  public:
    /// For `threads` threads, the caller's among them; 0: one for every core.
    explicit BorrowedArena(int threads);
    ~BorrowedArena();
    BorrowedArena(const BorrowedArena&) = delete;
    BorrowedArena& operator=(const BorrowedArena&) = delete;

    template <typename F>
    auto execute(F&& f) {
        return arena_->execute([&] {
            const PlainArithmetic here;
            return f();
        });
    }

  private:
    int threads_;
    std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace mote::session
