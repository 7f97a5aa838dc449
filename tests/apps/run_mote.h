// Runs the `mote` command in a folder of its own and catches what it says.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace mote::tests {

struct RunResult {
    int exit_code = -1;  ///< -1: ended by a signal
    std::string out, err;
};

inline std::string read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}
inline void write_file(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// A running command. Arguments are given as they are, without a shell.
class MoteProcess {
  public:
    /// `out`: where its output goes, "" for a file in the folder. `in_child` sets limits of the process.
    MoteProcess(const TemporaryFolder& folder, std::vector<std::string> arguments,
                const std::string& out = "", const std::function<void()>& in_child = {})
        : out_(out.empty() ? folder.file("stdout.txt") : out), err_(folder.file("stderr.txt")) {
        arguments.insert(arguments.begin(), MOTE_BINARY_DIR "/mote");
        std::vector<char*> argv;
        for (std::string& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        id_ = ::fork();
        if (id_ == 0) {
            const bool ready = ::chdir(folder.path().c_str()) == 0 && redirect(out_, STDOUT_FILENO) &&
                               redirect(err_, STDERR_FILENO);
            if (in_child) in_child();
            if (ready) ::execv(argv[0], argv.data());
            ::_exit(127);
        }
    }
    ~MoteProcess() {
        if (!running()) return;  // a failed test must leave no renders running
        send(SIGKILL);
        wait();
    }
    MoteProcess(const MoteProcess&) = delete;
    MoteProcess& operator=(const MoteProcess&) = delete;
    void send(int signal_number) { ::kill(id_, signal_number); }
    bool running() {
        ended_ = ended_ || ::waitpid(id_, &status_, WNOHANG) != 0;
        return !ended_;
    }
    RunResult wait() {
        if (!ended_) ::waitpid(id_, &status_, 0);
        ended_ = true;
        const bool kept = std::filesystem::is_regular_file(out_);  // /dev/full is read without end
        return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -1, kept ? read_file(out_) : "", read_file(err_)};
    }

  private:
    static bool redirect(const std::string& path, int descriptor) {
        const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        return file >= 0 && ::dup2(file, descriptor) == descriptor;
    }
    std::string out_, err_;
    pid_t id_ = -1;
    int status_ = 0;
    bool ended_ = false;
};

inline RunResult run_mote(const TemporaryFolder& folder, std::vector<std::string> arguments,
                          const std::function<void()>& in_child = {}) {
    return MoteProcess(folder, std::move(arguments), "", in_child).wait();
}

/// Waits until the file is there; false when the process ends before, or after a minute.
inline bool wait_for_file(MoteProcess& process, const std::string& path) {
    for (int i = 0; i < 6000; ++i) {
        if (std::filesystem::exists(path)) return true;
        if (!process.running()) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace mote::tests
