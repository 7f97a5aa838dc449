// Limits of the system, read from its files: a control group limits its descendants too, so all folders from
// the process's own up to the root are read. In a container that root is the container's own group.
#include "core/objects/memory_budget.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>

#include "core/objects/memory_error.h"

namespace mote::core {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The number that a file begins with; nothing where there is no file, or "max" in it.
std::optional<double> number_in(const std::string& path) {
    double number = 0.0;
    std::ifstream file(path);
    return file >> number ? std::optional(number) : std::nullopt;
}

/// The number behind a word at the beginning of a line, such as "MemAvailable:".
std::optional<double> number_after(const std::string& path, const std::string& word) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(word + " ")) continue;
        const auto first = line.find_first_not_of(' ', word.size());
        double number = 0.0;
        if (first != line.npos &&
            std::from_chars(line.data() + first, line.data() + line.size(), number).ec == std::errc())
            return number;
    }
    return std::nullopt;
}

/// Names of the files of one version of control groups.
struct GroupFiles {
    const char *mount, *limit, *usage, *reclaimable;
};
constexpr GroupFiles version_1{"/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                               "total_inactive_file"};
constexpr GroupFiles version_2{"/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file"};

/// Bytes that a group and those that it lies in leave. Pages of files that are read no more count as
/// usage and are given back.
double left_in_group(const std::string& root, const GroupFiles& files, std::string group) {
    double left = infinity;
    for (;; group.resize(std::min(group.rfind('/'), group.size()))) {
        if (group == "/") group.clear();
        const std::string folder = root + files.mount + group + "/";
        const auto limit = number_in(folder + files.limit), usage = number_in(folder + files.usage);
        if (limit && usage)
            left = std::min(left, *limit - *usage +
                                      number_after(folder + "memory.stat", files.reclaimable).value_or(0.0));
        if (group.empty()) return left;
    }
}

/// Lines of /proc/self/cgroup: "0::/a/b" is version 2, "4:memory:/a/b" version 1.
double left_in_groups(const std::string& root) {
    double left = infinity;
    std::ifstream file(root + "/proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (first == line.npos || second == line.npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const std::string group = line.substr(second + 1);
        if (line.starts_with("0::")) left = std::min(left, left_in_group(root, version_2, group));
        if (controllers.find(",memory,") != controllers.npos)
            left = std::min(left, left_in_group(root, version_1, group));
    }
    return left;
}

double left_of_address_space(const std::string& root) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return infinity;
    const double pages = number_in(root + "/proc/self/statm").value_or(0.0);
    return double(limit.rlim_cur) - pages * double(::sysconf(_SC_PAGESIZE));
}

std::string gigabytes(double bytes) {
    const std::string text = memory_text(bytes);
    return text.substr(2, text.size() - 3);
}

}  // namespace

double available_memory(const std::string& root) {
    double left = std::min(left_in_groups(root), left_of_address_space(root));
    if (const auto kilobytes = number_after(root + "/proc/meminfo", "MemAvailable:"))
        left = std::min(left, 1024.0 * *kilobytes);
    return std::max(0.0, left);
}

double MemoryBudget::available() const {
    constexpr double fraction = 0.95;
    return std::max(0.0, (fixed_ ? *fixed_ : fraction * available_memory()) - later_);
}

MemoryBudget MemoryBudget::without(double bytes) const {
    MemoryBudget rest = *this;
    rest.later_ += bytes;
    return rest;
}

std::size_t MemoryBudget::at_most(std::size_t limit) const {
    const double now = available();
    return now < double(limit) ? std::size_t(now) : limit;
}

void MemoryBudget::require(double bytes, const std::string& purpose,
                           const std::function<std::string(double)>& fits) const {
    const double now = available();
    if (bytes <= now) return;
    throw OutOfMemory(purpose + memory_text(bytes) + ": " + gigabytes(now) + " are available" +
                      (fits ? "; " + fits(now) : ""));
}

}  // namespace mote::core
