// The entry point: checks the processor, then runs the command.
//
// Signals end the program with a line of text from its first instruction on; what has something to lose
// replaces the handlers (interruption.cpp). Functions of .preinit_array run before the libraries'
// constructors.
//
// The first thread that TBB cannot start ends the program without a word, so one is tried before.
//
// This file is compiled for any x86-64, the rest of the program perhaps for processors with AVX2. The check
// runs before the constructors of all other files, for these may use such instructions already.
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include "apps/command.h"

namespace {

void* end_at_once(void*) { return nullptr; }

void check_threads() {
    pthread_t thread;
    if (::pthread_create(&thread, nullptr, end_at_once, nullptr) == 0) {
        ::pthread_join(thread, nullptr);
        return;
    }
    static const char message[] =
        "mote: the system grants too few threads to start with (a limit on processes, see 'ulimit -u')\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message, sizeof(message) - 1);
    ::_exit(3);
}

extern "C" void end_with_a_line(int number) {
    static const char message[] = "mote: interrupted\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message, sizeof(message) - 1);
    ::_exit(128 + number);
}

void prepare() {
    const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    for (const int number : numbers) {
        struct sigaction action {};
        if (::sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;  // nohup
        action.sa_handler = end_with_a_line;
        ::sigaction(number, &action, nullptr);
    }
    check_threads();
}

__attribute__((section(".preinit_array"), used)) void (*const before_libraries)() = prepare;

}  // namespace

#if defined(MOTE_NEEDS_AVX2)
namespace {

__attribute__((constructor(101))) void check_processor() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
        return;
    static const char message[] =
        "mote: this program was built for processors with AVX2 and FMA (from about 2013), which this one "
        "lacks; build it with -DMOTE_ARCH=x86-64 (cmake --preset portable)\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message, sizeof(message) - 1);
    ::_exit(3);
}

}  // namespace
#endif

int main(int argc, char* argv[]) { return mote::apps::run_command(argc, argv); }
