#include "tests/support/failure_files.h"

#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <system_error>

#include "tests/support/catch.h"

namespace mote::tests {
namespace {

std::string file_name_of(std::string name) {
    if (name.empty()) name = Catch::getResultCapture().getCurrentTestName();
    if (name.empty()) name = "unnamed";
    if (name.size() > 80) name.resize(80);
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    return name;
}

}  // namespace

std::filesystem::path failures_root() {
    const char* chosen = std::getenv("MOTE_TEST_FAILURES");
    return chosen && *chosen ? std::filesystem::path(chosen)
                             : std::filesystem::temp_directory_path() / "mote_test_failures";
}

std::string write_failure(const std::string& name,
                          const std::function<void(const std::filesystem::path& folder)>& write) {
    try {
        std::filesystem::create_directories(failures_root());
        std::string folder = (failures_root() / (file_name_of(name) + "-XXXXXX")).string();
        if (!::mkdtemp(folder.data())) throw std::system_error(errno, std::generic_category(), folder);
        write(folder);
        return "; written to " + folder;
    } catch (const std::exception& error) {
        return std::string("; nothing written: ") + error.what();
    }
}

}  // namespace mote::tests
