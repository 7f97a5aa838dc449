// Signal handlers can reach nothing but objects of static storage: the variables below are why.
#include "apps/interruption.h"

#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "apps/command.h"

namespace mote::apps {

namespace {

std::atomic<bool> stop{false}, time_over{false}, writing{false};
std::atomic<int> first_signal{0};
std::atomic<std::int64_t> first_time{0};
std::atomic<const char*> idle_phase{nullptr}, idle_reason{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free &&
                  std::atomic<const char*>::is_always_lock_free,
              "a signal handler must not wait for a lock");

constexpr std::int64_t one_press_ms = 300;

std::int64_t milliseconds() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

void say(const char* text) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text, std::strlen(text));
}

void leave_if_idle(const char* what, int exit_code) {
    const char* phase = idle_phase;
    if (!phase) return;
    say("mote: "), say(what), say(" while "), say(phase), say(": "), say(idle_reason), say("\n");
    ::_exit(exit_code);
}

extern "C" void on_alarm(int) {
    leave_if_idle("the time is over", exit_input);
    time_over = true, stop = true;
}

extern "C" void on_signal(int number) {
    if (number == SIGHUP) ::signal(SIGPIPE, SIG_IGN);
    leave_if_idle("interrupted", 128 + number);
    int none = 0;
    if (first_signal.compare_exchange_strong(none, number)) {
        first_time = milliseconds(), stop = true;
        if (writing)
            say("mote: interrupted while writing, which ends first; another signal ends mote at once\n");
        return;
    }
    if (milliseconds() - first_time > one_press_ms) ::_exit(128 + number);
}

void set_handler(int number, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(number, &action, nullptr);
}

bool is_ignored(int number) {
    struct sigaction now {};
    return ::sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

constexpr int caught[] = {SIGINT, SIGTERM, SIGHUP, SIGALRM};
struct sigaction before[std::size(caught)];  ///< handlers, before construction

}  // namespace

Interruption::Interruption() {
    stop = false, time_over = false, writing = false, first_signal = 0, idle_phase = nullptr;
    for (std::size_t i = 0; i < std::size(caught); ++i) {
        ::sigaction(caught[i], nullptr, &before[i]);
        if (caught[i] == SIGHUP && is_ignored(SIGHUP)) continue;  // nohup
        set_handler(caught[i], caught[i] == SIGALRM ? on_alarm : on_signal);
    }
}
Interruption::~Interruption() {
    set_alarm(std::nullopt);
    for (std::size_t i = 0; i < std::size(caught); ++i) ::sigaction(caught[i], &before[i], nullptr);
}

void Interruption::end_at_once_while(const char* phase, const char* why) {
    idle_reason = why;
    idle_phase = phase;
}

void Interruption::writing_begins() { writing = true; }

void Interruption::set_alarm(std::optional<double> seconds) {
    itimerval timer{};
    if (seconds) {
        const double in = std::clamp(*seconds, 1e-3, 1e9), whole = std::floor(in);
        timer.it_value.tv_sec = time_t(whole);
        timer.it_value.tv_usec = suseconds_t(1e6 * (in - whole));
    }
    ::setitimer(ITIMER_REAL, &timer, nullptr);
}

const std::atomic<bool>& Interruption::flag() const { return stop; }
const std::atomic<bool>& Interruption::time_is_over() const { return time_over; }
int Interruption::signal_number() const { return first_signal; }

void ignore_file_size_signal() { ::signal(SIGXFSZ, SIG_IGN); }

}  // namespace mote::apps
