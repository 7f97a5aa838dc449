#include "session/borrowed_arena.h"

#include <immintrin.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <map>
#include <mutex>
#include <vector>

namespace mote::session {

namespace {

constexpr unsigned denormals_to_zero = 0x8040;  // results, and operands

/// Makes what `make` makes with the control word of tasks.
template <typename Make>
auto with_flushing(const Make& make) {
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | denormals_to_zero);
    auto made = make();
    _mm_setcsr(before);
    return made;
}

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

void settle_arithmetic() {
    // No thread is started here: how many there may be is not known yet.
    const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    with_flushing([] {
        tbb::parallel_for(0, 2, [](int) {});  // the first makes the arena
        return true;
    });
}

PlainArithmetic::PlainArithmetic() : before_(_mm_getcsr()) { _mm_setcsr(before_ & ~denormals_to_zero); }
PlainArithmetic::~PlainArithmetic() { _mm_setcsr(before_); }

BorrowedArena::BorrowedArena(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()) {
    IdleArenas& idle = idle_arenas();
    const std::lock_guard lock(idle.mutex);
    auto& arenas = idle.by_threads[threads_];
    if (arenas.empty()) {
        arena_ = with_flushing([&] {
            auto made = std::make_unique<tbb::task_arena>(threads_);
            made->initialize();
            return made;
        });
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
