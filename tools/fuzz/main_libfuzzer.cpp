// libFuzzer on one format, named by MOTE_FUZZ_FORMAT: it sees which parts of our readers a file reaches, and
// changes files so that they reach more. Folders of MOTE_FUZZ_FOLDER as those of mote_fuzz.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tools/fuzz/formats.h"

namespace {

using namespace mote::fuzz;

// State shared by all calls; libFuzzer's interface leaves it no other place.
struct State {
    std::vector<Format> all = formats();
    const Format* format = nullptr;
    std::string path;
    unsigned long long read = 0, refused = 0;
    double slowest = 0.0;

    State() {
        const char* const name = std::getenv("MOTE_FUZZ_FORMAT");
        const char* const folder = std::getenv("MOTE_FUZZ_FOLDER");
        format = &find_format(all, name ? name : "");
        std::filesystem::create_directories(folder ? folder : ".");
        write_neighbours(folder ? folder : ".");
        path = (std::filesystem::path(folder ? folder : ".") / ("case" + format->extension)).string();
    }
    ~State() {
        std::fprintf(stderr, "outcomes %llu read %llu refused slowest %.6f\n", read, refused, slowest);
    }
};

State& state() {
    static State instance;
    return instance;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    state();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    State& s = state();
    Bytes bytes(data, data + size);
    if (s.format->forge) s.format->forge(bytes);
    std::ofstream(s.path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    std::string message;
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = try_file(*s.format, s.path, message);
    s.slowest =
        std::max(s.slowest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (outcome == Outcome::defect) {
        std::fprintf(stderr, "defect: %s\n", message.c_str());
        std::abort();
    }
    ++(outcome == Outcome::read ? s.read : s.refused);
    return 0;
}
