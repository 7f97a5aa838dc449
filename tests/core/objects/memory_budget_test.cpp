// Limits of memory: read from files that a test writes, and compared with what is requested.
#include <filesystem>
#include <fstream>

#include "core/objects/memory_budget.h"
#include "core/objects/memory_error.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// Files of a system with so little memory that limits of this process do not count.
struct System : TemporaryFolder {
    explicit System(const std::string& groups) {
        put("proc/meminfo", "MemTotal:  2000 kB\nMemFree:  10 kB\nMemAvailable:      1000 kB\n");
        put("proc/self/cgroup", groups);
    }
    void put(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories(std::filesystem::path(file(name)).parent_path());
        std::ofstream(file(name)) << text;
    }
    double available() const { return available_memory(path()); }
};

}  // namespace

TEST_CASE("Available memory is the smallest of the machine's and the control groups'", "[memory]") {
    const System plain("");
    CHECK(plain.available() == 1024000.0);

    const System second("0::/a/b\n");
    second.put("sys/fs/cgroup/a/b/memory.max", "max\n");
    second.put("sys/fs/cgroup/a/b/memory.current", "5\n");
    CHECK(second.available() == 1024000.0);
    second.put("sys/fs/cgroup/a/memory.max", "900000\n");  // of the group around it
    second.put("sys/fs/cgroup/a/memory.current", "500000\n");
    CHECK(second.available() == 400000.0);
    second.put("sys/fs/cgroup/a/memory.stat", "active_file 9\ninactive_file 100000\n");
    CHECK(second.available() == 500000.0);
    second.put("sys/fs/cgroup/a/memory.current", "2000000\n");
    CHECK(second.available() == 0.0);

    const System first("9:cpu:/c\n4:memory,hugetlb:/a/b\n0::/\n");
    first.put("sys/fs/cgroup/memory/a/b/memory.limit_in_bytes", "700000\n");
    first.put("sys/fs/cgroup/memory/a/b/memory.usage_in_bytes", "400000\n");
    first.put("sys/fs/cgroup/memory/a/b/memory.stat", "inactive_file 9\ntotal_inactive_file 1000\n");
    CHECK(first.available() == 301000.0);
    // In a container the root that is mounted is the container's group, whatever its name outside.
    const System container("4:memory:/docker/0123\n");
    container.put("sys/fs/cgroup/memory/memory.limit_in_bytes", "700000\n");
    container.put("sys/fs/cgroup/memory/memory.usage_in_bytes", "500000\n");
    CHECK(container.available() == 200000.0);
    const TemporaryFolder nothing;
    CHECK(available_memory(nothing.path()) == std::numeric_limits<double>::infinity());
}

TEST_CASE("A budget refuses with what is needed, what there is, and what fits", "[memory]") {
    const MemoryBudget budget(3e9);
    CHECK_NOTHROW(budget.require(3e9, "a map"));
    CHECK_THROWS_WITH(budget.require(4.5e9, "a map"), "a map (4.5 GB): 3.0 GB are available");
    CHECK_THROWS_WITH(
        budget.without(2.5e9).require(
            1e9, "a map", [](double bytes) { return std::to_string(int(bytes * 1e-6)) + " fit"; }),
        "a map (1.0 GB): 500.0 MB are available; 500 fit");
    CHECK_THROWS_AS(budget.without(5e9).require(1.0, "a map"), OutOfMemory);
    CHECK(budget.at_most(std::size_t(1) << 30) == std::size_t(1) << 30);
    CHECK(budget.at_most(std::size_t(1) << 40) == 3000000000);
    const double now = MemoryBudget().available();
    CHECK(now > 0.0);
    CHECK(now < 1e15);
}
