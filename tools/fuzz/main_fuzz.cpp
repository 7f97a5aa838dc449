// mote_fuzz: damages files of one format and has them read. tools/fuzz/run starts it, and starts it again
// where it crashed or hung.
//
// Prints "begin I" before and "end I OUTCOME SECONDS" after every case, so that a watcher sees which
// case it was. Case I depends on the format, the seed, I and the originals alone.
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/math/random.h"
#include "tools/fuzz/formats.h"
#include "tools/fuzz/mutate.h"
#include "tools/fuzz/seeds.h"

namespace {

namespace fs = std::filesystem;
using namespace mote::fuzz;

struct Arguments {
    std::string format, corpus, folder = ".", write, read, seeds_to;
    std::uint64_t first = 0, count = 100, seed = 14, memory_megabytes = 4096;
    bool list = false;
};

// Real files of the corpus folder that are small enough, in the order of their names, behind our own.
std::vector<Bytes> originals(const Format& format, const std::string& corpus) {
    constexpr std::size_t largest = std::size_t(1) << 18;
    std::vector<Bytes> all = format.seeds();
    std::vector<std::string> files;
    if (!corpus.empty())
        for (const auto& entry : fs::recursive_directory_iterator(corpus))
            if (entry.is_regular_file() && entry.file_size() > 0 && entry.file_size() <= largest)
                files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    for (const std::string& file : files) all.push_back(bytes_of_file(file));
    return all;
}

void write_file(const std::string& path, const Bytes& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

// A file that requests more memory than its reader may have is refused, with sanitizers and without.
bool is_of_a_memory_limit(const fs::path& report) {
    const Bytes bytes = bytes_of_file(report.string());
    const std::string text(bytes.begin(), bytes.end());
    const char* const limits[] = {"exceeds maximum supported size", "rss limit exhausted", "out of memory",
                                  "failed to allocate"};
    return std::any_of(std::begin(limits), std::end(limits),
                       [&](const char* words) { return text.find(words) != std::string::npos; });
}

// Reports of sanitizers on processes of their own, which readers started: put aside under the number of the
// case.
bool put_reports_aside(const std::string& folder, const std::string& path, std::uint64_t index) {
    std::vector<fs::path> reports;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename().string().starts_with("report")) reports.push_back(entry.path());
    const fs::path stem = fs::path(folder) / ("contained_" + std::to_string(index));
    bool any = false;
    std::error_code ignored;
    for (const fs::path& report : reports)
        if (is_of_a_memory_limit(report))
            fs::remove(report, ignored);
        else
            fs::rename(report, stem.string() + ".txt", ignored), any = true;
    if (any)
        fs::copy_file(path, stem.string() + fs::path(path).extension().string(),
                      fs::copy_options::overwrite_existing, ignored);
    return any;
}

// A sanitizer's shadow memory takes terabytes of addresses; it has limits of its own.
void limit_memory([[maybe_unused]] std::uint64_t megabytes) {
#if !defined(MOTE_SANITIZED)
    const rlimit limit{megabytes << 20, megabytes << 20};
    ::setrlimit(RLIMIT_AS, &limit);
#endif
}

// Processor time of this process and of its children that have ended [s].
double processor_seconds() {
    double sum = 0.0;
    for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        ::getrusage(who, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            sum += double(time.tv_sec) + 1e-6 * double(time.tv_usec);
    }
    return sum;
}

std::uint64_t key_of(const std::string& format, std::uint64_t seed, std::uint64_t index) {
    std::uint64_t h = mote::core::hash_keys(seed, index);
    for (const char c : format) h = mote::core::hash_combine(h, std::uint64_t(static_cast<unsigned char>(c)));
    return h;
}

constexpr const char* names[] = {"read", "refused", "defect"};

int read_one(const Format& format, const std::string& path) {
    std::string message;
    const Outcome outcome = try_file(format, path, message);
    std::printf("%s %s\n", names[int(outcome)], message.c_str());
    return outcome == Outcome::defect ? 1 : 0;
}

int run(const Arguments& a) {
    const std::vector<Format> all = formats();
    if (a.list) {
        for (const Format& f : all)
            std::printf("%s\t%s\t%s\n", f.name.c_str(), f.extension.c_str(), f.reader.c_str());
        return 0;
    }
    const Format& format = find_format(all, a.format);
    if (!a.read.empty()) return read_one(format, a.read);
    fs::create_directories(a.folder);
    write_neighbours(a.folder);
    const std::vector<Bytes> files = originals(format, a.corpus);
    if (!a.seeds_to.empty()) {
        for (std::size_t i = 0; i < files.size(); ++i)
            write_file((fs::path(a.seeds_to) / (std::to_string(i) + format.extension)).string(), files[i]);
        return 0;
    }
    if (files.empty()) {
        std::printf("no originals\n");
        return 0;
    }
    if (!a.write.empty()) {
        write_file(a.write, mutate(files, format, key_of(format.name, a.seed, a.first)));
        return 0;
    }
    limit_memory(a.memory_megabytes);
    const std::string path = (fs::path(a.folder) / ("case" + format.extension)).string();
    for (std::uint64_t i = a.first; i < a.first + a.count; ++i) {
        write_file(path, mutate(files, format, key_of(format.name, a.seed, i)));
        std::printf("begin %llu\n", static_cast<unsigned long long>(i));
        std::fflush(stdout);
        const double start = processor_seconds();
        std::string message;
        const Outcome outcome = try_file(format, path, message);
        const double seconds = processor_seconds() - start;
        std::replace(message.begin(), message.end(), '\n', ' ');
        std::printf("end %llu %s %.6f %s\n", static_cast<unsigned long long>(i), names[int(outcome)], seconds,
                    outcome == Outcome::defect             ? message.c_str()
                    : put_reports_aside(a.folder, path, i) ? "contained"
                                                           : "");
        std::fflush(stdout);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments a;
    CLI::App app("mote_fuzz: damages files and has them read");
    app.add_option("FORMAT", a.format, "The format (--list prints them)");
    app.add_flag("--list", a.list, "Print name, extension and reader of every format");
    app.add_option("--corpus", a.corpus, "A folder of real files, damaged beside those made here");
    app.add_option("--folder", a.folder, "Where the damaged file is written (default: here)");
    app.add_option("--first", a.first, "The first case");
    app.add_option("--count", a.count, "How many cases (default: 100)");
    app.add_option("--seed", a.seed, "Other cases (default: 14)");
    app.add_option("--memory", a.memory_megabytes, "Limit in megabytes (default: 4096)");
    app.add_option("--write", a.write, "Only write the first case to this file");
    app.add_option("--read", a.read, "Only read this file, and say what came of it");
    app.add_option("--seeds", a.seeds_to, "Only write the originals to this folder");
    CLI11_PARSE(app, argc, argv);
    try {
        return run(a);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "mote_fuzz: %s\n", error.what());
        return 2;
    }
}
