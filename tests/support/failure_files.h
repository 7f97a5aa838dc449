// Where a failing statistical test leaves what it saw: tables and pictures, in a new folder for every
// failure.
//
// The folder's path stands in the test's report. Tests that pass, and planted errors, write nothing.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace mote::tests {

/// The folder of all failures: MOTE_TEST_FAILURES, else `mote_test_failures` among the temporary files.
std::filesystem::path failures_root();

/// Makes a folder of its own for the failure `name` (of the running test when empty), lets `write` fill it
/// and says where it is: "; written to PATH". What goes wrong is said instead: a full disk must not hide the
/// failure that was to be described.
std::string write_failure(const std::string& name,
                          const std::function<void(const std::filesystem::path& folder)>& write);

}  // namespace mote::tests
