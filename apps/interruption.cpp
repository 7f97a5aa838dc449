// Signal handlers can reach nothing but objects of static storage: the three variables below are why.
#include "apps/interruption.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

namespace mote::apps {

namespace {

std::atomic<bool> interrupted{false};
std::atomic<int> first_signal{0};
std::atomic<time_t> first_time{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<time_t>::is_always_lock_free,
              "a signal handler must not wait for a lock");

constexpr time_t patience_seconds = 5;

time_t seconds_now() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec;
}

extern "C" void on_signal(int number) {
    if (!interrupted.exchange(true)) {
        first_signal = number, first_time = seconds_now();
        return;
    }
    if (seconds_now() - first_time > patience_seconds) ::_exit(128 + number);
}

void set_handler(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

Interruption::Interruption() {
    interrupted = false, first_signal = 0;
    set_handler(on_signal);
}
Interruption::~Interruption() { set_handler(SIG_DFL); }
const std::atomic<bool>& Interruption::flag() const { return interrupted; }
int Interruption::signal_number() const { return first_signal; }

}  // namespace mote::apps
