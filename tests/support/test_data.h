// Real files by others, for tests only: found through MOTE_TEST_DATA, by default ../shared/data beside the
// sources.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

namespace mote::tests {

/// Full path of a test file or folder, or nothing (with a printed notice) where the data is absent.
inline std::optional<std::string> test_data(const std::string& relative) {
    const char* root = std::getenv("MOTE_TEST_DATA");
    const auto path = std::filesystem::path(root ? root : MOTE_SOURCE_DIR "/../shared/data") / relative;
    if (std::filesystem::exists(path)) return path.string();
    std::cout << "SKIPPED: no test data '" << relative << "' (set MOTE_TEST_DATA)\n";
    return std::nullopt;
}

}  // namespace mote::tests
